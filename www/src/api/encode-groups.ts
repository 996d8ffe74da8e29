/** The layers of a print file, encoded by this worker and by those that help it. */
import { encode_group, type LayerGroups } from "../../pkg/cusp_slicer.js";
import type { Help, OnProgress } from "./wire.js";

/** Fewer groups are encoded before a helper has started. */
const FEWEST_GROUPS = 6;

/** Groups in stock per helper: while it encodes one, the next one is on its way. */
const STOCK = 2;

/** Whether help is worth its while. */
export function isLong(groups: LayerGroups): boolean {
  return groups.left() >= FEWEST_GROUPS;
}

/** The encoded groups, in order. What the helpers do not encode, this worker does. */
export async function encodeGroups(groups: LayerGroups, helpers: number, help: Help, progress: OnProgress): Promise<Uint8Array[]> {
  const format = groups.format();
  const canvas = groups.canvas();
  const encoded: Uint8Array[] = [];
  const awaited = new Set<Promise<void>>();
  for (let group = 0, runs = groups.next_runs(); runs !== undefined; group++, runs = groups.next_runs()) {
    const of = runs;
    if (awaited.size < STOCK * helpers && groups.left() > 0) {
      const answer = help(format, canvas, of).then((bytes) => {
        encoded[group] = bytes ?? encode_group(format, canvas, of);
        awaited.delete(answer);
      });
      awaited.add(answer);
    } else {
      encoded[group] = encode_group(format, canvas, of);
    }
    groups.report(progress);
    await messages();
  }
  await Promise.all(awaited);
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
