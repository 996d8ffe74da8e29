/** Toolbar of the 3-D view: exclusive modes, and switches in a list that opens. */
import { css, html, nothing, svg, type TemplateResult } from "lit";
import type { Language } from "../../texts/index.js";
import { viewingTexts } from "../../texts/viewing.js";
import type { Tool } from "../../view/scene/keys.js";

export interface ViewBar {
  readonly tool: Tool;
  readonly isPrinted: boolean;
  /** True if the colours show distances from the model. */
  readonly isMeasured: boolean;
  readonly isAligned: boolean;
  /** True if the chart is next to the view, which could align with it. */
  readonly isBeside: boolean;
  readonly isCut: boolean;
  /** True if the model is rotated from its orientation in the file. */
  readonly isTurned: boolean;
  /** True if there is a 3-D view. */
  readonly isPossible: boolean;
  /** Available tools besides those in `ALWAYS`. */
  readonly offered: ReadonlySet<Tool>;
  readonly language: Language;
  /** Shown below the bar, over the view. */
  readonly below: unknown;
  chosen(tool: Tool): void;
  printed(on: boolean): void;
  measured(on: boolean): void;
  aligned(on: boolean): void;
  cut(on: boolean): void;
  upright(): void;
}

const TOOLS: readonly Tool[] = ["turn", "move", "rotate", "size", "flat", "paint", "supports", "drains"];
const ALWAYS: ReadonlySet<Tool> = new Set(["turn", "rotate", "size", "flat", "paint"]);

/** SVG paths in a square of 20 units. */
const ICONS = {
  turn: "M2 10s3-5 8-5 8 5 8 5-3 5-8 5-8-5-8-5zM12.5 10a2.5 2.5 0 1 1-5 0 2.5 2.5 0 0 1 5 0z",
  move: "M10 2.5v15M2.5 10h15M7.5 5 10 2.5 12.5 5M7.5 15l2.5 2.5 2.5-2.5M5 7.5 2.5 10 5 12.5M15 7.5l2.5 2.5-2.5 2.5",
  rotate: "M4 3.5V8h4.5M4.4 8A6.5 6.5 0 1 1 3.5 11",
  size: "M3 9v8h8M3 17l6-6M9 3h8v8M17 3l-6 6",
  flat: "M2.5 17h15M3.5 14h13M5.5 10.5 9 4l6.5 3.5-2 3.5M12 9v2.5M10.5 10l1.5 1.5 1.5-1.5",
  paint: "m17 3-8 8.5M9 11.5c-2.6-.6-4 1-4 2.8 0 1.2-.9 1.9-2 1.9 1.6 1.6 7.3 1.7 7.5-2.3 0-1.2-.5-2-1.5-2.4z",
  supports: "M10 2.5a3.5 3.5 0 1 1 0 7 3.5 3.5 0 0 1 0-7zM10 9.5v7.5M6 17h8M4 12l3 2.5M16 12l-3 2.5",
  drains: "M3 9V4.5h14V9M3 9h4.5M12.5 9H17M10 10.5s-2.5 3-2.5 4.6a2.5 2.5 0 0 0 5 0c0-1.6-2.5-4.6-2.5-4.6z",
  printed: "M2.5 16.5h4v-4h4v-4h4v-4h3",
  measured: "M3 4v12M17 4v12M5.5 10h9M8 7.5 5.5 10 8 12.5M12 7.5l2.5 2.5-2.5 2.5",
  aligned: "M4 16.5V9l2-5.5h2l2 5.5v7.5zM13 3.5v13M13 6h4.5M13 10h2.5M13 14h4",
  cut: "M2.5 9.5h15M5 9.5V17h10V9.5M5.5 6.5V5M5.5 3h2M10 3h1.5M14.5 5V3h-1M14.5 8V7",
  display: "M3 6h14M3 10h14M3 14h14",
  upright: "M3.5 17h13M10 13.5V4M6.5 7.5 10 4l3.5 3.5",
} as const;

const icon = (name: keyof typeof ICONS): TemplateResult =>
  html`<svg viewBox="0 0 20 20" aria-hidden="true">${svg`<path d=${ICONS[name]} />`}</svg>`;

