/** Sets data-dependent styles as properties: a style attribute would need 'unsafe-inline' in a Content-Security-Policy. */
import { noChange } from "lit";
import { directive, Directive, type ElementPart } from "lit/directive.js";

class Styled extends Directive {
  render(_properties: Readonly<Record<string, string>>): typeof noChange {
    return noChange;
  }

  override update({ element }: ElementPart, [properties]: Parameters<this["render"]>): typeof noChange {
    for (const [name, value] of Object.entries(properties)) (element as HTMLElement).style.setProperty(name, value);
    return noChange;
  }
}

/** `<div ${styled({ width: "40%" })}></div>` */
export const styled = directive(Styled);
