/** A button of the page's header with a panel below it. */
import { html, type TemplateResult } from "lit";
import { icon, type IconName } from "./icons.js";

export interface Flyout {
  /** Unique within the page. */
  id: string;
  label: string;
  /** Replaces the label on a phone. */
  icon: IconName;
  content: TemplateResult;
  /** Called before the panel is shown, to fetch its content. */
  opening(): void;
}

export function flyout({ id, label, icon: name, content, opening }: Flyout): TemplateResult {
  const toggled = (event: Event): void => {
    if ((event as ToggleEvent).newState === "open") opening();
  };
  return html`<span class="flyout" @keydown=${kept}>
    <button popovertarget=${id} title=${label}>${icon(name)}<span>${label}</span></button>
    <div id=${id} popover role="group" aria-label=${label} @beforetoggle=${toggled}>${content}</div>
  </span>`;
}

export function closeFlyout(id: string): void {
  document.getElementById(id)?.hidePopover();
}

/** Keeps Escape, which closes an open panel, from cancelling a task. */
function kept(event: KeyboardEvent): void {
  const isOpen = (event.currentTarget as HTMLElement).querySelector(":popover-open") !== null;
  if (event.key === "Escape" && isOpen) event.stopPropagation();
}
