/** Toolbar of the 3-D view: exclusive modes, and switches. */
import { css, html, nothing, svg, type TemplateResult } from "lit";
import type { Language } from "../../texts/index.js";
import type { Tool } from "../../view/scene/keys.js";

export interface ViewBar {
  readonly tool: Tool;
  readonly isPrinted: boolean;
  /** True if the colours show distances from the model. */
  readonly isMeasured: boolean;
  readonly isAligned: boolean;
  /**
   * True if the chart is next to the view; null without a chart. If false, its switch is hidden but keeps its space: otherwise the bar's
   * height, and with it the layout that decides this, would oscillate.
   */
  readonly isBeside: boolean | null;
  /** True if the model is rotated from its orientation in the file. */
  readonly isTurned: boolean;
  /** True if there is a 3-D view. */
  readonly isPossible: boolean;
  /** Available tools besides those in `ALWAYS`. */
  readonly offered: ReadonlySet<Tool>;
  readonly language: Language;
  chosen(tool: Tool): void;
  printed(on: boolean): void;
  measured(on: boolean): void;
  aligned(on: boolean): void;
  upright(): void;
}

const TOOLS: readonly Tool[] = ["turn", "move", "rotate", "flat", "paint", "supports", "drains"];
const ALWAYS: ReadonlySet<Tool> = new Set(["turn", "rotate", "flat", "paint"]);

/** SVG paths in a square of 20 units. */
const ICONS = {
  turn: "M2 10s3-5 8-5 8 5 8 5-3 5-8 5-8-5-8-5zM12.5 10a2.5 2.5 0 1 1-5 0 2.5 2.5 0 0 1 5 0z",
  move: "M10 2.5v15M2.5 10h15M7.5 5 10 2.5 12.5 5M7.5 15l2.5 2.5 2.5-2.5M5 7.5 2.5 10 5 12.5M15 7.5l2.5 2.5-2.5 2.5",
  rotate: "M4 3.5V8h4.5M4.4 8A6.5 6.5 0 1 1 3.5 11",
  flat: "M2.5 17h15M3.5 14h13M5.5 10.5 9 4l6.5 3.5-2 3.5M12 9v2.5M10.5 10l1.5 1.5 1.5-1.5",
  paint: "m17 3-8 8.5M9 11.5c-2.6-.6-4 1-4 2.8 0 1.2-.9 1.9-2 1.9 1.6 1.6 7.3 1.7 7.5-2.3 0-1.2-.5-2-1.5-2.4z",
  supports: "M10 2.5a3.5 3.5 0 1 1 0 7 3.5 3.5 0 0 1 0-7zM10 9.5v7.5M6 17h8M4 12l3 2.5M16 12l-3 2.5",
  drains: "M3 9V4.5h14V9M3 9h4.5M12.5 9H17M10 10.5s-2.5 3-2.5 4.6a2.5 2.5 0 0 0 5 0c0-1.6-2.5-4.6-2.5-4.6z",
  printed: "M2.5 16.5h4v-4h4v-4h4v-4h3",
  measured: "M3 4v12M17 4v12M5.5 10h9M8 7.5 5.5 10 8 12.5M12 7.5l2.5 2.5-2.5 2.5",
  aligned: "M4 16.5V9l2-5.5h2l2 5.5v7.5zM13 3.5v13M13 6h4.5M13 10h2.5M13 14h4",
  upright: "M3.5 17h13M10 13.5V4M6.5 7.5 10 4l3.5 3.5",
} as const;

const icon = (name: keyof typeof ICONS): TemplateResult =>
  html`<svg viewBox="0 0 20 20" aria-hidden="true">${svg`<path d=${ICONS[name]} />`}</svg>`;

const isOn = ({ target }: Event): boolean => (target as HTMLInputElement).checked;

