/**
 * Clears the upper halves of the vector registers on this thread.
 *
 * A worker inherits their state from the page's thread, where Firefox sometimes leaves them in use. On some processors, everything that the
 * worker computes then takes up to 50 times as long (docs/decisions/009-workers.md). Only the instruction `vzeroupper` clears them, which a script cannot
 * issue, but number formatting runs it.
 *
 * @returns the formatted number, so that no compiler drops the call as one without effect
 */
export const endUpperHalves = (): string => new Intl.NumberFormat("en").format(0);
