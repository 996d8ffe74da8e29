/** Which files of a drop or a file dialogue are taken, what is saved of a plan, and what files are called. */
import { stemOf, type Source } from "../../api/source.js";
import type { Format, Printer } from "../../api/wire.js";

export interface Named {
  readonly name: string;
}

/** By its name alone; a name without any extension is given the benefit of the doubt. */
const isStl = (name: string): boolean => /\.stl$/i.test(name) || !/\.[a-z0-9]+$/i.test(name);

/** The STLs of several files. If none has the name of one, the first: the core looks inside and says what it is. */
export function choose<T extends Named>(files: readonly T[]): readonly T[] {
  const stls = files.filter(({ name }) => isStl(name));
  return stls.length > 0 ? stls : files.slice(0, 1);
}

/** What a file of weights is called: `bunny.stl` gives `bunny.weights`. */
export const weightsName = (model: string): string => `${stemOf(model)}.weights`;

/** The format that settings stand for before there is a plan. */
export function formatFor({ printer, format }: { printer: string; format: Format | "" }, printers: readonly Printer[]): Format {
  return format || printers.find(({ name }) => name === printer)?.format || "png";
}

export function isFiles(source: Source | readonly File[]): source is readonly File[] {
  return Array.isArray(source);
}
