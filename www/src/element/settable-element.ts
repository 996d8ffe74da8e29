/** The element's settable properties: checked by `Attributes`, stored in the session or here. */
import { LitElement } from "lit";
import type { SlicerError } from "../api/error.js";
import { createSlicer, type Slicer } from "../api/index.js";
import type { Backend, Format, GpuMethod, Limits, Metric, Price, Prices, Printer, Resin } from "../api/wire.js";
import type { SettingName } from "./properties.js";
import { Reports } from "./reports.js";
import { Attributes, settingsOf } from "./state/attributes.js";
import { METRICS } from "./state/metric.js";
import { PANELS, type Panel } from "./state/panel-names.js";
import { copyOf, isEqual } from "./state/plain.js";
import { Session } from "./state/session.js";
import { fromAddress, parse, toAddress } from "./state/settings.js";

export abstract class SettableElement extends LitElement {
  /** The headless slicer behind the element. A page may call it for anything that the element does not offer. */
  readonly slicer: Slicer = createSlicer({ assets: () => this.assets });
  /** @internal */
  protected readonly reports: Reports = new Reports(this, {
    isCurrent: () => this.session.isCurrent,
    hasView: () => this.shownPanels.has("view"),
    offered: () => this.judged.offered(),
    misused: (error) => this.#misused(error),
  });
  /** @internal */
  protected readonly session = new Session(this.reports, this.slicer);
  /** @internal */
  protected readonly judged = new Attributes(this.session, (error) => this.#misused(error));
  #locale: string | null = null;
  #finish: string | null = null;
  #panels: readonly Panel[] | null = null;
  #fixed: readonly SettingName[] | null = null;

  /** @internal The panels to show. */
  protected get shownPanels(): ReadonlySet<Panel> {
    return new Set(this.#panels ?? PANELS);
  }

  /**
   * URL of the folder with the package's `worker.js` and `cusp_slicer_bg.wasm`, relative to the page; null: where the bundler put them.
   * Read each time a worker starts.
   */
  assets: string | null = null;

  /** BCP 47 language tag; by default the nearest `lang`, or the browser's languages. */
  get locale(): string | null {
    return this.#locale;
  }
  set locale(locale: string | null) {
    const read = this.judged.read("locale", locale);
    if (read === undefined) return;
    this.#locale = read;
    this.requestUpdate();
  }

  /** Panels to show, separated by spaces; null shows all. */
  get panels(): string | null {
    return this.#panels?.join(" ") ?? null;
  }
  set panels(panels: string | null) {
    const read = this.judged.read("panels", panels);
    if (read === undefined) return;
    this.#panels = read;
    this.requestUpdate();
  }

  /**
   * Attributes that only the page may change, separated by spaces. The form shows them read-only; undo, offers and the property `query` do
   * not change them.
   */
  get fixed(): string | null {
    return this.#fixed?.join(" ") ?? null;
  }
  set fixed(fixed: string | null) {
    const read = this.judged.read("fixed", fixed);
    if (read === undefined) return;
    this.#fixed = read;
    this.session.fixed = settingsOf(read ?? []);
    this.requestUpdate();
  }

  /** Name of a printer (see `slicer.printers()`), or a description of another; empty for none. */
  get printer(): string | Printer {
    return this.session.settings.printer;
  }
  set printer(printer: string | Printer | null) {
    this.judged.set("printer", copyOf(printer));
  }

  /** Name of one of {@link resins}; empty for the default resin. */
  get resin(): string {
    return this.session.settings.resin;
  }
  set resin(resin: string | null) {
    this.judged.set("resin", resin);
  }

  /** Maximum error of a layer, in the unit of the metric: mm, mm³ for volume, a fraction for area. Null for the default. */
  get tolerance(): number | null {
    const { metric, tolerances } = this.session.settings;
    const typed = parse(tolerances[metric] ?? "");
    return typed === null ? null : typed / METRICS[metric].scale;
  }
  set tolerance(tolerance: number | null) {
    this.judged.set("tolerance", tolerance);
  }

  /** Minimum layer thickness in mm. */
  get layerMin(): number {
    return parse(this.session.settings.layerMin) ?? Number.NaN;
  }
  set layerMin(mm: number | null) {
    this.judged.set("layer-min", mm);
  }

  /** Maximum layer thickness in mm. */
  get layerMax(): number {
    return parse(this.session.settings.layerMax) ?? Number.NaN;
  }
  set layerMax(mm: number | null) {
    this.judged.set("layer-max", mm);
  }

  /** Metric of the tolerance. */
  get metric(): Metric {
    return this.session.settings.metric;
  }
  set metric(metric: Metric | null) {
    this.judged.set("metric", metric);
  }

  /** Format of the print file; null for the printer's own. */
  get format(): Format | null {
    const { format } = this.session.settings;
    return format === "" ? null : format;
  }
  set format(format: Format | null) {
    this.judged.set("format", format);
  }

  /**
   * Point on the trade-off curve, in place of a tolerance: from 0, the fastest print worth having, to 1, the finest. Null until the curve
   * is known.
   */
  get quality(): number | null {
    return this.session.quality;
  }
  set quality(quality: number | null) {
    const read = this.judged.read("quality", quality);
    if (read !== undefined) this.session.quality = read;
  }

  /** Processor that casts the rays: `cpu`, `gpu`, or null for the faster one. */
  get backend(): Backend | null {
    return this.session.backend;
  }
  set backend(backend: Backend | null) {
    const read = this.judged.read("backend", backend);
    if (read === undefined || read === this.session.backend) return;
    this.session.backend = read;
    this.session.replan();
  }

  /** GPU method of casting rays: `fill`, or `peel` for depth peeling; null for the faster one that the GPU supports. */
  get gpuMethod(): GpuMethod | null {
    return this.session.gpuMethod;
  }
  set gpuMethod(method: GpuMethod | null) {
    const read = this.judged.read("gpu-method", method);
    if (read === undefined || read === this.session.gpuMethod) return;
    this.session.gpuMethod = read;
    this.session.replan();
  }

  /** Weight of each facet, 0 to 1 in the order of `slicer.positions()`; null: all equal. Setting it plans again. */
  get weights(): Float32Array | null {
    return this.session.weights;
  }
  set weights(weights: Float32Array | null | undefined) {
    if (!isEqual(weights ?? null, this.session.weights)) this.session.setWeights(copyOf(weights ?? null), true);
  }

  /** Resins to choose from; each needs a name. */
  get resins(): readonly Resin[] {
    return this.session.resins;
  }
  set resins(resins: readonly Resin[] | null | undefined) {
    if (isEqual(resins ?? [], this.session.resins)) return;
    this.session.resins = copyOf(resins ?? []);
    this.judged.offered();
    this.requestUpdate();
  }

  /** Prices of a shop, by which the result is priced; null for none. */
  get prices(): Prices | null {
    return this.session.pricing.asked?.prices ?? null;
  }
  set prices(prices: Prices | null | undefined) {
    this.#ask(copyOf(prices ?? null), this.#finish);
  }

  /** Name of the finish to price, from {@link prices}; null for none. */
  get finish(): string | null {
    return this.#finish;
  }
  set finish(finish: string | null) {
    this.#finish = finish;
    this.#ask(this.prices, finish);
  }

  /** Price of all copies of the last plan by {@link prices}; null until known. */
  get price(): Price | null {
    const { isPriced, price } = this.session.pricing;
    return isPriced ? price : null;
  }

  /**
   * A shop's acceptance limits for the checks of each plan; omitted ones have the defaults, so `{}` checks with all defaults. Null: plans
   * are checked only while a panel shows the findings.
   */
  get limits(): Limits | null {
    return this.session.checks.limits;
  }
  set limits(limits: Limits | null | undefined) {
    this.session.checks.limits = copyOf(limits ?? null);
  }

  /** All settings as a URL query, such as `metric=area&tolerance=5`; defaults are omitted. */
  get query(): string {
    return toAddress(this.session.settings);
  }
  set query(query: string) {
    this.judged.settle();
    this.session.restore(fromAddress(query));
  }

  #ask(prices: Prices | null, finish: string | null): void {
    this.session.pricing.asked = prices === null ? null : { prices, ...(finish !== null && { finish }) };
  }

  /** Reports an invalid attribute to the page's developer; customers do not see it. */
  #misused(error: SlicerError): void {
    console.warn(`<${this.localName}>: ${error.message}`, this);
    this.reports.tell("cusp-error", error);
  }
}
