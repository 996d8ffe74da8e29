/** The key `?`, which opens the list of keys. */
import { readKept, writeKept } from "./storage.js";

/** Returns true if the key is enabled: users of dictation can switch it off, since their words may contain any character (WCAG 2.1.4). */
export const hasQuestionMark = (): boolean => readKept("question-mark") === null;

export function setQuestionMark(is: boolean): void {
  writeKept("question-mark", is ? null : "off");
}

/** Returns true if a key press requests the list, except in a text field. */
export function asksForKeys(event: KeyboardEvent): boolean {
  const { key, ctrlKey, metaKey, altKey } = event;
  return key === "?" && !ctrlKey && !metaKey && !altKey && !isTyping(event) && hasQuestionMark();
}

const TYPED = "textarea, select, input:not([type=checkbox], [type=radio], [type=range], [type=file])";

function isTyping(event: KeyboardEvent): boolean {
  const [origin] = event.composedPath();
  return origin instanceof HTMLElement && (origin.isContentEditable || origin.matches(TYPED));
}
