/** The tools for placing support points and drain holes by hand: their counts, the selected point, and actions on all of them. */
import { css, html, nothing, svg, type TemplateResult } from "lit";
import { live } from "lit/directives/live.js";
import { FACTS } from "../../api/facts.js";
import type { Slicer } from "../../api/index.js";
import { stemOf } from "../../api/source.js";
import type { Language } from "../../texts/index.js";
import { placingTexts, type PlacingTexts } from "../../texts/placing.js";
import type { PointDetail } from "../../view/events.js";
import type { Tool } from "../../view/scene/keys.js";
import { iconButton, stepButtons } from "../parts/icon-button.js";
import { saveMade } from "../parts/save-file.js";
import { typed } from "../parts/typed.js";
import {
  added,
  automatic,
  cleared,
  keyOf,
  locked,
  moved,
  pointAt,
  pointsOf,
  removed,
  resized,
  type HandPoint,
  type HandPoints,
} from "../state/hand-points.js";
import { LEAST_MM, MOST_MM, type Placed as Point, type PlacedKind } from "../state/placed.js";
import type { Download } from "../state/host.js";
import type { Session } from "../state/session.js";
import { parse, type Settings } from "../state/settings.js";
import { usualSize } from "../state/support-sizes.js";
import { localised, read } from "../state/typed.js";
import { lineIcon } from "../styles/shared.js";
import { textField } from "../styles/text-field.js";

/** The part of a session that the tools read and change. */
export type Edited = Pick<
  Session,
  "settings" | "options" | "model" | "plate" | "result" | "isCurrent" | "busy" | "weights" | "canUndo" | "canRedo" | "undo" | "redo" | "change" | "write"
>;

/** The points of a tool, and the index of the selected one. */
interface Shown {
  readonly list: readonly HandPoint[];
  readonly place: number | null;
}

const kindOf = (tool: Tool): PlacedKind => (tool === "drains" ? "drains" : "points");

/** Edits the points of a session. */
export class PointEditor {
  readonly #session: Edited;
  readonly #slicer: Pick<Slicer, "plugs">;
  readonly #update: () => void;
  /** Key of the selected point, by its place on the model; its index in the list may change. */
  #selected: string | null = null;
  #drain_mm = FACTS.drain_mm;
  #edits = 0;
  /** The last list, cached, since a new one would count as a change. */
  #known: { readonly of: readonly unknown[]; readonly points: HandPoints } | null = null;

  constructor(session: Edited, slicer: Pick<Slicer, "plugs">, update: () => void) {
    this.#session = session;
    this.#slicer = slicer;
    this.#update = update;
  }

