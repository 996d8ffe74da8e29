/** The shop's own price, by time and ml. The page shows it; the server computes it again from what it has verified. */
import { SETUP_CENTS, type ShopPrinter, type ShopResin } from "./catalogue.js";

export interface Print {
  print_time_s: number;
  resin_ml: number;
}

/** A line of an order, in whole cents, taxes included. */
export interface Line {
  name: "setup" | "time" | "resin";
  each_cents: number;
  count: number;
  total_cents: number;
}

export interface Price {
  lines: readonly Line[];
  /** The sum of the lines. */
  total_cents: number;
}

const HOUR_S = 3600;

/** @param copies a whole number from 1 */
export function priceOf(print: Print, printer: ShopPrinter, resin: ShopResin, copies: number): Price {
  const line = (name: Line["name"], each_cents: number, count: number): Line => ({ name, each_cents, count, total_cents: count * each_cents });
  const lines = [
    line("setup", SETUP_CENTS, 1),
    line("time", Math.ceil((print.print_time_s / HOUR_S) * printer.hour_cents), copies),
    line("resin", Math.ceil(print.resin_ml * resin.ml_cents), copies),
  ];
  return { lines, total_cents: lines.reduce((sum, { total_cents }) => sum + total_cents, 0) };
}
