/** Elements that declare each property once: its name, type, initial value, and whether the user or the element sets it. */
import { LitElement, type PropertyDeclaration } from "lit";

export interface Property<Value> {
  readonly first: Value;
  readonly declaration: PropertyDeclaration;
}

/** A property set by the element's user, never as an attribute. */
export function given<Value>(first: Value, hasChanged?: (value: unknown, before: unknown) => boolean): Property<Value> {
  return { first, declaration: { attribute: false, ...(hasChanged !== undefined && { hasChanged }) } };
}

/** State set only by the element. */
export function own<Value>(first: Value): Property<Value> {
  return { first, declaration: { state: true } };
}

type List = Readonly<Record<string, Property<unknown>>>;

type Values<L extends List> = { -readonly [Name in keyof L]: L[Name] extends Property<infer Value> ? Value : never };

/** Base class: `LitElement` with the listed properties. */
export type ElementWith<L extends List> = Pick<typeof LitElement, keyof typeof LitElement> & (new () => LitElement & Values<L>);

/** @param list initial values are shared by all elements of the class and must not be modified in place */
export function elementWith<L extends List>(list: L): ElementWith<L> {
  const each = Object.entries(list);
  class Element extends LitElement {
    static override properties = Object.fromEntries(each.map(([name, { declaration }]) => [name, declaration]));

    constructor() {
      super();
      Object.assign(this, Object.fromEntries(each.map(([name, { first }]) => [name, first])));
    }
  }
  return Element as unknown as ElementWith<L>;
}