  of(tool: Tool): Shown {
    const { list } = this.#points(kindOf(tool));
    const place = list.findIndex((point) => keyOf(point) === this.#selected);
    return { list, place: place < 0 ? null : place };
  }

  act(tool: Tool, detail: PointDetail): void {
    const kind = kindOf(tool);
    const points = this.#points(kind);
    const { settings } = this.#session;
    switch (detail.do) {
      case "add": {
        const point = pointAt(kind, detail.to, kind === "drains" ? this.#drain_mm : null);
        this.#select(point);
        return this.#change(added(points, point, settings));
      }
      case "move": {
        const point = points.list[detail.place];
        if (point !== undefined) this.#select(pointAt(kind, detail.to, point.diameter_mm));
        return this.#change(moved(points, detail.place, detail.to, settings));
      }
      case "select":
        return this.#select(detail.place === null ? null : (points.list[detail.place] ?? null));
      case "remove":
        return this.#change(removed(points, detail.place, settings));
      case "lock":
        return this.#change(locked(points, detail.place, settings));
    }
  }

  tools(tool: Tool, language: Language): TemplateResult {
    const kind = kindOf(tool);
    const { list, place } = this.of(tool);
    const words = placingTexts(language);
    const { format } = language;
    const session = this.#session;
    const points = this.#points(kind);
    const count = (test: (point: HandPoint) => boolean): string => format.count(list.filter(test).length);
    const button = (name: string, isPossible: boolean, act: () => void): TemplateResult =>
      html`<button class="small" ?disabled=${!isPossible} @click=${act}>${name}</button>`;
    const isAnyUnreached = list.some(({ isUnreached }) => isUnreached);
    return html`<section class="points" aria-label=${words[kind].title}>
      <p class="quiet">${words[kind].hint}</p>
      <dl class="counts">
        ${counted(words.automatic, CIRCLE, count(({ isLocked }) => !isLocked))} ${counted(words.byHand, SQUARE, count(({ isLocked }) => isLocked))}
        ${isAnyUnreached ? counted(words[kind].unreached, CROSS, count(({ isUnreached }) => isUnreached)) : nothing}
      </dl>
      ${this.#selection(tool, list, place, words, language)}
      <div class="actions">
        ${button(words.automatically, true, () => this.#change(automatic(points, session.settings)))}
        ${button(words.clear, list.length > 0, () => this.#change(cleared(kind, points.isAlone)))}
        ${stepButtons(session, language)}
      </div>
      ${kind === "drains"
        ? this.#length(words.newDiameter, this.#drain_mm, language, true, (mm) => {
            this.#drain_mm = mm;
            this.#update();
          })
        : nothing}
      ${this.#protect(words)} ${kind === "drains" ? this.#plugs(words) : nothing}
    </section>`;
  }

  #selection(tool: Tool, list: readonly HandPoint[], place: number | null, words: PlacingTexts, language: Language): TemplateResult {
    const kind = kindOf(tool);
    const { format } = language;
    const { settings } = this.#session;
    const point = place === null ? undefined : list[place];
    const strength = settings.supports === "none" ? "medium" : settings.supports;
    const usual_mm = parse(settings.contact) ?? usualSize("contact", strength);
    const isNone = place === null || point === undefined;
    const said = isNone ? words[kind].none : words[kind].selected({ number: format.count(place + 1), all: format.count(list.length), height: format.height(point.at_mm[2]) });
    return html`<fieldset class="selected" ?disabled=${isNone}>
      <legend><span role="status">${said}</span></legend>
      <div class="row">
        ${this.#length(words.diameter, point?.diameter_mm ?? (kind === "drains" ? this.#drain_mm : usual_mm), language, !isNone, (mm) => {
          if (place !== null) this.#change(resized(this.#points(kind), place, mm, settings));
        })}
        <label class="box" title=${words[kind].lockHint}>
          <input
            type="checkbox"
            .checked=${live(point?.isLocked ?? false)}
            @change=${() => place !== null && this.act(tool, { do: "lock", place })}
          />${words.lock}
        </label>
        ${iconButton("remove", words.remove, !isNone, () => place !== null && this.act(tool, { do: "remove", place }))}
      </div>
    </fieldset>`;
  }

  #length(name: string, mm: number, { format }: Language, isPossible: boolean, set: (mm: number) => void): TemplateResult {
    const changed = ({ target }: Event): void => {
      const field = target as HTMLInputElement;
      const { value } = read(field.value, "mm", format.decimal);
      if (value !== null && value >= LEAST_MM && value <= MOST_MM) set(value);
      else field.value = localised(String(mm), format.decimal);
    };
    return html`<label class="length">
      ${name}
      <input
        type="text"
        inputmode="decimal"
        autocomplete="off"
        ?disabled=${!isPossible}
        .value=${typed(localised(String(mm), format.decimal))}
        @change=${changed}
      />
    </label>`;
  }

  /** Without weights there is nothing to avoid. */
  #protect(words: PlacingTexts): TemplateResult {
    const { weights, settings } = this.#session;
    const isPossible = weights !== null || settings.saliency === "on";
    return html`<div>
      <label class="box">
        <input
          type="checkbox"
          role="switch"
          aria-describedby=${isPossible ? nothing : "protect-hint"}
          ?disabled=${!isPossible}
          .checked=${live(settings.protect === "on")}
          @change=${() => this.#session.change({ protect: settings.protect === "on" ? "off" : "on" })}
        />${words.protect}
      </label>
      ${isPossible ? nothing : html`<p class="quiet hint" id="protect-hint">${words.protectHint}</p>`}
    </div>`;
  }

  /** Button for the plugs of the plan's drain holes; absent while it has none. */
  #plugs(words: PlacingTexts): TemplateResult | typeof nothing {
    const { model, result, isCurrent, busy } = this.#session;
    if (model === null || (result?.own?.hollowed?.drains.length ?? 0) === 0) return nothing;
    const make = (): Promise<Download | null> =>
      this.#session.write("export", async (watch) => {
        const stl = await this.#slicer.plugs(watch);
        return { name: `${stemOf(model.name)}-plugs.stl`, blob: new Blob([stl as Uint8Array<ArrayBuffer>], { type: "model/stl" }) };
      });
    return html`<div>
      <button class="small" aria-describedby="plugs-hint" ?disabled=${!isCurrent || busy !== null} @click=${() => void saveMade(make())}>
        ${words.plugs}
      </button>
      <p class="quiet hint" id="plugs-hint">${words.plugsHint}</p>
    </div>`;
  }

  #points(kind: PlacedKind): HandPoints {
    const { settings, options, result, isCurrent } = this.#session;
    const isAlone = this.#session.plate.entries.length < 2;
    const of = [kind, settings, result, isCurrent, isAlone];
    if (this.#known === null || of.some((it, i) => it !== this.#known?.of[i])) {
      this.#known = { of, points: pointsOf(kind, { settings, options, result, isCurrent, isAlone }) };
    }
    return this.#known.points;
  }

  #select(point: Point | null): void {
    this.#selected = point === null ? null : keyOf(point);
    this.#update();
  }

  /** Every edit is a separate undo step. */
  #change({ supports, ...change }: Partial<Settings>): void {
    // The setting `supports` applies to all models: removing the last point of one must not remove the supports of the others.
    const isShared = supports === "none" && this.#session.plate.entries.length > 1;
    this.#session.change({ ...change, ...(supports !== undefined && !isShared && { supports }) }, `points ${++this.#edits}`);
  }
}

