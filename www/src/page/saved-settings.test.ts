import { expect, test } from "vitest";
import { fromAddress } from "../element/state/settings.js";
import { appliedTo, savedIn, savedQuery, withoutSaved, withSaved } from "./saved-settings.js";

test("the height and the rotation stay with the model", () => {
  expect(savedQuery("metric=area&height=60&rotation=1,0,0,0&printer=mars&tolerance=5")).toBe("metric=area&printer=mars&tolerance=5");
  expect(appliedTo("height=60&rotation=1,0,0,0&tolerance=0.03", "metric=area&tolerance=5")).toBe(
    "metric=area&height=60&rotation=1%2C0%2C0%2C0&tolerance=5",
  );
});

test("so does what was placed by hand", () => {
  const placed = "supports=light&fill=on&points=1,2,3,,1";
  expect(savedQuery(placed)).toBe("supports=light");
  expect(fromAddress(appliedTo(placed, "supports=heavy"))).toEqual({ ...fromAddress(placed), supports: "heavy" });
});

test("saving under a name in use replaces it; names differ neither by case nor by spaces around them", () => {
  const list = withSaved(withSaved([], { name: "Layer 10", query: "a=1" }), { name: "layer 9 ", query: "" });
  expect(list.map(({ name }) => name)).toEqual(["layer 9", "Layer 10"]);
  expect(withSaved(list, { name: " LAYER 10", query: "b=2" })).toEqual([list[0], { name: "LAYER 10", query: "b=2" }]);
  expect(withoutSaved(list, "LAYER 9")).toEqual([list[1]]);
});

test("what storage holds is checked", () => {
  const own = { name: "Fine", query: "tolerance=0.03" };
  expect(savedIn(JSON.stringify([own, null, 3, { name: " ", query: "" }, { name: "x" }]))).toEqual([own]);
  for (const text of [null, "", "{", "{}", "null", "7"]) expect(savedIn(text)).toEqual([]);
});
