/**
 * Registers a custom element unless its name is taken: a page may hold two copies of this package. On a server, without
 * custom elements, it does nothing.
 */
export function define(name: string, element: CustomElementConstructor): void {
  if (globalThis.customElements === undefined || customElements.get(name) !== undefined) return;
  customElements.define(name, element);
}
