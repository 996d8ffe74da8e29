/** Which files of a drop or a file dialog are opened, the default print format, and the names of weight files. */
import { stemOf, type Source } from "../../api/source.js";
import type { Format, Printer } from "../../api/wire.js";

export interface Named {
  readonly name: string;
}

/** By its name alone; a name without any extension is given the benefit of the doubt. */
const isStl = (name: string): boolean => /\.stl$/i.test(name) || !/\.[a-z0-9]+$/i.test(name);

/** The STLs of several files. If no name looks like one, the first file: the core inspects it and reports what it is. */
export function choose<T extends Named>(files: readonly T[]): readonly T[] {
  const stls = files.filter(({ name }) => isStl(name));
  return stls.length > 0 ? stls : files.slice(0, 1);
}

/** The name of a model's weight file: `bunny.stl` gives `bunny.weights`. */
export const weightsName = (model: string): string => `${stemOf(model)}.weights`;

/** The print format that settings give before there is a plan. */
export function formatFor({ printer, format }: { printer: string; format: Format | "" }, printers: readonly Printer[]): Format {
  return format || printers.find(({ name }) => name === printer)?.format || "png";
}

export function isFiles(source: Source | readonly File[]): source is readonly File[] {
  return Array.isArray(source);
}
