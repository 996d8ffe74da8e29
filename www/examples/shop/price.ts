/** The shop's own price, by time and ml. The page shows it; the server works it out anew from what it has verified. */
import { SETUP_CENTS, type ShopPrinter, type ShopResin } from "./catalogue.js";

export interface Print {
  print_time_s: number;
  resin_ml: number;
}

/** Whole cents, taxes included. */
export interface Price {
  setup_cents: number;
  /** For each copy. */
  time_cents: number;
  /** For each copy. */
  resin_cents: number;
  total_cents: number;
}

const HOUR_S = 3600;

/** @param copies a whole number from 1 */
export function priceOf(print: Print, printer: ShopPrinter, resin: ShopResin, copies: number): Price {
  const time_cents = Math.ceil((print.print_time_s / HOUR_S) * printer.hour_cents);
  const resin_cents = Math.ceil(print.resin_ml * resin.ml_cents);
  return { setup_cents: SETUP_CENTS, time_cents, resin_cents, total_cents: SETUP_CENTS + copies * (time_cents + resin_cents) };
}
