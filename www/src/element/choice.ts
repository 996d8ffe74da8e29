/** Which file of a drop or a file dialogue is taken. */

export interface Named {
  readonly name: string;
}

export type Choice<T> =
  | { kind: "none" }
  | { kind: "not-stl"; name: string }
  /** `notice` says what was left aside, if anything was. */
  | { kind: "file"; file: T; notice: string | null };

/** By its name alone; a name without any extension is given the benefit of the doubt, the core will look inside. */
export const isStl = (name: string): boolean => /\.stl$/i.test(name) || !/\.[a-z0-9]+$/i.test(name);

/** The first STL of several files, or word that there is none. */
export function choose<T extends Named>(files: readonly T[]): Choice<T> {
  const [first] = files;
  if (first === undefined) return { kind: "none" };
  const file = files.find(({ name }) => isStl(name));
  if (file === undefined) return { kind: "not-stl", name: first.name };
  const others = files.length - 1;
  const notice = others === 0 ? null : `${others + 1} files came at once. Cusp takes one at a time: this is ${file.name}.`;
  return { kind: "file", file, notice };
}

/** What the zip is called: `bunny.stl` gives `bunny-cusp.zip`. */
export function archiveName(model: string): string {
  const stem = model.replace(/\.stl$/i, "").trim();
  return `${stem === "" ? "model" : stem}-cusp.zip`;
}
