/** A row of tabs by the ARIA pattern: arrow keys select, and Tab leaves the row. */
import { html, type TemplateResult } from "lit";

const STEPS: Readonly<Record<string, number>> = { ArrowRight: 1, ArrowLeft: -1 };

/** @param panel id of the selected tab's panel */
export function tabs<Name extends string>(
  label: string,
  names: readonly Name[],
  chosen: Name,
  words: Readonly<Record<Name, string>>,
  panel: string,
  choose: (name: Name) => void,
): TemplateResult {
  const pressed = (event: KeyboardEvent): void => {
    const right = getComputedStyle(event.currentTarget as Element).direction === "rtl" ? -1 : 1;
    const at = names.indexOf(chosen);
    const step = STEPS[event.key];
    const to = event.key === "Home" ? 0 : event.key === "End" ? names.length - 1 : step === undefined ? -1 : at + right * step;
    const name = names[(to + names.length) % names.length];
    if (name === undefined || (step === undefined && to < 0)) return;
    event.preventDefault();
    choose(name);
    (event.currentTarget as Element).querySelectorAll<HTMLElement>("[role=tab]")[names.indexOf(name)]?.focus();
  };
  return html`<div class="tabs" role="tablist" aria-label=${label} @keydown=${pressed}>
    ${names.map(
      (name) => html`<button
        role="tab"
        id="tab-${name}"
        aria-selected=${name === chosen ? "true" : "false"}
        aria-controls=${panel}
        tabindex=${name === chosen ? 0 : -1}
        @click=${() => choose(name)}
      >
        ${words[name]}
      </button>`,
    )}
  </div>`;
}