/** Icons of the markers as drawn in the view. */
const CIRCLE = svg`<circle cx="8" cy="8" r="4.5" />`;
const SQUARE = svg`<rect class="locked" x="4" y="4" width="8" height="8" />`;
const CROSS = svg`<circle class="unreached" cx="8" cy="8" r="4.5" /><path d="M5.5 5.5l5 5m0-5-5 5" />`;

function counted(name: string, shape: TemplateResult<2>, count: string): TemplateResult {
  return html`<div>
    <dt><svg viewBox="0 0 16 16" aria-hidden="true">${shape}</svg>${name}</dt>
    <dd>${count}</dd>
  </div>`;
}

export const pointStyles = css`
  .points {
    display: grid;
    align-content: start;
    gap: 0.625rem;
    min-width: 0;
    overflow: auto;
    scrollbar-width: thin;
    /* Room for focus rings and for the scroll bar. */
    padding: 0.25rem 0.75rem 0.25rem 0.25rem;
    font-size: 0.875rem;
  }
  /* Below the view, room for what there is to press. */
  .beside:has(.points) {
    min-height: max(9rem, min(13.5rem, 34%));
  }
  .points .counts,
  .points .counts div,
  .points dt,
  .points .row,
  .points .length,
  .points .box,
  .points .actions {
    display: flex;
    align-items: center;
    gap: 0.375rem;
  }
  .points .counts {
    flex-wrap: wrap;
    gap: 0.25rem 1rem;
  }
  .points dd {
    font-weight: 550;
    font-variant-numeric: tabular-nums;
  }
  .points dt svg {
    width: 1.125rem;
    height: 1.125rem;
    fill: #fff;
    stroke: #10121a;
    stroke-width: 1.25;
  }
  .points .locked {
    fill: var(--cusp-accent);
  }
  .points .unreached {
    fill: var(--cusp-bad);
  }
  .points dt path {
    stroke: #fff;
    stroke-width: 1.75;
  }
  .points .selected {
    padding-block-start: 0.5rem;
    border-block-start: 1px solid var(--cusp-line);
  }
  .points legend {
    float: inline-start;
    width: 100%;
    padding: 0;
    font-weight: 550;
    font-variant-numeric: tabular-nums;
  }
  .points .selected:disabled,
  .points :disabled + * {
    color: var(--cusp-quiet);
  }
  .points .row {
    flex-wrap: wrap;
    gap: 0.25rem 1rem;
    width: 100%;
  }
  .points .length,
  .points .box {
    gap: 0.5rem;
    min-height: 2.5rem;
  }
  .points .length input {
    ${textField}
    width: 4rem;
  }
  .points .box input {
    flex: none;
    width: 1.125rem;
    height: 1.125rem;
    margin: 0;
    accent-color: var(--cusp-accent);
  }
  .points .hint {
    padding-inline-start: 1.625rem;
    font-size: 0.8125rem;
  }
  .points button + .hint {
    margin-block-start: 0.25rem;
    padding-inline-start: 0;
  }
  .points .actions {
    flex-wrap: wrap;
  }
  .points .icon {
    padding-inline: 0.5rem;
  }
  .points .icon svg {
    ${lineIcon}
  }
  @media (forced-colors: active) {
    .points dt svg {
      forced-color-adjust: none;
    }
  }
`;
