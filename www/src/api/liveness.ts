/**
 * Tells a page when a worker has ended by itself, of which browsers tell nothing: the worker holds a lock until it ends, and the page waits
 * for it. A computation of any length disturbs nothing, since no message is answered. Where there are no locks, as without HTTPS, nothing tells.
 */

interface Holding {
  lock: string;
}

/** Holds a lock for as long as this worker lives, and tells the page of it. */
export function holdLock(): void {
  const holding: Holding = { lock: `cusp-slicer ${Math.random()}` };
  const held = (): Promise<never> => {
    globalThis.postMessage(holding, {});
    return new Promise(() => undefined);
  };
  navigator.locks?.request(holding.lock, held).catch(() => undefined);
}

/** Calls back once a worker that holds a lock has ended. */
export function whenEnded(worker: Worker, callback: () => void): void {
  worker.addEventListener("message", ({ data }: MessageEvent<Partial<Holding> | null>) => {
    if (data?.lock !== undefined) navigator.locks.request(data.lock, callback).catch(() => undefined);
  });
}
