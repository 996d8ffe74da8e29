/** Errors of the page itself, shown at the bottom of the window until closed. */
import { html, nothing, type TemplateResult } from "lit";
import { shown } from "../api/visible.js";
import type { PageWords } from "./texts.js";

/** A part or the reader of print files could not be loaded, which only a reload fixes; or a model could not be kept. */
export type Notice = { says: "part" } | { says: "reader" | "notKept"; name: string };

export function noticeBar(notice: Notice, { notices: words }: PageWords, close: () => void): TemplateResult {
  const { says } = notice;
  return html`<div id="notice" role="alert">
    <p>${says === "part" ? words.part : words[says]({ name: shown(notice.name) })}</p>
    ${says === "notKept" ? nothing : html`<button @click=${() => location.reload()}>${words.reload}</button>`}
    <button @click=${close}>${words.close}</button>
  </div>`;
}
