/** Order items of a plan. */
import { expect, test } from "vitest";

import { priceItems } from "./price.js";
import type { Report } from "./wire.js";

test("an item has the resin of supports only where the plan has supports", () => {
  const model = { copies: 2, resin_ml: 1.5, print_time_s: 15 };
  const models = [model, { ...model, supported: { support_ml: 0.25 } }];
  expect(priceItems({ models } as Report, 3)).toEqual([
    { copies: 6, resin_ml: 1.5, print_time_s: 15 },
    { copies: 6, resin_ml: 1.5, support_ml: 0.25, print_time_s: 15 },
  ]);
});
