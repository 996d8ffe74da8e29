/** Properties of a whole print file, as names and texts. Missing ones are omitted. */
import type { Format } from "../texts/format.js";
import type { Language } from "../texts/index.js";
import { printTexts } from "./texts.js";
import type { Inspection } from "./wire.js";

export function factsOf(inspection: Inspection, language: Language): [name: string, text: string][] {
  const { format } = language;
  const words = printTexts(language);
  const { facts } = words;
  const { version, software, printer, plate_mm, pixels, pixel_mm } = inspection;
  const range = (values: readonly [number, number], say: (value: number) => string): string => {
    const [least, greatest] = [say(values[0]), say(values[1])];
    return least === greatest ? least : words.range({ least, greatest });
  };
  const [x, y, z] = plate_mm;
  const side = `${format.tick(pixel_mm[0] * 1000)} × ${format.tick(pixel_mm[1] * 1000)}\u00a0µm`;
  const isMirrored = inspection.is_mirrored_x === true || inspection.is_mirrored_y === true;
  const masks = words.pixels({ width: String(pixels[0]), height: String(pixels[1]), side }) + (isMirrored ? `, ${words.mirrored}` : "");
  const thickness = inspection.thickness_range_mm;
  const layers = thickness === null ? format.count(inspection.layers) : words.thickness({ layers: inspection.layers, range: range(thickness, format.fine) });
  const ignored = inspection.uses_layer_values === false && thickness !== null && thickness[0] !== thickness[1];
  const all: [string, string | null][] = [
    [facts.format, `${inspection.format}${version === null ? "" : ` ${version}`}`],
    [facts.software, software],
    [facts.printer, printer],
    [facts.plate, x === null || y === null || z === null ? null : format.dimensions([x, y, z])],
    [facts.masks, masks],
    [facts.layers, ignored ? `${layers}; ${words.ignored}` : layers],
    [facts.height, format.height(inspection.height_mm)],
    [facts.exposure, exposure(inspection, format, range)],
    [facts.bottom, bottom(inspection, language)],
    [facts.time, inspection.print_time_s === null || inspection.print_time_s <= 0 ? null : format.time(inspection.print_time_s)],
    [facts.resin, resin(inspection, language)],
  ];
  return all.filter((fact): fact is [string, string] => fact[1] !== null);
}

type Range = (values: readonly [number, number], say: (value: number) => string) => string;

function exposure({ exposure_range_s, exposure_s }: Inspection, format: Format, range: Range): string | null {
  const values = exposure_range_s ?? (exposure_s === null ? null : ([exposure_s, exposure_s] as const));
  return values === null ? null : range(values, (value) => format.measure(value, "s"));
}

function bottom({ bottom_layers, bottom_exposure_s }: Inspection, language: Language): string | null {
  if (bottom_layers === null || bottom_layers === 0 || bottom_exposure_s === null) return null;
  return printTexts(language).bottomOf({ layers: bottom_layers, exposure: language.format.measure(bottom_exposure_s, "s") });
}

function resin(inspection: Inspection, language: Language): string {
  const words = printTexts(language);
  const { millilitres } = language.format;
  const { volume_ml, lit_volume_ml, resin } = inspection;
  const lit = millilitres(lit_volume_ml);
  const amount = volume_ml === null || volume_ml <= 0 ? words.lit({ lit }) : words.stated({ stated: millilitres(volume_ml), lit });
  return resin === null ? amount : `${resin}, ${amount}`;
}
