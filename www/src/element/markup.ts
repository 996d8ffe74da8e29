/**
 * Types of the element's properties, attributes and listeners in the markup of frameworks. Derived from the list of properties and from the
 * events, so that nothing is listed twice.
 */
import type { CuspSlicer } from "./cusp-slicer.js";
import type { CuspSlicerEvents } from "./events.js";
import type { PROPERTIES, PropertyName } from "./properties.js";

type AttributeOf<Name extends PropertyName> = (typeof PROPERTIES)[Name] extends { attribute: infer Attribute extends string } ? Attribute : never;

/** Numbers may be written as text. */
type Written<Value> = Value extends number ? Value | `${number}` : Value;

/** Properties, and attributes under their own names. */
export type CuspSlicerAttributes = {
  [Name in PropertyName as Name | AttributeOf<Name>]?: Written<CuspSlicer[Name]> | undefined;
};

/** Listeners, with the prefix that a framework puts before an event's name. */
export type CuspSlicerListeners<Prefix extends string> = {
  [Name in keyof CuspSlicerEvents as `${Prefix}${Name}`]?: ((event: CuspSlicerEvents[Name]) => void) | undefined;
};
