/** Text fields that can be rendered while the user types. */
import { noChange } from "lit";
import { setCommittedValue } from "lit/directive-helpers.js";
import { directive, Directive, PartType, type PartInfo, type PropertyPart } from "lit/directive.js";

class Typed extends Directive {
  #field: HTMLInputElement | null = null;
  #isTyping = false;

  constructor(part: PartInfo) {
    super(part);
    if (part.type !== PartType.PROPERTY) throw new Error("only a property can be typed");
  }

  render(text: string): unknown {
    return text;
  }

  override update(part: PropertyPart, [text]: [string]): unknown {
    this.#listen(part);
    if (this.#isTyping || this.#field?.value === text) return noChange;
    // Discards Lit's last value: the user may have changed the field.
    setCommittedValue(part);
    return text;
  }

  #listen({ element }: PropertyPart): void {
    if (this.#field !== null) return;
    this.#field = element as HTMLInputElement;
    element.addEventListener("input", () => (this.#isTyping = true));
    for (const end of ["change", "blur"]) element.addEventListener(end, () => (this.#isTyping = false));
  }
}

/** Directive for the `value` of a text field that leaves the field alone while the user types, until a change or blur event. */
export const typed = directive(Typed);
