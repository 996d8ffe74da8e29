import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { spawnWorker, wasmAddress } from "./spawn.js";

/** The last worker that was started. */
let started: FakeWorker;
const note = (worker: FakeWorker): void => void (started = worker);

class FakeWorker extends EventTarget {
  constructor(
    readonly address: unknown,
    readonly options: WorkerOptions,
  ) {
    super();
    note(this);
  }
  postMessage(): void {}
}

beforeEach(() => {
  vi.stubGlobal("Worker", FakeWorker);
  vi.stubGlobal("origin", "https://shop.test");
  vi.stubGlobal("location", { href: "https://shop.test/cup" });
  vi.stubGlobal("document", { baseURI: "https://shop.test/cup" });
});

afterEach(() => void vi.unstubAllGlobals());

test("a worker starts from where the bundler has put it, as a module, and the page's own Worker stays", () => {
  spawnWorker(null);
  expect(String(started.address)).toMatch(/\/src\/api\/worker\.ts$/);
  expect(started.options).toMatchObject({ type: "module" });
  expect(globalThis.Worker).toBe(FakeWorker);
  expect(wasmAddress(null)).toMatch(/\/pkg\/cusp_slicer_bg\.wasm$/);
});

test("what the bundler has put there stays for the next worker, and is found from a worker that is nowhere", () => {
  const revoked = vi.spyOn(URL, "revokeObjectURL").mockClear();
  spawnWorker(null);
  started.dispatchEvent(new Event("message"));
  expect(revoked).not.toHaveBeenCalled();
  // Turbopack's URLs have no origin.
  class Relative extends URL {
    override get href(): string {
      return this.protocol === "file:" ? this.pathname : super.href;
    }
  }
  vi.stubGlobal("URL", Relative);
  expect(wasmAddress(null)).toMatch(/^https:\/\/shop\.test\/.*\/pkg\/cusp_slicer_bg\.wasm$/);
});

test.each([
  ["/cusp", "https://shop.test/cusp/"],
  ["cusp/", "https://shop.test/cusp/"],
  [new URL("https://shop.test/v2/"), "https://shop.test/v2/"],
])("assets in the folder %s are found there by their names", (assets, folder) => {
  spawnWorker(assets);
  expect(started.address).toBe(`${folder}worker.js`);
  expect(wasmAddress(assets)).toBe(`${folder}cusp_slicer_bg.wasm`);
});

test.each(["https://shop.test", "null"])("on the origin %s a worker of another is imported by a blob, which is let go once it has started", async (origin) => {
  vi.stubGlobal("origin", origin);
  const revoked = vi.spyOn(URL, "revokeObjectURL").mockClear();
  spawnWorker("https://cdn.test/cusp");
  const address = String(started.address);
  expect(await (await fetch(address)).text()).toContain(`import("https://cdn.test/cusp/worker.js")`);
  expect(started.options.type).toBe("classic");
  expect(revoked).not.toHaveBeenCalled();
  started.dispatchEvent(new Event("message"));
  expect(revoked).toHaveBeenCalledWith(address);
});

test("what the browser refuses is an error with a code, whether it says so at once or later", () => {
  vi.stubGlobal("Worker", function refuse() {
    throw new DOMException("cannot be accessed from origin", "SecurityError");
  });
  const refused = expect.objectContaining({ code: "worker-failed", detail: { system: "cannot be accessed from origin" } });
  expect(() => spawnWorker("/cusp")).toThrow(refused as Error);
  expect(() => spawnWorker("http://[")).toThrow(expect.objectContaining({ code: "worker-failed" }) as Error);
  vi.stubGlobal("Worker", FakeWorker);
  const said: string[] = [];
  spawnWorker("/cusp").onBroken((message) => said.push(message));
  started.dispatchEvent(new Event("error"));
  started.dispatchEvent(Object.assign(new Event("error"), { message: "unexpected token" }));
  expect(said).toEqual(["https://shop.test/cusp/worker.js could not be loaded", "unexpected token"]);
});

test("under Trusted Types the address is that of the policy `cusp`, which is made once", () => {
  const made: string[] = [];
  const createPolicy = (name: string): { createScriptURL(address: string): object } => {
    made.push(name);
    return { createScriptURL: (address) => ({ trusted: address }) };
  };
  vi.stubGlobal("trustedTypes", { createPolicy });
  spawnWorker("/cusp");
  spawnWorker("/cusp");
  expect(started.address).toEqual({ trusted: "https://shop.test/cusp/worker.js" });
  expect(made).toEqual(["cusp"]);
});
