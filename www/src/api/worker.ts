/** The worker: the only file that imports the WebAssembly package. One model is open at a time. */
import * as Comlink from "comlink";
import init, { Slicer } from "../../pkg/cusp_slicer.js";
import wasmUrl from "../../pkg/cusp_slicer_bg.wasm?url";
import type { CuspError, OnProgress, SlicerWorker } from "./wire.js";

let slicer: Slicer | null = null;

/** The open model. Asking before `open` is a fault of the page, not of its user. */
function current(): Slicer {
  if (slicer === null) throw new Error("no model is open");
  return slicer;
}

async function compile(): Promise<WebAssembly.Module> {
  const response = await fetch(wasmUrl);
  if (!response.ok) throw new Error(`the slicer could not be loaded (HTTP ${response.status})`);
  // Streaming needs the right content type, which plain file hosts do not always send.
  const typed = response.headers.get("content-type")?.startsWith("application/wasm") ?? false;
  return typed ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer());
}

async function bytesOf(file: Blob): Promise<Uint8Array> {
  try {
    return new Uint8Array(await file.arrayBuffer());
  } catch (cause) {
    const unreadable: CuspError = {
      code: "file-unreadable",
      message: cause instanceof Error ? cause.message : String(cause),
      detail: null,
    };
    throw unreadable;
  }
}

/** The core is given a plain function: what comlink hands over is a proxy that answers to every property. */
function plain(progress: OnProgress): OnProgress {
  return (stage, fraction) => {
    progress(stage, fraction);
  };
}

const api: SlicerWorker = {
  async boot(module) {
    const compiled = module ?? (await compile());
    await init({ module_or_path: compiled });
    return compiled;
  },
  async open(file, progress) {
    progress("load", 0);
    const opened = new Slicer(await bytesOf(file));
    slicer?.free();
    slicer = opened;
    return opened.info();
  },
  async plan(options, progress) {
    const report = await current().plan(options, plain(progress));
    const profile = current().profile(report.metric, report.source);
    return Comlink.transfer({ report, profile }, [profile.buffer]);
  },
  mask(layer) {
    const bits = current().mask(layer);
    return Comlink.transfer(bits, [bits.buffer]);
  },
  archive(progress) {
    const zip = current().archive(plain(progress));
    return Comlink.transfer(zip, [zip.buffer]);
  },
};

Comlink.expose(api);
