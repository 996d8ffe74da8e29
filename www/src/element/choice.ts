/** Which files of a drop or a file dialogue are taken, what is saved of a plan, and what files are called. */
import type { Format, Options, Printer } from "../api/wire.js";

export interface Named {
  readonly name: string;
}

export type Choice<T> =
  | { kind: "none" }
  | { kind: "not-stl"; name: string }
  /** At least one, in the order in which they came. */
  | { kind: "files"; files: readonly [T, ...T[]] };

/** By its name alone; a name without any extension is given the benefit of the doubt, the core will look inside. */
export const isStl = (name: string): boolean => /\.stl$/i.test(name) || !/\.[a-z0-9]+$/i.test(name);

/** The STLs of several files, or word that there is none. */
export function choose<T extends Named>(files: readonly T[]): Choice<T> {
  const [first] = files;
  if (first === undefined) return { kind: "none" };
  const [stl, ...others] = files.filter(({ name }) => isStl(name));
  return stl === undefined ? { kind: "not-stl", name: first.name } : { kind: "files", files: [stl, ...others] };
}

const EXTENSIONS: Readonly<Record<Format, string>> = { png: "zip", chitubox: "zip", uvj: "uvj", sl1: "sl1" };

const stemOf = (model: string): string => model.replace(/\.stl$/i, "").trim() || "model";

/** What a file of weights is called: `bunny.stl` gives `bunny.weights`. */
export const weightsName = (model: string): string => `${stemOf(model)}.weights`;

/** What a plan is saved as, and the printer that it is for, if it is one that is known by name. */
export interface PrintFile {
  format: Format;
  printer: Printer | null;
}

/** What the plan for these options is saved as. */
export function printFile({ printer, format }: Pick<Options, "printer" | "format">, printers: readonly Printer[]): PrintFile {
  const known = printers.find(({ name }) => name === printer) ?? null;
  return { format: format ?? known?.format ?? "png", printer: known };
}

/** Whether the printer reads the file as it is. */
export function isRead({ format, printer }: PrintFile): boolean {
  return printer !== null && printer.reads_format && printer.format === format;
}

/** What the print file is called: `bunny.stl` gives `bunny-cusp.zip`. Printers list files of their own extensions only. */
export function archiveName(model: string, file: PrintFile): string {
  const own = isRead(file) ? file.printer?.reads[0] : undefined;
  return `${stemOf(model)}-cusp.${own ?? EXTENSIONS[file.format]}`;
}
