/** The panels, bound to a session: each with the state that it shows and the changes that it makes. Layouts position them. */
import { html, nothing, type TemplateResult } from "lit";
import { isFilament } from "../api/facts.js";
import type { Candidate, Finding } from "../api/wire.js";
import type { RotateDetail } from "../view/events.js";
import type { MoveDetail } from "../view/scene/moving.js";
import type { Tool } from "../view/scene/keys.js";
import type { Rotation } from "../view/scene/pose.js";
import { UPRIGHT } from "../view/scene/turn.js";
import type { Painted } from "./events.js";
import type { Facts } from "./facts.js";
import type { CopiesEvent, Scaled } from "./panels/model-view.js";
import type { Searched } from "./panels/orientation-panel.js";
import type { PlotPlace } from "./panels/profile-chart.js";
import type { Fields } from "./panels/settings-form.js";
import { define } from "./define.js";
import { FetchedPanel } from "./parts/part.js";
import { fileWords } from "./parts/file-words.js";
import { stepButtons } from "./parts/icon-button.js";
import { sentence } from "./state/comparison.js";
import type { Aims } from "./state/orientation.js";
import { USUAL_VOLUME, type Entry } from "./state/plate.js";
import { printerOf } from "./state/printer.js";
import type { Problem } from "./state/problem.js";
import { ownHeight, type Result } from "./state/result.js";
import type { Session } from "./state/session.js";
import { quaternion, type Settings } from "./state/settings.js";
import { shown } from "../api/visible.js";

/** @param problem failure caused by one of the settings, to show next to that setting */
export function settingsPanel({ session, language, saveTowers, saveBridges }: Facts, problem: Problem | null, fields: Fields = "all"): TemplateResult {
  return html`<cusp-settings
    .fields=${fields}
    .settings=${session.settings}
    .faults=${session.faults}
    .info=${session.model?.info ?? null}
    .taken=${session.taken}
    .offered=${session}
    .fixed=${session.fixed}
    .problem=${problem}
    .towers=${session.towers}
    .bridges=${session.bridges}
    .cureFit=${session.cureFit}
    .language=${language}
    @cusp-settings=${(event: CustomEvent<Partial<Settings>>) => session.change(event.detail)}
    @cusp-open-printer=${(event: CustomEvent<File>) => void session.openPrinter(event.detail)}
    @cusp-towers=${saveTowers}
    @cusp-save-bridges=${saveBridges}
    @cusp-bridges=${(event: CustomEvent<readonly string[]>) => void session.measureBridges(event.detail)}
    @cusp-dismiss=${() => session.dismiss()}
  ></cusp-settings>`;
}

/** Undo and redo buttons for the settings. */
export function undoButtons({ session, language }: Facts): TemplateResult {
  return html`<div class="steps">${stepButtons(session, language)}</div>`;
}

/** The 3-D view, with or without a plan. */
export function modelPanel({ session, language, saveWeights }: Facts): TemplateResult {
  const { layer, shown, turning, settings } = session;
  return html`<cusp-model
    .slicer=${session.selected}
    .model=${session.model}
    .corners=${session.positions}
    .isPlanning=${session.busy?.task === "plan" && session.result === null}
    .shown=${shown}
    .layer=${layer}
    .marks=${session.checks.marks}
    .places=${session.checks.places}
    .walls_mm=${session.checks.showsWalls ? session.checks.wall_mm : null}
    @cusp-walls=${() => (session.checks.showsWalls = false)}
    .rotation=${turning ?? rotationOf(settings.rotation)}
    .scaled=${scaledOf(session)}
    .printer=${printerOf(settings.printer, session.printers) ?? (session.plate.isSeveral ? USUAL_VOLUME : null)}
    .copies=${session.plate.copies}
    .colliding=${session.plate.colliding}
    .shapes=${session.plate}
    @cusp-move=${({ detail: { copies, final } }: CustomEvent<MoveDetail>) => session.plate.move(copies, final)}
    @cusp-copies=${({ detail }: CustomEvent<CopiesEvent>) => (detail.do === "remove" ? session.plate.removeCopies(detail.places) : session.plate.duplicate(detail.places))}
    @cusp-mirror=${() => void session.mirror()}
    @cusp-entry=${(event: CustomEvent<Entry>) => session.plate.select(session.plate.entries.indexOf(event.detail))}
    .settings=${settings}
    .edited=${session}
    .weights=${session.weights}
    .language=${language}
    @cusp-paint=${(event: CustomEvent<Painted>) => painted(session, event)}
    @cusp-settings=${(event: CustomEvent<Partial<Settings>>) => session.change(event.detail)}
    @cusp-open-weights=${(event: CustomEvent<File>) => void session.openWeights(event.detail)}
    @cusp-save-weights=${saveWeights}
    @cusp-rotate=${(event: CustomEvent<RotateDetail>) => session.turn(event.detail.rotation, event.detail.final)}
    @cusp-layer=${(event: CustomEvent<number>) => session.selectLayer(event.detail)}
    @cusp-camera=${seen}
  ></cusp-model>`;
}

