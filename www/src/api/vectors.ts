/**
 * Ends the use of the upper halves of vector registers on this thread.
 *
 * A worker inherits it from the page's thread, which Firefox leaves in it now and then, and on some processors everything that the worker
 * computes then takes up to 50 times as long (ARCHITECTURE.md). A script cannot ask for the instruction that ends it, but what formats
 * numbers runs it.
 *
 * @returns what it formatted, so that no compiler takes the call for one without effect
 */
export const endUpperHalves = (): string => new Intl.NumberFormat("en").format(0);
