import { expect, test } from "vitest";
import { knownPrinter } from "../element/state/printer-fixture.js";
import { printerFor } from "./printer.js";
import type { Inspection } from "./wire.js";

const printers = [knownPrinter({ name: "mine", model: "My One" })];

const inspection = (changed: Partial<Inspection>): Inspection =>
  ({ format: "goo", version: "V3.0", printer: "Any One", pixels: [4000, 2000], pixel_mm: [0.0195, 0.024], plate_mm: [null, null, 180], is_mirrored_x: true, ...changed }) as Inspection;

test("a file names a known printer, or describes its own", () => {
  const [known] = printers;
  expect(printerFor(inspection({ printer: known?.model ?? "" }), printers)).toBe(known?.name);
  expect(printerFor(inspection({}), printers)).toEqual({
    ...{ name: "Any One", model: "Any One", pixels: [4000, 2000], pitch_um: [19.5, 24] },
    ...{ volume_mm: [78, 48, 180], is_mirrored: true, format: "goo" },
  });
  expect(printerFor(inspection({ format: "photon-workshop", version: "517", printer: null, plate_mm: [80, 50, null] }), [])).toMatchObject({ volume_mm: [80, 50, 150], file_version: 517 });
  expect(printerFor(inspection({ pixel_mm: [0, 0] }), printers)).toBeNull();
});