const isOn = ({ target }: Event): boolean => (target as HTMLInputElement).checked;

export function viewBar(bar: ViewBar): TemplateResult {
  const { isPossible, language } = bar;
  const words = viewingTexts(language);
  const described = isPossible ? nothing : "impossible";
  const mode = (tool: Tool): TemplateResult => html`<label class="mode" title=${words.hints[tool]}>
    <input
      type="radio"
      name="tool"
      aria-describedby=${described}
      ?disabled=${!isPossible}
      .checked=${bar.tool === tool}
      @change=${() => bar.chosen(tool)}
    />
    ${icon(tool)}<span class="name">${words.tools[tool]}</span>
  </label>`;
  const toggle = (name: "printed" | "measured" | "aligned" | "cut", checked: boolean): TemplateResult => html`<label class="switch">
    <input
      type="checkbox"
      role="switch"
      aria-describedby=${described}
      ?disabled=${!isPossible}
      .checked=${checked}
      @change=${(event: Event) => bar[name](isOn(event))}
    />
    ${icon(name)}<span class="name">${words[name]}</span><span class="track"></span>
  </label>`;
  return html`<div class="bar">
      <div class="strip">
        <fieldset class="group modes">
          <legend class="visually-hidden">${words.modes}</legend>
          ${TOOLS.filter((tool) => ALWAYS.has(tool) || bar.offered.has(tool)).map(mode)}
        </fieldset>
        ${bar.isTurned
          ? html`<button class="small action" title=${words.upright} @click=${bar.upright}>
              ${icon("upright")}<span class="name">${words.upright}</span>
            </button>`
          : nothing}
        <details class="display" @focusout=${left} @keydown=${closed}>
          <summary class="action">${icon("display")}<span class="name">${words.switches}</span></summary>
          <div class="switches">
            ${bar.isBeside ? toggle("aligned", bar.isAligned) : nothing} ${toggle("cut", bar.isCut)}
            ${toggle("printed", bar.isPrinted)} ${toggle("measured", bar.isMeasured)}
          </div>
        </details>
      </div>
      ${bar.below}
    </div>
    ${isPossible ? nothing : html`<p class="quiet impossible" id="impossible">${words.impossible}</p>`}`;
}

/** Closes the list when the focus leaves it. */
function left({ currentTarget, relatedTarget }: FocusEvent): void {
  const list = currentTarget as HTMLDetailsElement;
  if (!list.contains(relatedTarget as Node | null)) list.open = false;
}

/** Closes the list by Escape, which then cancels no task. */
function closed(event: KeyboardEvent): void {
  const list = event.currentTarget as HTMLDetailsElement;
  if (event.key !== "Escape" || !list.open) return;
  event.stopPropagation();
  list.open = false;
  list.querySelector("summary")?.focus();
}

