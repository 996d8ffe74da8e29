/** Order items of a plan: the numbers from which the core computes a price. */
import type { PriceItem, Report } from "./wire.js";

/** An order for the last plan. */
export interface Ordered {
  /** Number of times that the plan is printed, each with its whole print time; 1 by default. */
  copies?: number;
  /** Name of the finish in the prices. */
  finish?: string;
}

/** Order items for `copies` prints of a plate. Each of the plate's copies has its share of the time. */
export function priceItems({ models }: Report, copies = 1): PriceItem[] {
  return models.map(({ copies: each, resin_ml, supported, print_time_s }) => ({
    copies: each * copies,
    resin_ml,
    ...(supported !== undefined && { support_ml: supported.support_ml }),
    print_time_s,
  }));
}
