/** The page as one element: it hosts a session and draws what that says. */
import { html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { appStyles } from "./app-styles.js";
import type { ChartData } from "./chart.js";
import { sentence } from "./comparison.js";
import { EXAMPLE_NAME, binaryStl, exampleTriangles } from "../page/example.js";
import * as format from "../texts/format.js";
import icon from "../page/icon.svg";
import { modelCard } from "./model-card.js";
import "./mask-view.js";
import "./profile-chart.js";
import { progressBar, progressStyles, standing } from "./progress.js";
import { Session, type Result } from "./session.js";
import "./settings-form.js";
import { fromAddress, type Settings } from "./settings.js";
import { SlicerClient } from "../api/slicer.js";
import { shared } from "./styles.js";
import { details, summary, summaryStyles } from "./summary.js";
import type { Backend } from "../api/wire.js";

/** For developers: `?backend=cpu` or `?backend=gpu` asks the core for one of them. */
function backendFromAddress(): Backend | null {
  const backend = new URLSearchParams(location.search).get("backend");
  return backend === "cpu" || backend === "gpu" ? backend : null;
}

export class CuspApp extends LitElement {
  static override properties = {
    dragging: { state: true },
  };

  declare dragging: boolean;

  static override styles = [shared, summaryStyles, progressStyles, appStyles];

  readonly #session = new Session(this, new SlicerClient(), fromAddress(location.search), backendFromAddress());
  readonly #wide = matchMedia("(min-width: 60rem)");
  /** Made once a result, so that the chart is rebuilt only for a new one. */
  #chart: { of: Result; data: ChartData } | null = null;
  /** Whether the focus was on something of the empty page when a model was opened from there. */
  #orphaned = false;

  constructor() {
    super();
    this.dragging = false;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    // A model may be dropped anywhere on the page; a miss must not make the browser leave it.
    window.addEventListener("dragover", this.#dragOver);
    window.addEventListener("dragleave", this.#dragLeave);
    window.addEventListener("drop", this.#dropped);
    window.addEventListener("keydown", this.#key);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    window.removeEventListener("dragover", this.#dragOver);
    window.removeEventListener("dragleave", this.#dragLeave);
    window.removeEventListener("drop", this.#dropped);
    window.removeEventListener("keydown", this.#key);
  }

  override render(): TemplateResult {
    const { model, busy } = this.#session;
    return html`
      <header>
        <div class="brand">
          <img src=${icon} alt="" width="32" height="32" />
          <h1>Cusp</h1>
        </div>
        <p class="tagline">Thin layers where the surface needs them, thick ones where it does not.</p>
        <p class="private">Your model never leaves this computer.</p>
      </header>
      <main aria-busy=${busy !== null}>
        ${this.#problem()} ${this.#notice()} ${model === null ? this.#start() : this.#work()}
      </main>
      ${this.dragging ? html`<div class="drop-veil"><p>Drop to open</p></div>` : nothing}
      <p class="hidden" role="status" aria-live="polite">${this.#announcement()}</p>
    `;
  }

  override updated(_changed: PropertyValues<this>): void {
    const { model, busy, problem, result } = this.#session;
    this.dataset["state"] =
      busy !== null ? "busy" : problem !== null ? "error" : result !== null ? "done" : model !== null ? "ready" : "empty";
    // Whoever pressed a button of the empty page, which is gone now, must not be left nowhere.
    if (this.#orphaned && model !== null) {
      this.#orphaned = false;
      this.renderRoot.querySelector<HTMLElement>("#model-name")?.focus({ preventScroll: true });
    }
  }

  #start(): TemplateResult {
    const { busy } = this.#session;
    return html`<section class="start" aria-label="Open a model">
      ${busy !== null
        ? html`<div class="card waiting">
            <h2>${busy.name}</h2>
            ${progressBar(busy, this.#cancel)}
          </div>`
        : html`<label class="drop">
              <input class="hidden" type="file" accept=".stl,model/stl" @change=${this.#picked} />
              ${layersPicture}
              <span class="drop-title">Drop an STL here</span>
              <span class="button primary">Choose a file</span>
            </label>
            <p>
              No model at hand?
              <button class="link" @click=${this.#example}>Try the example</button>
            </p>`}
      <ul class="points">
        <li><strong>Fewest layers</strong> Every plan that keeps your tolerance is considered, and the shortest is taken.</li>
        <li><strong>No step too high</strong> The tolerance holds in each layer, not on average.</li>
        <li><strong>Masks to print</strong> One image a layer with its thickness, in a zip.</li>
      </ul>
    </section>`;
  }

  #work(): TemplateResult {
    const session = this.#session;
    const { model, result, busy, settings } = session;
    if (model === null) return html``;
    return html`<div class="work">
      ${modelCard(model, result, this.#picked, this.#example)}
      <details class="card settings" ?open=${this.#wide.matches}>
        <summary><h2>Settings</h2></summary>
        <cusp-settings
          .settings=${settings}
          .faults=${session.faults}
          .info=${model.info}
          .taken=${session.taken}
          @cusp-settings=${(event: CustomEvent<Partial<Settings>>) => session.change(event.detail)}
        ></cusp-settings>
      </details>
      <div class="results ${busy?.task === "plan" && result !== null ? "replanning" : ""}">
        ${result === null
          ? html`<section class="card waiting">
              ${busy !== null
                ? progressBar(busy, this.#cancel)
                : html`<p class="quiet">There is no plan for this model yet.</p>
                    <button class="primary" @click=${() => session.replan()}>Plan the layers</button>`}
            </section>`
          : this.#results(result)}
      </div>
      ${busy !== null && result !== null ? html`<div class="card toast">${progressBar(busy, this.#cancel)}</div>` : nothing}
    </div>`;
  }

  #results(result: Result): TemplateResult {
    const { layer, mask, busy } = this.#session;
    const look = (event: CustomEvent<number>): void => this.#session.look(event.detail);
    const download = html`<button class="primary download" ?disabled=${busy !== null} @click=${this.#download}>
      Download masks (zip)
    </button>`;
    return html`
      <section class="card" aria-label="The plan">${summary(result, this.#earlier(), download)} ${details(result)}</section>
      <section class="card" aria-label="Profile">
        <cusp-chart .data=${this.#chartData(result)} .layer=${layer} @cusp-layer=${look}></cusp-chart>
      </section>
      <section class="card" aria-label="Layers">
        <cusp-mask
          .mask=${mask}
          .report=${result.report}
          .limits=${result.limits}
          .layer=${layer}
          @cusp-layer=${look}
        ></cusp-mask>
      </section>
    `;
  }

  /** Said of a result that the settings on show did not give. */
  #earlier(): TemplateResult | typeof nothing {
    const { earlier, faults, problem } = this.#session;
    if (!earlier) return nothing;
    // Without a fault or a problem it was cancelled, and only then would trying again help.
    const again = Object.keys(faults).length === 0 && problem === null;
    return html`<p class="earlier">
      This is the last plan that worked, with the settings before the change.
      ${again ? html`<button class="link" @click=${() => this.#session.replan()}>Plan again</button>` : nothing}
    </p>`;
  }

  #problem(): TemplateResult | typeof nothing {
    const { problem } = this.#session;
    if (problem === null) return nothing;
    return html`<section class="message problem" role="alert" data-code=${problem.code}>
      <div>
        <h2>${problem.title}</h2>
        <p>${problem.text}</p>
        ${problem.offers.length === 0
          ? nothing
          : html`<div class="offers">
              ${problem.offers.map(
                ({ label, change }) =>
                  html`<button class="small" @click=${() => this.#session.change(change)}>${label}</button>`,
              )}
            </div>`}
      </div>
      <button class="small" @click=${this.#dismiss}>Close</button>
    </section>`;
  }

  #notice(): TemplateResult | typeof nothing {
    const { notice } = this.#session;
    if (notice === null) return nothing;
    return html`<section class="message notice">
      <p>${notice}</p>
      <button class="small" @click=${this.#dismiss}>Close</button>
    </section>`;
  }

  /** Spoken: what began, what came of it; not every step. */
  #announcement(): string {
    const { busy, result, notice, earlier } = this.#session;
    if (busy !== null) return busy.task === "open" ? `Opening ${busy.name}` : standing(busy).words;
    if (notice !== null) return notice;
    if (result === null || earlier) return "";
    const { layers, print_time_s } = result.report;
    return `${format.count(layers)} layers planned, about ${format.time(print_time_s)} to print. ${sentence(result)}`;
  }

  #chartData(result: Result): ChartData {
    if (this.#chart?.of !== result) {
      const { metric, z_mm, thickness_mm, bin_mm } = result.report;
      const data = { metric, profile: result.profile, bin_mm, z_mm, thickness_mm, limits: result.limits };
      this.#chart = { of: result, data };
    }
    return this.#chart.data;
  }

  readonly #cancel = (): void => this.#session.cancel();
  readonly #dismiss = (): void => this.#session.dismiss();

  readonly #example = (): void => {
    this.#orphaned = this.#session.model === null;
    void this.#session.open(new Blob([binaryStl(exampleTriangles())]), EXAMPLE_NAME);
  };

  readonly #picked = (event: Event): void => {
    const input = event.target as HTMLInputElement;
    const files = [...(input.files ?? [])];
    // So that choosing the same file again is a change.
    input.value = "";
    this.#orphaned = this.#session.model === null && files.length > 0;
    void this.#session.choose(files);
  };

  readonly #dragOver = (event: DragEvent): void => {
    event.preventDefault();
    this.dragging = event.dataTransfer?.types.includes("Files") ?? false;
  };

  readonly #dragLeave = (event: DragEvent): void => {
    // Leaving an element for one inside it is no leaving of the page.
    if (event.relatedTarget === null) this.dragging = false;
  };

  readonly #dropped = (event: DragEvent): void => {
    event.preventDefault();
    this.dragging = false;
    void this.#session.choose([...(event.dataTransfer?.files ?? [])]);
  };

  readonly #key = (event: KeyboardEvent): void => {
    if (event.key === "Escape") this.#session.cancel();
  };

  readonly #download = async (): Promise<void> => {
    const download = await this.#session.download();
    if (download === null) return;
    const address = URL.createObjectURL(download.blob);
    const link = document.createElement("a");
    link.href = address;
    link.download = download.name;
    link.click();
    // The browser has taken hold of the bytes by then.
    setTimeout(() => URL.revokeObjectURL(address), 60_000);
  };
}

/** A vase cut into layers, the sign over the drop zone. */
const layersPicture = html`<svg viewBox="0 0 64 56" width="80" height="70" aria-hidden="true">
  <rect x="22" y="2" width="20" height="3" fill="#c82a36" />
  <rect x="17" y="6" width="30" height="3" fill="#ef6c48" />
  <rect x="13" y="10" width="38" height="4" fill="#fcba67" />
  <rect x="11" y="15" width="42" height="6" fill="#b0d6e2" />
  <rect x="10" y="22" width="44" height="8" fill="#6aa1ce" />
  <rect x="10" y="31" width="44" height="9" fill="#3662ac" />
  <rect x="12" y="41" width="40" height="6" fill="#6aa1ce" />
  <rect x="16" y="48" width="32" height="3" fill="#fcba67" />
  <rect x="22" y="52" width="20" height="2" fill="#c82a36" />
</svg>`;

customElements.define("cusp-app", CuspApp);

declare global {
  interface HTMLElementTagNameMap {
    "cusp-app": CuspApp;
  }
}
