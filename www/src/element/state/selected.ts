/** The model calls of a slicer, directed at the selected model. */
import type { Slicer } from "../../api/index.js";

export type ModelCalls = Pick<Slicer, "measure" | "orient" | "plugs" | "positions" | "preview" | "readWeights" | "saliency" | "weightsFile">;

/** @param idOf id of the selected model; undefined for the first */
export function aboutSelected(slicer: ModelCalls, idOf: () => number | undefined): ModelCalls {
  const about = <Call extends object>(call: Call | undefined): Call & { model: number | undefined } => ({ ...(call as Call), model: idOf() });
  return {
    measure: (options, direction, call) => slicer.measure(options, direction, about(call)),
    orient: (options, search, call) => slicer.orient(options, search, about(call)),
    plugs: (call) => slicer.plugs(about(call)),
    positions: (call) => slicer.positions(about(call)),
    preview: (options, call) => slicer.preview(options, about(call)),
    readWeights: (file, call) => slicer.readWeights(file, about(call)),
    saliency: (call) => slicer.saliency(about(call)),
    weightsFile: (weights, call) => slicer.weightsFile(weights, about(call)),
  };
}
