/**
 * Makes an element known to the browser, unless it is: two copies of this package may be on one page. On a server, where
 * there are no elements, it does nothing.
 */
export function define(name: string, element: CustomElementConstructor): void {
  if (globalThis.customElements === undefined || customElements.get(name) !== undefined) return;
  customElements.define(name, element);
}
