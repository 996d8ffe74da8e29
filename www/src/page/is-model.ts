/** Distinguishes models from print files by content, not by name; both are often zips. */

/** A binary STL has a header with a count, then that number of facets. */
const STL_HEADER_BYTES = 84;
const STL_FACET_BYTES = 50;

/** Enough bytes to distinguish text from binary. */
const HEAD_BYTES = 1024;

/** First bytes of a zip: PK. */
const ZIP = [0x50, 0x4b] as const;

/** Range that contains the end of a zip's directory, followed by a comment of at most 64 KiB. */
const TAIL_BYTES = 1 << 17;

/**
 * Returns true for a binary STL, for text, which no print file is, and for a zip with a model in its directory, such as a 3MF. The core
 * reports faults of a model.
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