/** @param placed receives the position of the plot; by default passes it to the view next to it */
export function chartPanel({ session, language }: Facts, placed = besideView): TemplateResult {
  return html`<cusp-chart
    .data=${session.shown}
    .mark=${heightsOf(session.checks.chosen)}
    .layer=${session.layer}
    .language=${language}
    @cusp-layer=${(event: CustomEvent<number>) => session.selectLayer(event.detail)}
    @cusp-plot=${placed}
  ></cusp-chart>`;
}

/** Fetched on demand: few people search for an orientation, and the sphere of directions is a large part of the code. */
const orientationCode = new FetchedPanel("orientation", () => import("./panels/orientation-panel.js"), ({ defineOrientation }) => defineOrientation());

export function orientationPanel({ element, session, language }: Facts): TemplateResult | typeof nothing {
  if (!orientationCode.isThere) return orientationCode.instead(element, language);
  const { orientation, settings, turning } = session;
  return html`<cusp-orientation
    .slicer=${session.selected}
    .searched=${searchedOf(session)}
    .metric=${settings.metric}
    .rotation=${turning ?? rotationOf(settings.rotation)}
    .language=${language}
    @cusp-search=${() => void orientation.start()}
    @cusp-search-cancel=${() => orientation.cancel()}
    @cusp-aims=${(event: CustomEvent<Partial<Aims>>) => orientation.aim(event.detail)}
    @cusp-orient=${(event: CustomEvent<Candidate>) => session.orient(event.detail)}
  ></cusp-orientation>`;
}

export function qualityPanel({ session, language }: Facts, result: Result): TemplateResult {
  return html`<cusp-quality
    .points=${session.curve}
    .result=${result}
    .isFixed=${session.fixed.has("tolerances")}
    .language=${language}
    @cusp-point=${(event: CustomEvent<number>) => session.takePoint(event.detail)}
  ></cusp-quality>`;
}

/** Fetched on demand: the page shows this tab later, and its image code is large. */
const maskCode = new FetchedPanel("mask", () => import("./panels/mask-view.js"), ({ CuspMask }) => define("cusp-mask", CuspMask));

export function maskPanel({ element, session, language }: Facts, result: Result): TemplateResult | typeof nothing {
  if (!maskCode.isThere) return maskCode.instead(element, language);
  return html`<cusp-mask
    .mask=${session.mask}
    .below=${session.maskBelow}
    .extent_mm=${session.plate.isSeveral ? null : (result.own?.size_mm ?? null)}
    @cusp-changes=${(event: CustomEvent<boolean>) => (session.seesChanges = event.detail)}
    .pull_n=${session.checks.pull_n}
    .marks=${session.checks.marks}
    .places=${session.checks.outlines}
    .report=${result.report}
    .limits=${result.limits}
    .layer=${session.layer}
    .language=${language}
    @cusp-layer=${(event: CustomEvent<number>) => session.selectLayer(event.detail)}
  ></cusp-mask>`;
}

export function downloadButton({ session, language: { texts }, save }: Facts): TemplateResult {
  return html`<button class="primary download" aria-describedby="file" ?disabled=${session.busy !== null} @click=${save}>
    ${texts.plan.download}
  </button>`;
}

/** The note on the print file: its format, and the preparation of the model. */
export function fileLine({ session, language }: Facts, result: Result): TemplateResult {
  return html`<p id="file" class="quiet">${fileWords(result, session.printers, language)}</p>`;
}

