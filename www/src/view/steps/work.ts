/** Long work done in small parts between which the page answers. */

/** A frame at 60 Hz lasts 16.7 ms, of which the page itself needs some. */
const PART_MS = 8;

/** How often progress is told, ms. */
const TELL_EVERY_MS = 100;

/** Gives the browser its turn. A message comes sooner than a timer, which browsers hold back for 4 ms. */
function turn(): Promise<void> {
  return new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      resolve();
    };
    port2.postMessage(null);
  });
}

/**
 * Runs a generator of progress values (0 to 1) to its result, no longer than a few ms at a stretch plus one of its
 * steps. Rejects with the signal's reason once that is aborted.
 */
export async function inParts<Result>(
  work: Generator<number, Result>,
  signal: AbortSignal,
  tell: (progress: number) => void = () => undefined,
): Promise<Result> {
  let told = performance.now();
  for (;;) {
    const end = performance.now() + PART_MS;
    let step = work.next();
    while (step.done !== true && performance.now() < end) step = work.next();
    if (step.done === true) return step.value;
    if (performance.now() - told > TELL_EVERY_MS) {
      told = performance.now();
      tell(step.value);
    }
    await turn();
    signal.throwIfAborted();
  }
}
