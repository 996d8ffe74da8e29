/** Which files of a drop or a file dialogue are taken, and what is made of their names. */
import type { Format } from "../api/wire.js";

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

/** What the print file is called: `bunny.stl` gives `bunny-cusp.zip`. */
export function archiveName(model: string, format: Format): string {
  return `${stemOf(model)}-cusp.${EXTENSIONS[format]}`;
}
