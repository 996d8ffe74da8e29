/** The worker that reads print files: the only file that imports the reader's WebAssembly. */
import * as Comlink from "comlink";
import init, { PrintReader } from "../../pkg/cusp_reader.js";
import { bytesOf } from "../api/bytes.js";
import "../api/callbacks.js";
import { endUpperHalves } from "../api/vectors.js";
import type { Picture, ReaderWorker } from "./wire.js";

let reader: PrintReader | null = null;

async function start(): Promise<void> {
  endUpperHalves();
  // Bundlers recognise this exact form and emit the file.
  await init({ module_or_path: new URL("../../pkg/cusp_reader_bg.wasm", import.meta.url) });
}

/** The largest readable preview. */
function largest(reader: PrintReader, previews: number): Picture | null {
  const pictures = Array.from({ length: previews }, (_, place) => reader.preview(place)).filter((it) => it !== null);
  return pictures.sort((a, b) => b.width * b.height - a.width * a.height)[0] ?? null;
}

const api: ReaderWorker = {
  start,
  async read(file, progress) {
    reader?.free();
    reader = null;
    const opened = new PrintReader(await bytesOf(file));
    reader = opened;
    const inspection = opened.inspect(progress);
    const [width = 0, height = 0] = opened.pixels();
    const [x_mm = 0, y_mm = 0] = opened.pixel_mm();
    const surface = opened.surface();
    const preview = largest(opened, inspection.previews.length);
    const read = { inspection, pixels: [width, height], pixel_mm: [x_mm, y_mm], surface, preview } as const;
    return Comlink.transfer(read, [surface.buffer, ...(preview === null ? [] : [preview.rgba.buffer])]);
  },
  mask(layer) {
    if (reader === null) throw new Error("no print file is open");
    const bits = reader.mask(layer);
    return Comlink.transfer(bits, [bits.buffer]);
  },
};

Comlink.expose(api);
