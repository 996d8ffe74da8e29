/**
 * Detects that a worker has died, which browsers do not report: the worker holds a lock until it ends, and the page waits for that lock.
 * Unlike a heartbeat, this works during a long computation. Without the Web Locks API, as without HTTPS, deaths go unnoticed.
 */

interface Holding {
  lock: string;
}

/** Holds a lock for the lifetime of this worker, and sends its name to the page. */
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
