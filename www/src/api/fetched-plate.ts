/** The plate, whose code is fetched with its first call: most pages have one model. */
import { said, SlicerError } from "./error.js";
import type { RunningPlate } from "./plate.js";

/** Calls reach the plate in the order in which they are made. */
export function fetchedPlate(fetch: () => Promise<RunningPlate>): RunningPlate {
  let arriving: Promise<RunningPlate> | null = null;
  let isDisposed = false;

  const there = (): Promise<RunningPlate> => {
    arriving ??= fetch().then(
      (plate) => {
        if (isDisposed) plate.dispose();
        return plate;
      },
      (error: unknown) => {
        // The next call tries again.
        arriving = null;
        const system = said(error);
        throw new SlicerError("part-failed", `a part of the slicer could not be loaded: plate (${system})`, { part: "plate", system });
      },
    );
    return arriving;
  };

  const ignore = (): void => undefined;
  return {
    add: async (...given) => (await there()).add(...given),
    update: async (...given) => (await there()).update(...given),
    remove: async (...given) => (await there()).remove(...given),
    models: async () => (await there()).models(),
    setWeights: async (...given) => (await there()).setWeights(...given),
    positions: async (...given) => (await there()).positions(...given),
    arrange: async (...given) => (await there()).arrange(...given),
    problems: async (...given) => (await there()).problems(...given),
    plan: async (...given) => (await there()).plan(...given),
    mask: async (...given) => (await there()).mask(...given),
    tradeoff: async (...given) => (await there()).tradeoff(...given),
    check: async (...given) => (await there()).check(...given),
    export: async (...given) => (await there()).export(...given),
    price: async (...given) => (await there()).price(...given),
    rest: () => void arriving?.then((plate) => plate.rest(), ignore),
    dispose() {
      isDisposed = true;
      void arriving?.then((plate) => plate.dispose(), ignore);
    },
  };
}
