/** The rarely used fields of the settings form, fetched when they are opened. */
import { html, nothing, type TemplateResult } from "lit";
import { isFilament } from "../../api/facts.js";
import type { CureFit, Resin, SupportStrength } from "../../api/wire.js";
import type { Language } from "../../texts/index.js";
import { bridgesTable } from "../parts/bridges-table.js";
import { towersOffer, type TowersState } from "../parts/towers-offer.js";
import type { Field, Settings } from "../state/settings.js";
import { usualSize, type SizeField } from "../state/support-sizes.js";

export { bridgesStyles as rareStyles } from "../parts/bridges-table.js";

/** Optional parts of a text field. */
export interface Typing {
  hint?: string;
  /** In canonical form, like the value. */
  placeholder?: string;
}

/** State of the form, and the makers of its fields. */
export interface Form {
  readonly settings: Settings;
  readonly language: Language;
  /** True to show the fields of every step. */
  readonly isWhole: boolean;
  readonly isFixedPrinter: boolean;
  /** Values of the resin where none is typed. */
  readonly cure: Required<Omit<Resin, "print_through">> & Pick<Resin, "print_through">;
  readonly towers: TowersState;
  /** Thicknesses of the test bridges as typed, and the print-through that fits them. */
  readonly bridges: readonly string[];
  readonly cureFit: CureFit | null;
  field(field: Field, label: string, typing?: Typing): TemplateResult;
  radios(key: "minimize" | "snap" | "raft", legend: string, choices: readonly (readonly [string, string])[], hint: string): TemplateResult;
  hollow(): TemplateResult;
  /** Reports a request of the user as an event of the form. */
  say(name: "cusp-towers" | "cusp-save-bridges" | "cusp-bridges", detail?: readonly string[]): void;
}

export function rareFields(form: Form): TemplateResult {
  const { settings, language, cure } = form;
  const words = language.texts.settings;
  const isResin = !isFilament(settings.format);
  return html`${isResin && form.isWhole ? form.hollow() : nothing}
    ${settings.planner === "uniform"
      ? nothing
      : html`${isResin
          ? form.radios("minimize", words.least, [["layers", words.leastLayers], ["time", words.leastTime]], words.leastHint)
          : nothing}
        ${form.radios("snap", words.flats, [["auto", words.on], ["off", words.off]], words.flatsHint)}
        ${form.field("step", words.step, { hint: words.stepHint })}`}
    ${isResin
      ? html`<div class="pair">
          ${form.field("bottomLayers", words.bottomLayers, { placeholder: String(cure.bottom_layers) })}
          ${form.field("bottomExposure", words.bottomExposure, { placeholder: String(cure.bottom_exposure_s) })}
        </div>
        ${printThrough(form)}`
      : nothing}
    ${settings.printer === "" || form.isFixedPrinter ? nothing : towersOffer(form.towers, language, () => form.say("cusp-towers"))}`;
}

/** Cure below layers. The depths of the law appear once there is an overcure. */
function printThrough(form: Form): TemplateResult {
  const { cure: { penetration_mm, print_through }, settings, language: { texts: { settings: words } } } = form;
  const isOff = settings.overcure.trim() === "" && !print_through;
  return html`${form.field("overcure", words.overcure, { hint: words.overcureHint, placeholder: String(print_through?.overcure_mm ?? "") })}
    ${isOff
      ? nothing
      : html`<div class="pair">
          ${form.field("penetration", words.penetration, { placeholder: String(penetration_mm) })}
          ${form.field("retained", words.retained, { placeholder: String(print_through?.retained ?? 1) })}
        </div>`}
    <details class="bridges">
      <summary>${words.measure}</summary>
      ${bridgesTable(form, () => form.say("cusp-save-bridges"), (bridges) => form.say("cusp-bridges", bridges))}
    </details>`;
}

/** Sizes of supports, with those of the strength where none is typed. */
export function sizeFields({ settings: { raft, planner, layerMax }, language, field, radios }: Form, strength: SupportStrength): TemplateResult {
  const words = language.texts.settings;
  const size = (name: SizeField, hint = ""): TemplateResult => field(name, words[name], { hint, placeholder: String(usualSize(name, strength)) });
  return html`<div class="pair">${size("lift")} ${size("supportSpacing", words.supportSpacingHint)}</div>
    <div class="pair">${size("contact")} ${size("pillar")}</div>
    ${size("supportAngle", words.supportAngleHint)}
    ${radios("raft", words.raft, [["off", words.off], ["on", words.on]], words.raftHint)}
    ${raft === "off" ? nothing : html`<div class="pair">${size("raftThickness")} ${size("raftMargin")}</div>`}
    ${planner === "uniform" ? nothing : field("supportLayer", words.supportLayer, { hint: words.supportLayerHint, placeholder: layerMax })}`;
}