export function viewBar(bar: ViewBar): TemplateResult {
  const { isPossible, language } = bar;
  const { view: words } = language.texts;
  const mode = (tool: Tool): TemplateResult => html`<label class="mode" title=${words.tools[tool]}>
    <input
      type="radio"
      name="tool"
      aria-describedby=${isPossible ? nothing : "impossible"}
      ?disabled=${!isPossible}
      .checked=${bar.tool === tool}
      @change=${() => bar.chosen(tool)}
    />
    ${icon(tool)}<span class="name">${words.tools[tool]}</span>
  </label>`;
  const toggle = (name: "printed" | "measured" | "aligned", checked: boolean, isShown = true): TemplateResult => html`<label
    class="switch ${isShown ? "" : "unseen"}"
    title=${words[name]}
  >
    <input
      type="checkbox"
      role="switch"
      aria-describedby=${isPossible ? nothing : "impossible"}
      ?disabled=${!isPossible}
      .checked=${checked}
      @change=${(event: Event) => bar[name](isOn(event))}
    />
    ${icon(name)}<span class="name">${words[name]}</span><span class="track"></span>
  </label>`;
  return html`<div class="bar">
      <fieldset class="group modes">
        <legend class="visually-hidden">${words.modes}</legend>
        ${TOOLS.filter((tool) => ALWAYS.has(tool) || bar.offered.has(tool)).map(mode)}
      </fieldset>
      ${bar.isTurned
        ? html`<button class="small upright" title=${words.upright} @click=${bar.upright}>
            ${icon("upright")}<span class="name">${words.upright}</span>
          </button>`
        : nothing}
      <fieldset class="group switches">
        <legend class="visually-hidden">${words.switches}</legend>
        ${bar.isBeside === null ? nothing : toggle("aligned", bar.isAligned, bar.isBeside)}
        ${toggle("printed", bar.isPrinted)} ${toggle("measured", bar.isMeasured)}
      </fieldset>
    </div>
    ${isPossible ? nothing : html`<p class="quiet impossible" id="impossible">${words.impossible}</p>`}`;
}

export const barStyles = css`
  .bar {
    /* A layout may put it over the view. */
    position: var(--cusp-bar-position, static);
    z-index: 1;
    inset: 0.625rem calc(0.625rem + var(--cusp-view-aside, 0px)) auto 0.625rem;
    pointer-events: none;
    flex: none;
    display: flex;
    flex-wrap: wrap;
    align-items: center;
    gap: 0.25rem 0.5rem;
    margin-bottom: 0.75rem;
    font-size: 0.875rem;
    font-weight: 550;
    line-height: 1.25;
  }
  .bar > * {
    pointer-events: auto;
    background: var(--cusp-card);
  }
  .group {
    display: flex;
    min-width: 0;
    border-radius: 8px;
  }
  .switches {
    display: var(--cusp-view-switches, flex);
    margin-inline-start: auto;
  }
  .mode,
  .switch {
    position: relative;
    isolation: isolate;
    display: flex;
    align-items: center;
    justify-content: center;
    gap: 0.375rem;
    min-width: 2.25rem;
    min-height: 2.25rem;
    padding-inline: 0.4375rem;
    cursor: pointer;
  }
  .unseen {
    visibility: hidden;
  }
  /* The control itself covers its label, so that it is what pointers meet. */
  .bar input {
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
  .upright {
    padding-inline: 0.5rem;
    gap: 0.375rem;
  }
  .impossible {
    margin-bottom: 0.75rem;
  }
  /* Names where all of them fit in one line; elsewhere they are the pictures' tooltips. */
  @container (max-width: 107.99rem) {
    .switch .name,
    .upright .name {
      position: absolute;
      width: 1px;
      height: 1px;
      overflow: hidden;
      clip-path: inset(50%);
      white-space: nowrap;
    }
    .switch {
      gap: 0.1875rem;
      padding-inline: 0.25rem;
    }
  }
  @container (max-width: 61.99rem) {
    .mode .name {
      position: absolute;
      width: 1px;
      height: 1px;
      overflow: hidden;
      clip-path: inset(50%);
      white-space: nowrap;
    }
  }
  /* All in one line beside a chart, where a second one would push the view down from beside it. */
  @container (max-width: 31.99rem) {
    .bar {
      column-gap: 0.25rem;
    }
    .switch {
      flex-direction: column;
      gap: 0;
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
