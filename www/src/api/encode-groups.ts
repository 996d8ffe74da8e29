/** Encodes the layers of a print file in this worker and its helpers. */
import { encode_group, type LayerGroups } from "../../pkg/cusp_slicer.js";
import type { Help, OnProgress } from "./wire.js";

/** With fewer groups, encoding ends before a helper has started. */
const FEWEST_GROUPS = 6;

/** Groups in stock per helper: while it encodes one, the next one is on its way. */
const STOCK = 2;

/** Returns true if the file is long enough for helpers to save time. */
export function isLong(groups: LayerGroups): boolean {
  return groups.left() >= FEWEST_GROUPS;
}

/**
 * Encodes all groups, in order. This worker takes the groups that find no free helper. At the end it also encodes those still outstanding,
 * since a helper that has just started may take longer than the rest of the file.
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
  // Last group first, because helpers started with the first.
  for (const [group, runs] of [...awaited].reverse()) {
    if (!awaited.delete(group)) continue;
    encoded[group] = encode_group(format, canvas, runs);
    await messages();
  }
  return encoded;
}

/** Yields to the event loop so that messages from other threads arrive. */
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
