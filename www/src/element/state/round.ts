/** Rounds numbers to few digits, safely for offers. */

/** Relative error of a product of decimals: far below the six digits of the core. */
const SLACK = 1e-9;

/** Rounds a positive value up: to three decimals below 1, two below 10, one below 100, and to a whole number from 100 on. */
export function up(value: number): number {
  const decimals = Math.min(3, Math.max(0, 2 - Math.floor(Math.log10(value))));
  return Math.ceil(value * 10 ** decimals * (1 - SLACK)) / 10 ** decimals;
}

/** Rounds a length in mm down to whole micrometres; the result is in mm. */
export function micrometreBelow(mm: number): number {
  return Math.floor(mm * 1000 * (1 + SLACK)) / 1000;
}
