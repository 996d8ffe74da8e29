/**
 * `<cusp-tour>`: three cards about the page, each next to its target, which is outlined meanwhile. Blocks nothing and takes no focus. Next,
 * Skip and Escape end it; then it removes itself.
 *
 * Its host provides the `targets`, one per card, as functions, since elements come and go; and `clearance`, the height of fixed content at
 * the bottom of the window.
 */
import { css, html, nothing, type TemplateResult } from "lit";
import { define } from "../element/define.js";
import { shared } from "../element/styles/shared.js";
import { theme } from "../element/styles/theme.js";
import { languageOf, type Language } from "../texts/index.js";
import { elementWith, given, own } from "../view/properties.js";
import { visitWords } from "./visit-texts.js";
import { placeOf } from "./tour-place.js";

export type Target = () => Element | null;

const PROPERTIES = {
  targets: given<readonly Target[]>([]),
  clearance: given((): number => 0),
  language: given<Language>(languageOf()),
  /** Index of the card; -1 before the first. */
  step: own(-1),
};

export class CuspTour extends elementWith(PROPERTIES) {
  readonly #resized = new ResizeObserver(() => this.#place());
  #seen: Element | null = null;
  /** Element that had the focus before the tour. */
  #from: HTMLElement | null = null;

  static override styles = [
    theme,
    shared,
    css`
      :host {
        font-size: 0.9375rem;
      }
      .card,
      .frame {
        position: fixed;
        z-index: 2;
        inset: 0 auto auto 0;
      }
      .card {
        width: min(17.5rem, 100vw - 1rem);
        padding: 1rem;
        border-color: var(--cusp-field);
        box-shadow: 0 8px 30px rgb(0 0 0 / 0.25);
        animation: appear 150ms;
      }
      .card.waiting {
        visibility: hidden;
      }
      .frame {
        border: 3px solid var(--cusp-focus);
        border-radius: 10px;
        pointer-events: none;
      }
      @media (forced-colors: active) {
        .frame {
          border-color: Highlight;
        }
      }
      .title,
      .buttons {
        display: flex;
        justify-content: space-between;
        gap: 0.5rem;
      }
      .title {
        align-items: baseline;
        margin-bottom: 0.25rem;
      }
      .text {
        text-wrap: pretty;
      }
      .buttons {
        justify-content: end;
        margin-top: 0.75rem;
      }
      button,
      .quiet {
        white-space: nowrap;
      }
      @keyframes appear {
        from {
          opacity: 0;
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    addEventListener("keydown", this.#key);
    addEventListener("resize", this.#place);
    addEventListener("scroll", this.#place, { capture: true, passive: true });
    this.addEventListener("focusin", this.#entered);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    removeEventListener("keydown", this.#key);
    removeEventListener("resize", this.#place);
    removeEventListener("scroll", this.#place, { capture: true });
    this.#resized.disconnect();
  }

  override firstUpdated(): void {
    // Screen readers announce changes, so the text's container must exist first.
    requestAnimationFrame(() => (this.step = 0));
    this.#resized.observe(document.body);
  }

  override render(): TemplateResult {
    const { step, language } = this;
    const { tour: words } = visitWords(language);
    const { count } = language.format;
    const { length } = words.steps;
    const [title, text] = words.steps[step] ?? ["", ""];
    const isLast = step === length - 1;
    return html`<div class="frame" hidden></div>
      <section class="card ${step < 0 ? "waiting" : ""}" aria-label=${words.region}>
        <div aria-live="polite">
          <p class="title">
            <strong>${title}</strong>
            <span class="quiet figures">${step < 0 ? nothing : words.place({ step: count(step + 1), steps: count(length) })}</span>
          </p>
          <p class="text">${text}</p>
        </div>
        <div class="buttons">
          ${isLast ? nothing : html`<button class="small" @click=${this.#end}>${words.skip}</button>`}
          <button class="small primary" @click=${isLast ? this.#end : () => this.step++}>${isLast ? words.done : words.next}</button>
        </div>
      </section>`;
  }

  override updated(): void {
    this.#place();
  }

  /** Observes the target of this step. */
  #look(): void {
    const target = this.targets[this.step]?.() ?? null;
    if (target === this.#seen) return;
    if (this.#seen !== null) this.#resized.unobserve(this.#seen);
    if (target !== null) this.#resized.observe(target);
    this.#seen = target;
  }

  readonly #place = (): void => {
    const frame = this.renderRoot.querySelector<HTMLElement>(".frame");
    const card = this.renderRoot.querySelector<HTMLElement>(".card");
    if (frame === null || card === null) return;
    // The target may have appeared late, or have been replaced.
    this.#look();
    const box = this.#seen?.getBoundingClientRect();
    const isSeen = box !== undefined && box.width > 0 && box.top < innerHeight && box.bottom > 0;
    frame.hidden = !isSeen;
    if (isSeen) {
      Object.assign(frame.style, { width: `${box.width}px`, height: `${box.height}px`, translate: `${box.left}px ${box.top}px` });
    }
    const { width, height } = card.getBoundingClientRect();
    const room = { width: document.documentElement.clientWidth, height: innerHeight - this.clearance() };
    const [left, top] = placeOf(isSeen ? box : null, { width, height }, room);
    card.style.translate = `${left}px ${top}px`;
  };

  readonly #key = (event: KeyboardEvent): void => {
    if (event.key === "Escape" && !event.defaultPrevented) this.#end();
  };

  readonly #entered = ({ relatedTarget }: FocusEvent): void => {
    if (relatedTarget instanceof HTMLElement && relatedTarget !== this) this.#from = relatedTarget;
  };

  readonly #end = (): void => {
    if (this.matches(":focus-within")) this.#from?.focus();
    this.remove();
  };
}

define("cusp-tour", CuspTour);

declare global {
  interface HTMLElementTagNameMap {
    "cusp-tour": CuspTour;
  }
}
