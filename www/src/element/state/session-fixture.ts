/** A session over a fake slicer, under fake timers. */
import { afterEach, beforeEach, vi } from "vitest";
import { FakeSlicer, model, planOf } from "./fake-slicer.js";
import { Session } from "./session.js";

export let slicer: FakeSlicer;
export let session: Session;

export const settle = (): Promise<unknown> => vi.advanceTimersByTimeAsync(300);

/** Starts a new session with these options, as its element would. */
export function start(options?: ConstructorParameters<typeof Session>[2]): void {
  session = new Session({ requestUpdate: () => undefined }, slicer, options);
}

beforeEach(() => {
  vi.useFakeTimers();
  slicer = new FakeSlicer();
  start();
});

afterEach(() => {
  vi.useRealTimers();
});

/** Opens a model and plans it. */
export async function planned(layers = 10): Promise<void> {
  void session.open(new Blob(), "a.stl");
  slicer.last.resolve(model);
  await settle();
  slicer.last.resolve(planOf(layers));
  await settle();
}