export const barStyles = css`
  .bar {
    /* A layout may put it over the view. */
    position: var(--cusp-bar-position, relative);
    z-index: 2;
    inset: 0.625rem calc(0.625rem + var(--cusp-view-aside, 0px)) auto 0.625rem;
    pointer-events: none;
    flex: none;
    margin-bottom: 0.75rem;
    font-size: 0.6875rem;
    font-weight: 550;
    line-height: 1.25;
  }
  .strip {
    display: flex;
    flex-wrap: wrap;
    gap: 0.25rem 0.5rem;
  }
  .strip > * {
    pointer-events: auto;
    background: var(--cusp-card);
  }
  .group {
    display: flex;
    min-width: 0;
    border-radius: 8px;
  }
  .mode,
  .action {
    position: relative;
    isolation: isolate;
    display: flex;
    flex-direction: column;
    align-items: center;
    justify-content: center;
    gap: 0.125rem;
    min-width: 2.75rem;
    min-height: 2.75rem;
    padding: 0.125rem 0.3125rem;
    cursor: pointer;
    white-space: nowrap;
  }
  .display {
    position: relative;
    /* Its list lies over the fields. */
    z-index: 1;
    margin-inline-start: auto;
    border-radius: 8px;
    display: var(--cusp-view-switches, block);
  }
  summary.action {
    border: 1px solid var(--cusp-field);
    border-radius: 8px;
    list-style: none;
  }
  summary.action::-webkit-details-marker {
    display: none;
  }
  summary.action:hover {
    background: var(--cusp-note-wash);
  }
  .switches {
    position: absolute;
    inset: calc(100% + 0.25rem) 0 auto auto;
    width: max-content;
    padding: 0.25rem;
    border: 1px solid var(--cusp-line);
    border-radius: 8px;
    background: var(--cusp-card);
    box-shadow: 0 4px 16px rgb(0 0 0 / 18%);
    font-size: 0.875rem;
    font-weight: 400;
  }
  .switch {
    position: relative;
    isolation: isolate;
    display: flex;
    align-items: center;
    gap: 0.5rem;
    min-height: 2.25rem;
    padding-inline: 0.5rem;
    cursor: pointer;
  }
  /* The control itself covers its label, so that it is what pointers meet. */
  .strip input {
    position: absolute;
    z-index: 1;
    inset: 0;
    width: 100%;
    height: 100%;
    margin: 0;
    opacity: 0;
    cursor: inherit;
  }
  .bar svg {
    flex: none;
    width: 1.25rem;
    height: 1.25rem;
    fill: none;
    stroke: currentColor;
    stroke-width: 1.5;
    stroke-linecap: round;
    stroke-linejoin: round;
  }
  .mode {
    border: 1px solid var(--cusp-field);
    border-inline-end-width: 0;
  }
  .mode:first-of-type {
    border-start-start-radius: 8px;
    border-end-start-radius: 8px;
  }
  .mode:last-of-type {
    border-inline-end-width: 1px;
    border-start-end-radius: 8px;
    border-end-end-radius: 8px;
  }
  .mode:hover {
    background: var(--cusp-note-wash);
  }
  .mode:has(:checked) {
    background: var(--cusp-accent);
    color: var(--cusp-on-accent);
  }
  .switch {
    border-radius: 8px;
  }
  .switch:hover {
    background: var(--cusp-note-wash);
  }
  .track {
    flex: none;
    position: relative;
    margin-inline-start: auto;
    width: 1.375rem;
    height: 0.875rem;
    border: 1px solid var(--cusp-field);
    border-radius: 1rem;
  }
  .track::before {
    content: "";
    position: absolute;
    inset-block: 2px;
    inset-inline-start: 2px;
    width: 0.5rem;
    border-radius: 50%;
    background: var(--cusp-field);
    transition: translate 120ms;
  }
  :checked ~ .track {
    border-color: var(--cusp-accent);
    background: var(--cusp-accent);
  }
  :checked ~ .track::before {
    translate: calc(1.25rem - 0.5rem - 4px);
    background: var(--cusp-on-accent);
  }
  :checked ~ .track:dir(rtl)::before {
    translate: calc(4px + 0.5rem - 1.25rem);
  }
  .mode:has(:focus-visible),
  .switch:has(:focus-visible) {
    z-index: 1;
    outline: 3px solid var(--cusp-focus);
    outline-offset: 2px;
  }
  .mode:has(:disabled),
  .switch:has(:disabled) {
    opacity: 0.55;
    cursor: default;
  }
  .impossible {
    margin-bottom: 0.75rem;
  }
  /* Names where all of them fit in one line; elsewhere they are at the pointer. */
  @container (max-width: 29.99rem) {
    .mode .name,
    .action .name {
      position: absolute;
      width: 1px;
      height: 1px;
      overflow: hidden;
      clip-path: inset(50%);
      white-space: nowrap;
    }
    .mode,
    .action {
      min-width: 2.25rem;
      min-height: 2.25rem;
    }
  }
  @media (forced-colors: active) {
    .mode:has(:checked) {
      forced-color-adjust: none;
      background: Highlight;
      color: HighlightText;
    }
    .track,
    :checked ~ .track {
      forced-color-adjust: none;
      border-color: CanvasText;
      background: Canvas;
    }
    .track::before {
      background: CanvasText;
    }
    :checked ~ .track {
      background: Highlight;
    }
    :checked ~ .track::before {
      background: HighlightText;
    }
    .mode:has(:disabled),
    .switch:has(:disabled) {
      opacity: 1;
      color: GrayText;
    }
  }
`;
