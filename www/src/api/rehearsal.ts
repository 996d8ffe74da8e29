/** A job that is thrown away: browsers compile code when it first runs, and optimise what runs often. */
import { encode_group, Job } from "../../pkg/cusp_slicer.js";
import { ring } from "./ring.js";
import { stlOf } from "./stl.js";

/** Parts of each ring, and rays: enough rounds in most loops for optimised code. */
const PARTS = 32;
const RAYS = 256;

/** Plans two rings that overlap, and encodes the first layers of their masks. */
export async function rehearse(): Promise<void> {
  const one = ring(PARTS);
  const other = one.map((coordinate, i) => (i % 3 === 0 ? coordinate + 1 : coordinate));
  const both = new Float32Array(one.length + other.length);
  both.set(one);
  both.set(other, one.length);
  const job = new Job();
  job.add(stlOf(both), {});
  await job.plan({ options: { rays: RAYS, backend: "cpu" } }, () => undefined);
  job.mask(0, 0);
  const groups = job.layer_groups(0);
  const runs = groups?.next_runs();
  if (groups !== undefined && runs !== undefined) encode_group(groups.format(), groups.canvas(), runs);
  groups?.free();
  job.free();
}
