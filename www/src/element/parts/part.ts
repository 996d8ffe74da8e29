/** Parts whose code is fetched when first shown, and the message shown if that fails. */
import { css, html, nothing, type CSSResult, type LitElement, type TemplateResult } from "lit";
import { said, SlicerError } from "../../api/error.js";
import { fetchRest, type Language } from "../../texts/index.js";
import { fetched } from "./fetched.js";

/** Names of the parts. `pictures` are those of the best orientations; `reader` is our page's reader of print files. */
export type Part = "view" | "paint" | "points" | "chart" | "orientation" | "pictures" | "plate" | "warnings" | "findings" | "mask" | "settings" | "printer" | "details" | "saved" | "reader";

export function partError(part: Part, cause: unknown): SlicerError {
  const system = said(cause);
  return new SlicerError("part-failed", `a part of the page could not be loaded: ${part} (${system})`, { part, system });
}

/** Fires `cusp-error` from the panel. It reaches the page as an event of the element; the plan stays. */
export function tellPartFailed(panel: HTMLElement, part: Part, cause: unknown): void {
  const detail = partError(part, cause);
  panel.dispatchEvent(new CustomEvent("cusp-error", { detail, bubbles: true, composed: true }));
}

export function partFailure({ texts }: Language, again: () => void): TemplateResult {
  return html`<div class="part-failed" role="alert">
    <p>${texts.notices.partFailed}</p>
    <button class="small" @click=${again}>${texts.offers.again}</button>
  </div>`;
}

/** A panel's code, fetched when first shown, once for all elements of the page. */
export class FetchedPanel<Code> {
  isThere = false;
  /** The fetched code. */
  code: Code | null = null;
  readonly #part: Part;
  readonly #fetch: () => Promise<Code>;
  readonly #arrived: (code: Code) => void;
  #arriving: Promise<void> | null = null;
  #isMissing = false;

  /** @param arrived called with the code once fetched */
  constructor(part: Part, load: () => Promise<Code>, arrived: (code: Code) => void = () => undefined) {
    this.#part = part;
    this.#fetch = fetched(load);
    this.#arrived = arrived;
  }

  /** Placeholder for the panel. Starts the fetch, and renders the element again at its end. */
  instead(element: LitElement, language: Language): TemplateResult | typeof nothing {
    if (this.#isMissing) {
      return partFailure(language, () => {
        this.#isMissing = false;
        element.requestUpdate();
      });
    }
    this.#arriving ??= Promise.all([this.#fetch(), fetchRest()])
      .then(([code]) => {
        this.#arrived(code);
        this.code = code;
        this.isThere = true;
      })
      .catch((error: unknown) => {
        this.#arriving = null;
        this.#isMissing = true;
        tellPartFailed(element, this.#part, error);
      });
    void this.#arriving.then(() => element.requestUpdate());
    return nothing;
  }
}

/** Adds the styles of fetched code to an element, once. */
export function adopt({ renderRoot }: LitElement, { styleSheet }: CSSResult): void {
  const root = renderRoot as ShadowRoot;
  if (styleSheet !== undefined && !root.adoptedStyleSheets.includes(styleSheet)) root.adoptedStyleSheets = [...root.adoptedStyleSheets, styleSheet];
}

export const partStyles = css`
  .part-failed {
    align-self: center;
    justify-self: center;
    max-width: 28rem;
    padding: 1rem;
    text-align: center;
  }
  .part-failed p {
    margin-bottom: 0.75rem;
  }
`;
