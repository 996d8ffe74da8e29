/** The layers of a print file, encoded by this worker and by those that help it. */
import { encode_group, type LayerGroups } from "../../pkg/cusp_slicer.js";
import type { Help, OnProgress } from "./wire.js";

/** Fewer groups are encoded before a helper has started. */
const FEWEST_GROUPS = 6;

/** Groups in stock per helper: while it encodes one, the next one is on its way. */
const STOCK = 2;

/** Returns true if help is worth its while. */
export function isLong(groups: LayerGroups): boolean {
  return groups.left() >= FEWEST_GROUPS;
}

/**
 * The encoded groups, in order. What the helpers do not encode, this worker does: also what they have not sent back when all else is
 * done, as one that has just started may take longer than the rest of the file.
 */
export async function encodeGroups(groups: LayerGroups, helpers: number, help: Help, progress: OnProgress): Promise<Uint8Array[]> {
  const format = groups.format();
  const canvas = groups.canvas();
  const encoded: Uint8Array[] = [];
  const awaited = new Map<number, Uint32Array>();
  for (let group = 0, runs = groups.next_runs(); runs !== undefined; group++, runs = groups.next_runs()) {
    if (awaited.size < STOCK * helpers && groups.left() > 0) {
      awaited.set(group, runs);
      void help(format, canvas, runs).then(
        (bytes) => {
          if (bytes !== null && awaited.delete(group)) encoded[group] = bytes;
        },
        () => undefined,
      );
    } else {
      encoded[group] = encode_group(format, canvas, runs);
    }
    groups.report(progress);
    await messages();
  }
  // From the last on: helpers have begun with the first.
  for (const [group, runs] of [...awaited].reverse()) {
    if (!awaited.delete(group)) continue;
    encoded[group] = encode_group(format, canvas, runs);
    await messages();
  }
  return encoded;
}

/** Lets what other threads have posted arrive. */
function messages(): Promise<void> {
  const { port1, port2 } = new MessageChannel();
  return new Promise((resolve) => {
    port1.onmessage = () => {
      port1.close();
      resolve();
    };
    port2.postMessage(null);
  });
}
