/** The globals that lit needs on import: the browser's own, or stand-ins on a server. */
class NoElement {}

export const HTMLElement = globalThis.HTMLElement ?? NoElement;
export const document = globalThis.document ?? { createTreeWalker: () => null };
