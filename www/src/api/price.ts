/** What a plan asks for in a price. The core computes it; here are only the numbers that it needs. */
import type { PriceItem, Report } from "./wire.js";

/** How a plan is ordered. */
export interface Ordered {
  /** Copies of the model, each with its whole print time; 1 if absent. */
  copies?: number;
  /** The finish, by its name in the prices. */
  finish?: string;
}

/** Items of a price for `copies` prints of a plate: each of its copies has its share of the time. */
export function priceItems({ models }: Report, copies = 1): PriceItem[] {
  return models.map((model) => ({ copies: model.copies * copies, resin_ml: model.resin_ml, print_time_s: model.print_time_s }));
}
