/** Runs long work in short slices, between which the page responds. */

/** A frame at 60 Hz lasts 16.7 ms, some of which the page itself needs. */
const PART_MS = 8;

/** Interval between progress reports, ms. */
const TELL_EVERY_MS = 100;

/** Yields to the browser. A message arrives sooner than a timer, which browsers delay by 4 ms. */
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
 * Runs a generator of progress values (0 to 1) to its result, in slices of a few ms plus at most one of its steps. Rejects with the
 * signal's reason once the signal is aborted.
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

/** Maps the progress of work to a part of the progress of other work. */
export function* shared<Result>(work: Generator<number, Result>, from: number, to: number): Generator<number, Result> {
  for (;;) {
    const step = work.next();
    if (step.done === true) return step.value;
    yield from + (to - from) * step.value;
  }
}
