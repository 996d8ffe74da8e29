/** What lit asks of a browser as soon as it is imported: the globals in a browser, and what stands in for them on a server. */
class NoElement {}

export const HTMLElement = globalThis.HTMLElement ?? NoElement;
export const document = globalThis.document ?? { createTreeWalker: () => null };
