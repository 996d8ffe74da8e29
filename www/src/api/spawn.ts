/** Starts workers, whatever origin serves their script. */
import * as Comlink from "comlink";
import { broke, type WorkerHandle } from "./calls.js";
import { whenEnded } from "./liveness.js";
import { listenTo } from "./callbacks.js";
import type { SlicerWorker } from "./wire.js";

/** URL of the folder with the package's files, relative to the page; null: where the bundler put them. */
export type Assets = string | URL | null;

/** URL of a script with its worker options. */
interface Script {
  address: string;
  options: WorkerOptions;
}

/** The page's Trusted Types, which TypeScript's library lacks. */
interface TrustedTypes {
  createPolicy(name: string, rules: Policy): Policy;
}

interface Policy {
  createScriptURL(address: string): string;
}

/** Starts the slicer's worker. Throws `worker-failed` if the browser refuses. */
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
  // Bundlers' own blobs also start other workers, so those are not revoked.
  if (start !== script) worker.addEventListener("message", () => URL.revokeObjectURL(start.address), { once: true });
  listenTo(worker);
  return {
    remote: Comlink.wrap<SlicerWorker>(worker),
    terminate: () => worker.terminate(),
    onBroken: (callback) => {
      // Browsers give no reason if a script fails to load.
      worker.addEventListener("error", (event) => callback(event.message || `${script.address} could not be loaded`));
      worker.addEventListener("messageerror", () => callback("a message could not be read"));
      whenEnded(worker, () => callback("the worker has ended"));
    },
  };
}

/** URL of the WebAssembly module. */
export const wasmAddress = (assets: Assets): string =>
  // Bundlers recognise this exact form and emit the file.
  assets === null ? absolute(new URL("../../pkg/cusp_slicer_bg.wasm", import.meta.url)) : within(assets, "cusp_slicer_bg.wasm");

/** Absolute URL: a worker from a blob resolves no relative ones, and Turbopack's have no origin. */
const absolute = ({ href }: URL): string => new URL(href, globalThis.document?.baseURI).href;

const within = (folder: string | URL, name: string): string => new URL(name, new URL(String(folder).replace(/\/?$/, "/"), document.baseURI)).href;

/**
 * Script URL as the bundler emits it. Bundlers recognise only the whole expression `new Worker(new URL(…))`, but the worker may not be
 * allowed to start from that URL, so a stand-in for `Worker` captures what the bundler made of it.
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

/**
 * A script that a worker may start from. A page cannot start a worker from another origin, but a worker of the page's own origin may import
 * a script from there if CORS allows.
 */
function fromHere(script: Script): Script {
  const { address, options } = script;
  const { href, protocol, origin } = new URL(address, location.href);
  if (!/^https?:$/.test(protocol) || origin === globalThis.origin) return script;
  const code = options.type === "module" ? importing(href) : running(href);
  const blob = new Blob([code], { type: "text/javascript" });
  // In a sandboxed frame, Chromium starts no module from a blob, and WebKit reads no file in a worker from a `data:` URL.
  return { address: URL.createObjectURL(blob), options: { ...options, type: "classic" } };
}

/**
 * Runs a classic script with its own `location` instead of the blob's: Turbopack's script finds there what to load, and loads only from
 * that origin.
 */
const running = (address: string): string => `
Object.defineProperty(self, "location", { value: new URL(${JSON.stringify(address)}) });
importScripts(location.href);`;

/** Imports a module, and replays the messages that arrive before it has loaded. */
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

/** A URL as accepted by pages that enforce Trusted Types. */
function trusted(address: string): string {
  const { trustedTypes } = globalThis as { trustedTypes?: TrustedTypes };
  try {
    policy ??= trustedTypes?.createPolicy("cusp", { createScriptURL: (address) => address });
  } catch {
    // The page does not allow this policy. If it also enforces Trusted Types, the browser refuses the worker.
  }
  return policy?.createScriptURL(address) ?? address;
}
