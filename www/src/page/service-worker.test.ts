/** The page's service worker, over a cache in memory. */
import { expect, test, vi } from "vitest";

test("a new version waits for the open pages of the one before, which go on fetching its files", async () => {
  const handlers = new Map<string, (event: { waitUntil(work: Promise<unknown>): void }) => void>();
  const kept = new Map([["cusp assets/old.js", [] as string[]]]);
  const skipWaiting = vi.fn<() => void>();
  vi.stubGlobal("__FILES__", ["assets/new.js"]);
  vi.stubGlobal("self", {
    registration: { scope: "https://a.example/cusp/" },
    clients: { claim: async () => undefined },
    skipWaiting,
    addEventListener: (type: string, handler: () => void) => void handlers.set(type, handler),
  });
  vi.stubGlobal("caches", {
    open: async (name: string) => ({ addAll: async (files: string[]) => void kept.set(name, files) }),
    keys: async () => [...kept.keys()],
    delete: async (name: string) => kept.delete(name),
  });
  // Not a literal: its types are those of a worker.
  const script: string = "./service-worker.js";
  await import(script);
  const happens = (type: string): Promise<unknown> => new Promise((resolve) => handlers.get(type)?.({ waitUntil: (work) => resolve(work) }));
  await happens("install");
  expect(skipWaiting).not.toHaveBeenCalled();
  expect([...kept.keys()]).toEqual(["cusp assets/old.js", "cusp assets/new.js"]);
  // Browsers do this once the pages are closed.
  await happens("activate");
  expect([...kept]).toEqual([["cusp assets/new.js", ["https://a.example/cusp/", "https://a.example/cusp/assets/new.js"]]]);
  vi.unstubAllGlobals();
});
