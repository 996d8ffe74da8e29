/** Starts workers, on whatever origin their script is. */
import * as Comlink from "comlink";
import { broke, type WorkerHandle } from "./calls.js";
import { whenEnded } from "./liveness.js";
import { listenTo } from "./told.js";
import type { SlicerWorker } from "./wire.js";

/** URL of the folder with the package's files, relative to the page; null: they are where a bundler has put them. */
export type Assets = string | URL | null;

/** A script, and whether it is a module. */
interface Script {
  address: string;
  options: WorkerOptions;
}

/** A page's Trusted Types, which TypeScript's library does not know. */
interface TrustedTypes {
  createPolicy(name: string, rules: Policy): Policy;
}

interface Policy {
  createScriptURL(address: string): string;
}

/** Starts the slicer's worker. Throws `worker-failed` if the browser refuses to. */
export function spawnWorker(assets: Assets): WorkerHandle {
  let script: Script;
  let start: Script;
  let worker: Worker;
  try {
    script = assets === null ? bundled() : { address: within(assets, "worker.js"), options: { type: "module", name: "cusp-slicer" } };
    start = fromHere(script);
    worker = new Worker(trusted(start.address), start.options);
  } catch (error) {
    throw broke("worker-failed", error);
  }
  // The blobs of bundlers start other workers, too.
  if (start !== script) worker.addEventListener("message", () => URL.revokeObjectURL(start.address), { once: true });
  listenTo(worker);
  return {
    remote: Comlink.wrap<SlicerWorker>(worker),
    terminate: () => worker.terminate(),
    onBroken: (callback) => {
      // Browsers give no reason for a script that they have not loaded.
      worker.addEventListener("error", (event) => callback(event.message || `${script.address} could not be loaded`));
      worker.addEventListener("messageerror", () => callback("a message could not be read"));
      whenEnded(worker, () => callback("the worker has ended"));
    },
  };
}

/** The address of the WebAssembly module. */
export const wasmAddress = (assets: Assets): string =>
  // Bundlers recognise this exact form and emit the file.
  assets === null ? absolute(new URL("../../pkg/cusp_slicer_bg.wasm", import.meta.url)) : within(assets, "cusp_slicer_bg.wasm");

/** An address for a worker, which may be from a blob and resolve none: Turbopack's has no origin. */
const absolute = ({ href }: URL): string => new URL(href, globalThis.document?.baseURI).href;

const within = (folder: string | URL, name: string): string => new URL(name, new URL(String(folder).replace(/\/?$/, "/"), document.baseURI)).href;

/**
 * The script as a bundler has written it. Bundlers recognise a worker by the whole expression alone, whose worker may not be allowed to
 * start from there: a stand-in takes what they have made of it.
 */
function bundled(): Script {
  const { Worker: own } = globalThis;
  const standIn = function (address: URL | string, options: WorkerOptions): Script {
    return { address: String(address), options };
  };
  globalThis.Worker = standIn as unknown as typeof Worker;
  try {
    return new Worker(new URL("./worker.ts", import.meta.url), { type: "module", name: "cusp-slicer" }) as unknown as Script;
  } finally {
    globalThis.Worker = own;
  }
}

/** A script that a worker may start from: pages start none from another origin, but theirs may import one from there, if that allows it (CORS). */
function fromHere(script: Script): Script {
  const { address, options } = script;
  const { href, protocol, origin } = new URL(address, location.href);
  if (!/^https?:$/.test(protocol) || origin === globalThis.origin) return script;
  const code = options.type === "module" ? importing(href) : running(href);
  const blob = new Blob([code], { type: "text/javascript" });
  // In a sandboxed frame Chromium starts no module from a blob, and WebKit reads no file in a worker from a `data:`.
  return { address: URL.createObjectURL(blob), options: { ...options, type: "classic" } };
}

/** Runs a classic script, to which `location` is its own, not the blob's: at its end Turbopack's reads what to load, and loads it from that origin alone. */
const running = (address: string): string => `
Object.defineProperty(self, "location", { value: new URL(${JSON.stringify(address)}) });
importScripts(location.href);`;

/** Imports a module, and hands it the messages that have arrived by then. */
const importing = (address: string): string => `
const early = [];
const keep = (event) => early.push(event);
addEventListener("message", keep);
import(${JSON.stringify(address)}).then(
  () => {
    removeEventListener("message", keep);
    for (const { data, ports } of early) dispatchEvent(new MessageEvent("message", { data, ports }));
  },
  // The page hears of no rejection, but of an error.
  (error) => setTimeout(() => { throw error; }),
);`;

let policy: Policy | undefined;

/** An address as pages want it that enforce Trusted Types. */
function trusted(address: string): string {
  const { trustedTypes } = globalThis as { trustedTypes?: TrustedTypes };
  try {
    policy ??= trustedTypes?.createPolicy("cusp", { createScriptURL: (address) => address });
  } catch {
    // Not among those that the page allows. If it enforces them too, the browser refuses the worker.
  }
  return policy?.createScriptURL(address) ?? address;
}
