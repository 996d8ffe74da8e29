/** The printer for which a print file was made. */
import type { KnownPrinter, Printer } from "../api/wire.js";
import type { Inspection } from "./wire.js";

/** Height of a plate that the file does not state, mm: that of most printers at least. */
const USUAL_HEIGHT_MM = 150;

/** Name of the known printer that the file names, or else its description; null for a file without the size of its pixels. */
export function printerFor({ printer: named, format, version, pixels, pixel_mm, plate_mm, is_mirrored_x }: Inspection, known: readonly KnownPrinter[]): string | Printer | null {
  const one = known.find(({ model, machine }) => named !== null && (named === model || named === machine));
  if (one !== undefined) return one.name;
  const pitch_um = pixel_mm.map((mm) => Math.round(mm * 1e6) / 1000) as [number, number];
  if (!pitch_um.every((um) => um > 0)) return null;
  const side = (axis: 0 | 1): number => plate_mm[axis] ?? Math.round(pixels[axis] * pixel_mm[axis] * 1000) / 1000;
  const model = named ?? "";
  const file_version = format === "photon-workshop" ? Number(version) : null;
  return {
    ...(model !== "" && { name: model, model }),
    pixels,
    pitch_um,
    volume_mm: [side(0), side(1), plate_mm[2] ?? USUAL_HEIGHT_MM],
    is_mirrored: is_mirrored_x ?? true,
    format,
    ...(file_version !== null && { file_version }),
  };
}
