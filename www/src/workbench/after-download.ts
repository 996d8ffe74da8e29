/** Card about a saved print file: where it goes next. Fetched with the first one. */
import { html, nothing, type TemplateResult } from "lit";
import { isFilament } from "../api/facts.js";
import type { Facts } from "../element/facts.js";
import { room } from "../texts/messages.js";
import { shown } from "../api/visible.js";

export const afterWords = room("after", {
  region: "Saved file",
  saved: "{name} is saved.",
  /** A file that the printer reads. */
  stick: "Copy it to the printer’s USB stick, put the stick into the printer, and choose the file there.",
  /** Masks, without a printer. */
  masks: "It holds an image for each layer; manifest.json says how thick each is. Choose a printer to get a file that it reads.",
  /** A model for the slicer of a filament printer. */
  slicer: "Open it in the slicer of your printer, which makes the file for the printer.",
  /** Shown if nobody has confirmed that the printer takes several thicknesses. */
  first: "The first time on this printer? Print the test towers before anything large.",
});

/** @param close called to dismiss the card */
export function afterDownload({ session, language, saveTowers }: Facts, name: string, close: () => void): TemplateResult | typeof nothing {
  const { result } = session;
  if (result === null) return nothing;
  const words = afterWords(language);
  const { report } = result;
  const next = isFilament(report.print_file.format) ? words.slicer : session.settings.printer === "" ? words.masks : words.stick;
  const isUntried = report.warnings?.some(({ code }) => code === "untried-thicknesses") ?? false;
  return html`<section class="card saved" part="toast" role="status" aria-label=${words.region}>
    <p><strong>${words.saved({ name: shown(name) })}</strong></p>
    <p>${next}</p>
    ${isUntried ? html`<p>${words.first}</p>` : nothing}
    <div class="tools">
      ${isUntried ? html`<button class="small" ?disabled=${session.towers !== "ready"} @click=${saveTowers}>${language.texts.towers.download}</button>` : nothing}
      <button class="small" @click=${close}>${language.texts.notices.close}</button>
    </div>
  </section>`;
}
