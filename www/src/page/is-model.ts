/** Whether a file is a model by its content, whatever its name: what is left may be a print file, and those are often zips too. */

/** A binary STL has a header and a count, then so many facets. */
const STL_HEADER_BYTES = 84;
const STL_FACET_BYTES = 50;

/** Enough to tell text from anything else. */
const HEAD_BYTES = 1024;

/** The letters that a zip begins with: PK. */
const ZIP = [0x50, 0x4b] as const;

/** Where the directory of a zip ends: before a comment of at most 64 KiB. */
const TAIL_BYTES = 1 << 17;

/**
 * True for a binary STL, for text, which no print file is, and for a zip with a model in its directory, as a 3MF is. The core
 * tells what is wrong with a model.
 */
export async function isModel(file: Blob): Promise<boolean> {
  const head = new Uint8Array(await file.slice(0, HEAD_BYTES).arrayBuffer());
  if (head.length >= STL_HEADER_BYTES) {
    const facets = new DataView(head.buffer).getUint32(STL_HEADER_BYTES - 4, true);
    if (facets > 0 && Math.floor((file.size - STL_HEADER_BYTES) / STL_FACET_BYTES) === facets) return true;
  }
  if (head[0] === ZIP[0] && head[1] === ZIP[1]) return /\.model/i.test(latin(await file.slice(-TAIL_BYTES).arrayBuffer()));
  return !head.includes(0);
}

const latin = (bytes: ArrayBuffer): string => new TextDecoder("latin1").decode(bytes);
