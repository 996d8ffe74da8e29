/** Turns each way of passing a model into a Blob with a name. */
import { isAbort, said, SlicerError } from "./error.js";

/** A file, bytes, or a URL; a string is a URL relative to the page. */
export type Source = Blob | ArrayBuffer | ArrayBufferView | URL | string;

export interface Named {
  file: Blob;
  /** The file's name, or the last part of a URL's path; `model.stl` if there is neither. */
  name: string;
}

const NAMELESS = "model.stl";

/** A model's name without its extension. */
export const stemOf = (model: string): string => model.replace(/\.(stl|3mf|obj)$/i, "").trim() || "model";

/** The source as a named Blob. Fetches a URL; rejects with `fetch-failed`, or with the signal's reason on an abort. */
export async function resolve(source: Source, signal?: AbortSignal): Promise<Named> {
  if (source instanceof File) return { file: source, name: source.name };
  if (source instanceof Blob) return { file: source, name: NAMELESS };
  if (typeof source !== "string" && !(source instanceof URL)) {
    return { file: new Blob([source as ArrayBuffer]), name: NAMELESS };
  }
  return { file: await download(source, signal), name: nameOf(source) };
}

function nameOf(address: URL | string): string {
  const path = String(address).replace(/[?#].*$/s, "");
  const last = path.slice(path.lastIndexOf("/") + 1);
  if (last === "" || path.startsWith("data:") || path.startsWith("blob:")) return NAMELESS;
  try {
    return decodeURIComponent(last);
  } catch {
    return last;
  }
}

async function download(address: URL | string, signal?: AbortSignal): Promise<Blob> {
  try {
    const response = await fetch(address, signal === undefined ? {} : { signal });
    if (response.ok) return await response.blob();
    throw new SlicerError("fetch-failed", `the model could not be fetched (HTTP ${response.status})`, {
      status: response.status,
    });
  } catch (error) {
    if (error instanceof SlicerError || isAbort(error) || signal?.aborted === true) throw error;
    const system = said(error);
    throw new SlicerError("fetch-failed", `the model could not be fetched (${system})`, { system });
  }
}