/** Note that the result is not for the settings shown. */
export function earlierNote({ session, problem, language: { texts } }: Facts): TemplateResult | typeof nothing {
  if (!session.earlier) return nothing;
  // With a fault or a problem, trying again cannot help; after a cancel, it can.
  const again = Object.keys(session.faults).length === 0 && problem === null;
  return html`<p class="earlier">
    ${texts.plan.earlier}
    ${again ? html`<button class="link" @click=${() => session.replan()}>${texts.plan.again}</button>` : nothing}
  </p>`;
}

/** The current notice, if any, which is not a failure. */
export function noticeBox({ session, language: { texts } }: Facts): TemplateResult | typeof nothing {
  if (session.notice === null) return nothing;
  return html`<section class="message notice">
    <p>${texts.notices[session.notice]}</p>
    <button class="small" @click=${() => session.dismiss()}>${texts.notices.close}</button>
  </section>`;
}

/** Announces the start and the outcome of a task to screen readers, not every step. */
export function announcement({ session, language }: Facts): TemplateResult {
  return html`<p class="visually-hidden" role="status" aria-live="polite">${announced(session, language)}</p>`;
}

function announced({ busy, result, notice, earlier }: Session, language: Facts["language"]): string {
  const { texts, format } = language;
  if (busy !== null) return busy.task === "open" ? texts.open.opening({ name: shown(busy.name) }) : texts.progress[busy.stage];
  if (notice !== null) return texts.notices[notice];
  if (result === null || earlier) return "";
  const { layers, print_time_s, print_file } = result.report;
  const planned = isFilament(print_file.format) ? `${format.count(layers)} ${texts.plan.layers({ count: layers })}.` : texts.plan.said({ count: layers, time: format.time(print_time_s) });
  return `${planned} ${sentence(result, language)}`;
}

/** The session reports the weights, and the element then fires its own event. */
function painted(session: Session, event: CustomEvent<Painted>): void {
  session.setWeights(event.detail.weights, event.detail.final);
}

/** Passes the chart's position and heights to the view next to it. */
export function besideView({ target, detail }: CustomEvent<PlotPlace>): void {
  const view = beside(target, "cusp-model");
  if (view !== null) view.plot = detail;
}

/** Passes the view's camera to the orientation panel next to it. */
function seen({ target, detail }: CustomEvent<Rotation>): void {
  const panel = beside(target, "cusp-orientation");
  if (panel !== null) panel.camera = detail;
}

/** Activates a tool of the neighbouring 3-D view. */
export function takeUp(target: EventTarget | null, tool: Tool): void {
  const view = beside(target, "cusp-model");
  if (view !== null) view.tool = tool;
}

function beside<Name extends "cusp-model" | "cusp-orientation">(target: EventTarget | null, name: Name): HTMLElementTagNameMap[Name] | null {
  return ((target as Element).getRootNode() as ShadowRoot).querySelector(name);
}

function searchedOf({ orientation: { aims, found, best, now, busy, isCurrent, isPossible, options } }: Session): Searched {
  return { aims, found, best, now, busy, isCurrent, isPossible, options };
}

function heightsOf(finding: Finding | null): readonly [number, number] | null {
  return finding === null ? null : [finding.bounds_mm[0][2], finding.bounds_mm[1][2]];
}

const rotations = new Map<string, Rotation>();

/** Cached, since a new array would count as a new rotation. */
function rotationOf(text: string): Rotation {
  let rotation = rotations.get(text);
  if (rotation === undefined) rotations.set(text, (rotation = quaternion(text) ?? UPRIGHT));
  return rotation;
}

/** Scale of the model: a requested height, or the one implied by a unit, applies to its current pose, or to the pose being turned to. */
function scaledOf({ result, turning, shown, plate }: Session): Scaled | null {
  if (result === null || (result.options.height_mm === undefined && result.options.unit === undefined)) return null;
  // The height of a plate is that of its highest model.
  const own_mm = plate.heightOf(plate.selected);
  if (own_mm !== null) return { height_mm: own_mm, rotation: result.options.rotation ?? UPRIGHT };
  const { report } = result;
  const height_mm = turning === null || shown === null ? ownHeight(report) : (shown.z_mm.at(-1) ?? 0) - shown.lift_mm;
  return { height_mm, rotation: turning ?? result.options.rotation ?? UPRIGHT };
}
