import { expect, test } from "vitest";
import type { Candidate } from "../../api/wire.js";
import { prepared } from "./prepared.js";
import { DEFAULT_SETTINGS } from "./settings.js";

const candidate = { rotation: [1, 0, 0, 0], size_mm: [10, 10, 30] } as unknown as Candidate;
const rotation = "1,0,0,0";

test("a small model is turned and supported, a large one hollowed as well", () => {
  expect(prepared(DEFAULT_SETTINGS, candidate, 10)).toEqual({ rotation, supports: "medium" });
  expect(prepared(DEFAULT_SETTINGS, candidate, 100)).toEqual({ rotation, supports: "medium", wall: "2" });
});

test("a choice of supports, walls and scale stays", () => {
  const chosen = { ...DEFAULT_SETTINGS, supports: "light", wall: "3", height: "20" } as const;
  expect(prepared(chosen, candidate, 100)).toEqual({ rotation, height: "30" });
});

test("slicers of filament printers support and hollow themselves", () => {
  expect(prepared({ ...DEFAULT_SETTINGS, format: "prusa-3mf" }, candidate, 100)).toEqual({ rotation });
});
