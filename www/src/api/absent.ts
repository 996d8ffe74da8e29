/** The slicer without workers, as in server-side rendering: it does nothing, and every call rejects with `no-browser`. */
import { SlicerError } from "./error.js";
import type { Slicer } from "./index.js";

export function absentSlicer(): Slicer {
  const error = (): SlicerError => new SlicerError("no-browser", "there is no browser here: call this in the page");
  const reject = (): Promise<never> => Promise.reject(error());
  const nothing = (): void => undefined;
  return {
    load: reject,
    add: reject,
    update: reject,
    remove: reject,
    models: reject,
    arrange: reject,
    problems: reject,
    plan: reject,
    mask: reject,
    check: reject,
    tradeoff: reject,
    compare: reject,
    orient: reject,
    measure: reject,
    export: reject,
    plugs: reject,
    exportAll: () => new ReadableStream({ start: (controller) => controller.error(error()) }),
    exportStream: () => new ReadableStream({ start: (controller) => controller.error(error()) }),
    positions: reject,
    preview: reject,
    saliency: reject,
    setWeights: reject,
    weightsFile: reject,
    readWeights: reject,
    calibrateLayers: reject,
    calibrateCure: reject,
    fitCure: reject,
    printers: reject,
    readProject: reject,
    writeProject: reject,
    price: reject,
    warm: nothing,
    rest: nothing,
    dispose: nothing,
  };
}
