/** Turns every kind of source into a named Blob. */
import { isAbort, said, SlicerError } from "./error.js";
import { stlOf } from "./stl.js";

/** An indexed mesh: three coordinates per vertex, in mm, and three vertex indices per facet. */
export interface IndexedFacets {
  positions: ArrayLike<number>;
  indices: ArrayLike<number>;
}

/**
 * Source of a model: a file; bytes or a stream of bytes; a URL, where a string is relative to the page; the response to a request; facets
 * as nine coordinates each in a `Float32Array`, in mm; or an indexed mesh.
 */
export type Source = Blob | ArrayBuffer | ArrayBufferView | ReadableStream<Uint8Array> | URL | string | Response | IndexedFacets;

export interface Named {
  file: Blob;
  /** Name of the file, or the last part of a URL's path; by default `model.stl`. */
  name: string;
}

const NAMELESS = "model.stl";

/** A model's name without its extension. */
export const stemOf = (model: string): string => model.replace(/\.(stl|3mf|obj)$/i, "").trim() || "model";

/** Reads a source as a named Blob. Rejects with `fetch-failed` if it does not arrive, or with the signal's reason on an abort. */
export async function resolve(source: Source, signal?: AbortSignal): Promise<Named> {
  if (isA("File", source)) return { file: source, name: source.name };
  if (isA("Blob", source)) return { file: source, name: NAMELESS };
  if (isA("String", source) || isA("URL", source)) {
    const answer = (): Promise<Response> => fetch(source, signal === undefined ? {} : { signal });
    return { file: await received(answer, signal), name: nameOf(source) };
  }
  if (isA("Response", source)) return { file: await received(() => abortable(source, signal), signal), name: nameOf(source.url) };
  if (isA("ReadableStream", source)) return { file: await received(() => abortable(new Response(source), signal), signal), name: NAMELESS };
  return { file: new Blob([bytesIn(source)]), name: NAMELESS };
}

/** Types recognised by their tag rather than `instanceof`, which fails for objects from another frame. */
interface Kinds {
  File: File;
  Blob: Blob;
  String: string;
  URL: URL;
  Response: Response;
  ReadableStream: ReadableStream<Uint8Array>;
  ArrayBuffer: ArrayBuffer;
  Float32Array: Float32Array;
  Float64Array: Float64Array;
}

const kindOf = (value: unknown): string => Object.prototype.toString.call(value).slice("[object ".length, -1);

const isA = <Kind extends keyof Kinds>(kind: Kind, value: unknown): value is Kinds[Kind] => kindOf(value) === kind;

/** The bytes of a file in memory, or an STL of facets. */
function bytesIn(source: ArrayBuffer | ArrayBufferView | IndexedFacets): ArrayBuffer | ArrayBufferView<ArrayBuffer> {
  if (isA("Float32Array", source)) return stlOf(whole("positions", source, 9));
  const memory = ArrayBuffer.isView(source) && !isA("Float64Array", source) ? source.buffer : source;
  // A Blob takes no shared memory.
  if (isA("ArrayBuffer", memory)) return source as ArrayBuffer | ArrayBufferView<ArrayBuffer>;
  if (areFacets(source)) return stlOf(cornersOf(source));
  const given = kindOf(memory);
  throw new SlicerError("bad-source", `a model cannot be read from ${given}: pass a file, its bytes, a stream, a URL, a Response or positions`, { given });
}

const isList = (value: unknown): boolean => typeof (value as ArrayLike<number> | undefined)?.length === "number";

function areFacets(source: unknown): source is IndexedFacets {
  const { positions, indices } = (source ?? {}) as Partial<IndexedFacets>;
  return isList(positions) && isList(indices);
}

/** Corners of an indexed mesh, nine coordinates per facet. */
function cornersOf({ positions, indices }: IndexedFacets): Float32Array {
  const vertices = whole("positions", positions, 3).length / 3;
  const corners = new Float32Array(3 * whole("indices", indices, 3).length);
  for (let place = 0; place < indices.length; place++) {
    const index = Number(indices[place]);
    if (!(Number.isInteger(index) && index >= 0 && index < vertices)) {
      throw new SlicerError("bad-index", `indices[${place}] is ${index}, and there are ${vertices} vertices`, { place, index, vertices });
    }
    for (let axis = 0; axis < 3; axis++) corners[3 * place + axis] = positions[3 * index + axis] as number;
  }
  return corners;
}

/** Checks that the count of numbers is a multiple of `multiple_of`. */
function whole<List extends ArrayLike<number>>(list: "positions" | "indices", numbers: List, multiple_of: number): List {
  if (numbers.length % multiple_of === 0) return numbers;
  const message = `${list}: ${numbers.length} numbers are no multiple of ${multiple_of}`;
  throw new SlicerError("bad-facets", message, { list, numbers: numbers.length, multiple_of });
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

/** A response whose body is cancelled on an abort; its own request does not know the signal. */
function abortable(response: Response, signal: AbortSignal | undefined): Response {
  const { ok, body } = response;
  return !ok || body === null || signal === undefined ? response : new Response(body.pipeThrough(new TransformStream(), { signal }));
}

async function received(answer: () => Response | Promise<Response>, signal: AbortSignal | undefined): Promise<Blob> {
  try {
    const response = await answer();
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
