/** Nearest `lang` of an element or its ancestors, across shadow roots; null if there is none. */
export function langOf(element: Element): string | null {
  for (let at: Element | null = element; at !== null; ) {
    const found: Element | null = at.closest("[lang]");
    if (found !== null) return found.getAttribute("lang");
    const root: Node = at.getRootNode();
    at = root instanceof ShadowRoot ? root.host : null;
  }
  return null;
}
