/** Parts that are fetched when first shown, and what a panel shows if one cannot be loaded. */
import { css, html, nothing, type CSSResult, type LitElement, type TemplateResult } from "lit";
import { said, SlicerError } from "../../api/error.js";
import type { Language } from "../../texts/index.js";
import { fetched } from "./fetched.js";

/**
 * The 3-D view, what paints weights in it, and what places points; the chart of the profile; the panel of orientation, and the
 * pictures of the best ones; the list of models; what will fail; the masks; on our page, the reader of print files.
 */
export type Part = "view" | "paint" | "points" | "chart" | "orientation" | "pictures" | "plate" | "findings" | "mask" | "reader";

export function partError(part: Part, cause: unknown): SlicerError {
  const system = said(cause);
  return new SlicerError("part-failed", `a part of the page could not be loaded: ${part} (${system})`, { part, system });
}

/** Fires `cusp-error` from the panel. It reaches the page as an event of the element, whose plan stays. */
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

/** A panel's code that is fetched when it is first shown, once for all elements of the page. */
export class FetchedPanel<Code> {
  isThere = false;
  /** What was fetched. */
  code: Code | null = null;
  readonly #part: Part;
  readonly #fetch: () => Promise<Code>;
  readonly #arrived: (code: Code) => void;
  #arriving: Promise<void> | null = null;
  #isMissing = false;

  /** @param arrived what to do with it then */
  constructor(part: Part, load: () => Promise<Code>, arrived: (code: Code) => void = () => undefined) {
    this.#part = part;
    this.#fetch = fetched(load);
    this.#arrived = arrived;
  }

  /** What stands in the panel's place until it is there. Fetches it, and has the element rendered again then. */
  instead(element: LitElement, language: Language): TemplateResult | typeof nothing {
    if (this.#isMissing) {
      return partFailure(language, () => {
        this.#isMissing = false;
        element.requestUpdate();
      });
    }
    this.#arriving ??= this.#fetch()
      .then((code) => {
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

/** Gives an element the styles of code that was fetched, once. */
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
