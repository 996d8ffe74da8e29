/** Numbers of a model's placement, typed beside the handles of the 3-D view, and its menu. */
import { css, html, nothing, type TemplateResult } from "lit";
import { Euler, MathUtils, Quaternion } from "three";
import type { Language } from "../../texts/index.js";
import { viewingTexts, type ViewingTexts } from "../../texts/viewing.js";
import type { Copy } from "../../view/scene/copies.js";
import type { Tool } from "../../view/scene/keys.js";
import { extentOf, sizeOf, type Rotation, type Triple } from "../../view/scene/pose.js";
import { typed } from "../parts/typed.js";
import { read, type FieldUnit } from "../state/typed.js";
import { textField } from "../styles/text-field.js";

/** Order of turns: about x, then y, then z of the plate. */
const ORDER = "ZYX";

const AXES = ["x", "y", "z"] as const;

/** Placement of the selected model, and what its fields and its menu do. */
export interface Placement {
  readonly rotation: Rotation;
  /** Factor applied to the file's lengths. */
  readonly scale: number;
  /** Nine numbers per facet, mm, in the file's pose. */
  readonly positions: Float32Array;
  /** The selected copy; null for a single model. */
  readonly copy: Copy | null;
  readonly language: Language;
  chosen(tool: Tool): void;
  rotated(rotation: Rotation): void;
  sized(factor: number): void;
  /** Called with the selected copy's new coordinates. */
  moved(to: Pick<Copy, "x_mm" | "y_mm" | "turn_deg">): void;
  mirrored(): void;
  duplicated(): void;
  /** Removes the selected copies. */
  removed(): void;
}

const rounded = (value: number, step: number): number => Math.round(value / step) * step + 0;

/** Turns about the plate's axes that make a rotation, degrees. */
export function anglesOf([x, y, z, w]: Rotation): Triple {
  const euler = new Euler().setFromQuaternion(new Quaternion(x, y, z, w), ORDER);
  return AXES.map((axis) => rounded(MathUtils.radToDeg(euler[axis]), 0.1)) as unknown as Triple;
}

/** The rotation by these turns, degrees. */
export function rotationBy([x, y, z]: Triple): Rotation {
  const euler = new Euler(MathUtils.degToRad(x), MathUtils.degToRad(y), MathUtils.degToRad(z), ORDER);
  const unit = new Quaternion().setFromEuler(euler);
  return [unit.x, unit.y, unit.z, unit.w];
}

const sizes = new WeakMap<Float32Array, { pose: string; size_mm: Triple }>();

/** Size of a model in its pose, mm; the last one of each model is kept. */
function sizeIn({ positions, rotation, scale }: Placement): Triple {
  const pose = String([rotation, scale]);
  const known = sizes.get(positions);
  if (known?.pose === pose) return known.size_mm;
  const size_mm = sizeOf(extentOf(positions, rotation, scale));
  sizes.set(positions, { pose, size_mm });
  return size_mm;
}

/** Fields of a tool: the position of a copy, the turns of the model, or its size; nothing for other tools. */
export function placementFields(tool: Tool, placement: Placement): TemplateResult | typeof nothing {
  const { language, copy, rotation, scale } = placement;
  const words = viewingTexts(language);
  const field = (label: string, value: number, unit: FieldUnit, changed: (value: number) => void): TemplateResult => {
    const text = language.format.exact(value);
    const change = ({ target }: Event): void => {
      const input = target as HTMLInputElement;
      const { value: entered } = read(input.value, unit, language.format.decimal);
      if (entered === null) input.value = text;
      else changed(entered);
    };
    return html`<label>${label}<input type="text" inputmode="decimal" .value=${typed(text)} @change=${change} /></label>`;
  };
  const button = (name: string, act: () => void): TemplateResult => html`<button class="small" @click=${act}>${name}</button>`;
  const axis = (at: number): string => (AXES[at] ?? "").toUpperCase();
  if (tool === "move" && copy !== null) {
    const { x_mm, y_mm, turn_deg } = copy;
    const to = { x_mm, y_mm, turn_deg };
    return fields(words.hints.move, [
      field(words.axis.mm({ axis: "X" }), rounded(x_mm, 0.01), "mm", (x_mm) => placement.moved({ ...to, x_mm })),
      field(words.axis.mm({ axis: "Y" }), rounded(y_mm, 0.01), "mm", (y_mm) => placement.moved({ ...to, y_mm })),
      field(words.spin, rounded(turn_deg, 0.1), "°", (turn_deg) => placement.moved({ ...to, turn_deg })),
      button(words.duplicate, placement.duplicated),
      button(words.remove, placement.removed),
    ]);
  }
  if (tool === "rotate") {
    const angles = anglesOf(rotation);
    const turn = (at: number) => (deg: number) => placement.rotated(rotationBy(angles.map((it, other) => (other === at ? deg : it)) as unknown as Triple));
    return fields(words.hints.rotate, [
      ...angles.map((deg, at) => field(words.axis.deg({ axis: axis(at) }), deg, "°", turn(at))),
      button(words.mirror, placement.mirrored),
    ]);
  }
  if (tool === "size") {
    const size_mm = sizeIn(placement);
    return fields(words.hints.size, [
      ...size_mm.map((mm, at) => field(words.axis.mm({ axis: axis(at) }), rounded(mm, 0.01), "mm", (to_mm) => to_mm > 0 && placement.sized(to_mm / mm))),
      field(words.percent, rounded(100 * scale, 0.1), "%", (percent) => percent > 0 && placement.sized(percent / 100 / scale)),
      button(words.mirror, placement.mirrored),
    ]);
  }
  return nothing;
}

