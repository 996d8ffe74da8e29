/** Small icon buttons, drawn in a square of 20 units. */
import { html, nothing, type TemplateResult } from "lit";
import type { Language } from "../../texts/index.js";
import type { Session } from "../state/session.js";

const ICONS = {
  undo: "M8 5 4 9l4 4M4 9h8a4 4 0 0 1 0 8H9",
  redo: "m12 5 4 4-4 4m4-4H8a4 4 0 0 0 0 8h3",
  remove: "M4 5.5h12M8 5.5V3.5h4v2M5.5 5.5l.75 11h7.5l.75-11M8.5 8.5v5M11.5 8.5v5",
} as const;

/** @param isPressed state of a button that switches; undefined for others */
export const drawnButton = (path: string, name: string, act: () => void, isPossible = true, isPressed?: boolean): TemplateResult => html`<button
  class="small icon"
  aria-label=${name}
  title=${name}
  aria-pressed=${isPressed ?? nothing}
  ?disabled=${!isPossible}
  @click=${act}
>
  <svg viewBox="0 0 20 20" aria-hidden="true"><path d=${path} /></svg>
</button>`;

export const iconButton = (icon: keyof typeof ICONS, name: string, isPossible: boolean, act: () => void): TemplateResult => drawnButton(ICONS[icon], name, act, isPossible);

/** Undo and redo buttons of a session. */
export const stepButtons = (session: Pick<Session, "canUndo" | "canRedo" | "undo" | "redo">, { texts: { settings: words } }: Language): TemplateResult =>
  html`${iconButton("undo", words.undo, session.canUndo, () => session.undo())} ${iconButton("redo", words.redo, session.canRedo, () => session.redo())}`;
