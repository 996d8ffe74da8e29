import { readFileSync } from "node:fs";
import { expect, test } from "vitest";
import { settingsFile } from "./settings-file.js";

// tests/cli/config.rs slices with the same file.
const RECORDED = new URL("../../../tests/cli/page.toml", import.meta.url);

test("a file of settings has the core's names, and nothing of the model", () => {
  const printer = {
    name: "own printer",
    model: 'Cellar "two"',
    pixels: [300, 200] as [number, number],
    pitch_um: [40, 40.5] as [number, number],
    volume_mm: [12, 8.1, 20] as [number, number, number],
  };
  const query = new URLSearchParams({
    height: "60",
    rotation: "0,0,1,0",
    printer: JSON.stringify(printer),
    metric: "roughness",
    tolerance: "0,12",
    layerMax: "120 µm",
    snap: "off",
    saliency: "on",
    weightMin: "0.5",
    exposure: "2.5",
    bottomLayers: "6",
    format: "goo",
  });
  expect(settingsFile(query.toString())).toBe(readFileSync(RECORDED, "utf8"));
});

test("settings that are invalid make no file", () => {
  expect(settingsFile("layerMin=thin")).toBeNull();
  expect(settingsFile("")).toContain("layer_min_mm = 0.05\n");
});