const fields = (name: string, parts: readonly TemplateResult[]): TemplateResult => html`<div class="fields" role="group" aria-label=${name}>${parts}</div>`;

/** Entries of the menu of the selected model: tools, and what takes effect at once. */
export function placementMenu(offered: ReadonlySet<Tool>, placement: Placement, done: () => void): TemplateResult {
  const words: ViewingTexts = viewingTexts(placement.language);
  const entry = (name: string, act: () => void): TemplateResult => html`<button
    role="menuitem"
    @click=${() => {
      done();
      act();
    }}
  >
    ${name}
  </button>`;
  const tools = (["move", "rotate", "size", "flat"] as const).filter((tool) => tool !== "move" || offered.has("move"));
  return html`
    ${tools.map((tool) => entry(words.tools[tool], () => placement.chosen(tool)))}
    <hr />
    ${entry(words.mirror, placement.mirrored)} ${entry(words.duplicate, placement.duplicated)}
    ${offered.has("move") ? entry(words.remove, placement.removed) : nothing}
  `;
}

/** Moves the focus among the entries of a menu. */
export function steppedInMenu(event: KeyboardEvent): void {
  const entries = [...(event.currentTarget as HTMLElement).querySelectorAll<HTMLElement>("button")];
  const now = entries.indexOf(event.target as HTMLElement);
  const to = { ArrowDown: now + 1, ArrowUp: now - 1, Home: 0, End: entries.length - 1 }[event.key];
  // Other keys are the menu's alone, too: Escape cancels no task.
  event.stopPropagation();
  if (to === undefined) return;
  event.preventDefault();
  entries.at(to % entries.length)?.focus();
}

export const placementStyles = css`
  .fields {
    position: absolute;
    inset-block-start: calc(100% + 0.375rem);
    inset-inline-start: 0;
    display: flex;
    flex-wrap: wrap;
    align-items: end;
    gap: 0.375rem;
    /* Beside the colour scale, where there is one. */
    max-width: max(15rem, 100% - 11.75rem);
    padding: 0.375rem 0.5rem;
    border: 1px solid var(--cusp-line);
    border-radius: 8px;
    background: var(--cusp-card);
    font-size: 0.75rem;
    pointer-events: auto;
  }
  .fields label {
    display: grid;
    gap: 0.125rem;
    color: var(--cusp-quiet);
  }
  .fields input {
    ${textField}
    width: 3.5rem;
    min-height: 2rem;
    padding: 0.125rem 0.3125rem;
    color: var(--cusp-text);
  }
  .fields button {
    min-height: 2rem;
    padding: 0.125rem 0.5rem;
    font-size: 0.75rem;
  }
  .menu {
    position: fixed;
    inset: auto;
    min-width: 9rem;
    margin: 0;
    padding: 0.25rem;
    border: 1px solid var(--cusp-line);
    border-radius: 8px;
    background: var(--cusp-card);
    color: var(--cusp-text);
    box-shadow: 0 4px 16px rgb(0 0 0 / 18%);
  }
  .menu button {
    display: block;
    width: 100%;
    min-height: 2.25rem;
    padding: 0.25rem 0.625rem;
    border: 0;
    border-radius: 5px;
    font-weight: 400;
    text-align: start;
  }
  .menu hr {
    margin: 0.25rem 0;
    border: 0;
    border-top: 1px solid var(--cusp-line);
  }
`;
