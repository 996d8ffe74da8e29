/** The options of a job of several models, from those of the session. */
import type { Options } from "../../api/wire.js";

/**
 * Each model has its own pose, so points placed by hand would be right for one only.
 *
 * @param isSparing whether the drain holes in place of those keep off what is painted as important
 */
export function jobOf(options: Options, isSparing: boolean): Options {
  const job = { ...options };
  delete job.rotation;
  delete job.height_mm;
  if (job.supports?.points !== undefined) {
    job.supports = { ...job.supports };
    delete job.supports.points;
    delete job.supports.fill;
  }
  if (job.hollow?.drains !== undefined) {
    job.hollow = { ...job.hollow, auto_drain: isSparing ? { spare: true } : {} };
    delete job.hollow.drains;
  }
  return job;
}
