/** Price of a plan. */
import { expect, test } from "vitest";
import type { SlicerError } from "../../api/error.js";
import type { Price } from "../../api/wire.js";
import { model, planOf } from "./fake-slicer.js";
import { Session } from "./session.js";
import { planned, session, settle, slicer } from "./session-fixture.js";

const EUR = { currency: "EUR" };

test("a plan has a price once the page has prices, and every plan after it its own", async () => {
  await planned();
  expect([session.pricing.price, slicer.orders.length]).toEqual([null, 0]);
  session.pricing.asked = { prices: EUR, finish: "sanded" };
  await settle();
  expect(slicer.orders).toEqual([{ prices: EUR, ordered: { finish: "sanded" } }]);
  expect([session.pricing.price?.total, session.pricing.isPriced]).toEqual([1241, true]);
  session.change({ tolerances: { cusp: "0.05" } });
  await settle();
  // During planning, the price is that of the plan shown.
  expect([session.pricing.price?.total, session.pricing.isPriced]).toEqual([1241, true]);
  slicer.last.resolve(planOf(20));
  await settle();
  expect([session.pricing.price?.total, session.pricing.isPriced]).toEqual([1242, true]);
  session.selectLayer(2);
  await settle();
  expect(slicer.orders).toHaveLength(2);
  session.pricing.asked = null;
  expect(session.pricing.price).toBeNull();
});

test("prices that cannot be used are told to the page once, and everything else goes on", async () => {
  const told: string[] = [];
  const priced: Price[] = [];
  const own = new Session(
    { requestUpdate: () => undefined, mispriced: ({ code }: SlicerError) => void told.push(code), priced: (price) => void priced.push(price) },
    slicer,
  );
  own.pricing.asked = { prices: { currency: "" } };
  void own.open(new Blob(), "a.stl");
  slicer.last.resolve(model);
  await settle();
  slicer.last.resolve(planOf(10));
  await settle();
  expect([told, own.pricing.price, own.failure]).toEqual([["bad-prices"], null, null]);
  expect(own.mask?.layer).toBe(5);
  own.pricing.asked = { prices: EUR };
  await settle();
  expect([told.length, priced.length, own.pricing.price?.currency]).toEqual([1, 1, "EUR"]);
});
