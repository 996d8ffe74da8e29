/** What a plan asks for in a price. The core computes it; here are only the numbers that it needs. */
import type { PriceItem, Report } from "./wire.js";

/** How a plan is ordered. */
export interface Ordered {
  /** Copies of the model, each with its whole print time; 1 if absent. */
  copies?: number;
  /** The finish, by its name in the prices. */
  finish?: string;
}

/** What a report needs: copies on a plate have their shares of its time. */
export function priceItems({ plate, resin_ml, print_time_s }: Report, copies = 1): PriceItem[] {
  if (!plate) return [{ copies, resin_ml, print_time_s }];
  return plate.models.map((model) => ({ copies: model.copies * copies, resin_ml: model.resin_ml, print_time_s: model.print_time_s }));
}
