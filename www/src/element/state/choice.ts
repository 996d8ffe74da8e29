/** Which files of a drop or a file dialog are opened, and the names of weight files. */
import { stemOf, type Source } from "../../api/source.js";

export interface Named {
  readonly name: string;
}

/** What a file dialog shows. */
export const MODEL_FILES = ".stl,.3mf,.obj,model/stl,model/3mf,model/obj";

/** By its name alone; a name without any extension is given the benefit of the doubt. */
export const isNamedAsModel = (name: string): boolean => /\.(stl|3mf|obj)$/i.test(name) || !/\.[a-z0-9]+$/i.test(name);

/** The models of several files. If no name looks like one, the first file: the core inspects it and reports what it is. */
export function choose<T extends Named>(files: readonly T[]): readonly T[] {
  const models = files.filter(({ name }) => isNamedAsModel(name));
  return models.length > 0 ? models : files.slice(0, 1);
}

/** The name of a model's weight file: `bunny.stl` gives `bunny.weights`. */
export const weightsName = (model: string): string => `${stemOf(model)}.weights`;

export function isFiles(source: Source | readonly File[]): source is readonly File[] {
  return Array.isArray(source);
}
