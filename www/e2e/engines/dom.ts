/** Queries, run in the page, for visible content. */
export interface Dom {
  /** Visible elements that match, under all shadow roots. */
  all(css: string): HTMLElement[];
  /** The first of them whose accessible name matches. */
  named(css: string, name: string): HTMLElement | undefined;
}

/** Runs in the page, so it refers to nothing outside itself. */
export function dom(): Dom {
  const under = (root: ParentNode, css: string): HTMLElement[] =>
    [...root.querySelectorAll<HTMLElement>("*")].flatMap((it) => [
      ...(it.matches(css) && it.checkVisibility() ? [it] : []),
      ...(it.shadowRoot === null ? [] : under(it.shadowRoot, css)),
    ]);
  const nameOf = (it: HTMLElement): string => {
    const root = it.getRootNode() as ShadowRoot;
    const byOthers = (it.getAttribute("aria-labelledby") ?? "").split(" ").map((id) => (id === "" ? null : root.getElementById(id)));
    const labels = byOthers[0] == null ? [...((it as HTMLInputElement).labels ?? [])] : byOthers;
    const text = it.ariaLabel ?? (labels.length > 0 ? labels.map((label) => label?.innerText).join(" ") : it.innerText);
    return text.replace(/\s+/g, " ").trim();
  };
  const all = (css: string): HTMLElement[] => under(document, css);
  return { all, named: (css, name) => all(css).find((it) => new RegExp(name).test(nameOf(it))) };
}
