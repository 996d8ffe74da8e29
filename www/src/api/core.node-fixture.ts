/** The core in Node, for tests without a worker. */
import { readFile } from "node:fs/promises";
import { initSync, Job } from "../../pkg/cusp_slicer.js";
import type { Options, Report } from "./wire.js";

export async function startCore(): Promise<void> {
  initSync({ module: await readFile(new URL("../../pkg/cusp_slicer_bg.wasm", import.meta.url)) });
}

/** A job of one model. */
export function jobOf(file: Uint8Array): Job {
  const job = new Job();
  job.add(file, {});
  return job;
}

/** The report of a single copy. */
export async function planOf(job: Job, options: Options): Promise<Report> {
  const [report] = (await job.plan({ options }, () => undefined)).plates;
  if (report === undefined) throw new Error("a plan without plates");
  return report;
}
