/** Choice of the files to open from a drop or a file dialog, and names of files to save. */
import { stemOf, type Source } from "../../api/source.js";

export interface Named {
  readonly name: string;
}

/** The `accept` attribute of file dialogs. */
export const MODEL_FILES = ".stl,.3mf,.obj,model/stl,model/3mf,model/obj";

/** Returns true if the name may be that of a model; names without an extension pass. */
export const isNamedAsModel = (name: string): boolean => /\.(stl|3mf|obj)$/i.test(name) || !/\.[a-z0-9]+$/i.test(name);

/** The models among several files. If no name fits, the first file, so that the core can report its kind. */
export function choose<T extends Named>(files: readonly T[]): readonly T[] {
  const models = files.filter(({ name }) => isNamedAsModel(name));
  return models.length > 0 ? models : files.slice(0, 1);
}

/** Name of a model's weight file: `bunny.weights` for `bunny.stl`. */
export const weightsName = (model: string): string => `${stemOf(model)}.weights`;

/** Name of the project of a job, after its first model. */
export const projectName = (model: string): string => `${stemOf(model)}-project.3mf`;

/** Returns true if the name may be that of a project. */
export const isNamedAsProject = (name: string): boolean => /\.3mf$/i.test(name);

export function isFiles(source: Source | readonly File[]): source is readonly File[] {
  return Array.isArray(source);
}
