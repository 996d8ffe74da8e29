/** Rounding to numbers that are short to read and safe to offer. */

/** What a product of decimals may be off by: far less than the six digits that the core gives. */
const SLACK = 1e-9;

/** The least number with three decimals, fewer from 1 on, that is not below `value`, which is positive. */
export function up(value: number): number {
  const decimals = Math.min(3, Math.max(0, 2 - Math.floor(Math.log10(value))));
  return Math.ceil(value * 10 ** decimals * (1 - SLACK)) / 10 ** decimals;
}

/** The largest whole micrometre, in mm, that is not above `mm`. */
export function micrometreBelow(mm: number): number {
  return Math.floor(mm * 1000 * (1 + SLACK)) / 1000;
}
