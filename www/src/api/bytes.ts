/** The bytes of a file, in a worker. */
import { said } from "./error.js";

export async function bytesOf(file: Blob): Promise<Uint8Array> {
  try {
    return new Uint8Array(await file.arrayBuffer());
  } catch (cause) {
    const unreadable = { code: "file-unreadable", message: said(cause), detail: null };
    throw unreadable;
  }
}
