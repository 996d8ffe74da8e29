/**
 * The element in the markup of frameworks: what can be set there, and what can be listened to. All of that follows from
 * the class and its events, so that nothing is listed twice.
 */
import type { LitElement } from "lit";
import type { CuspSlicer } from "./cusp-slicer.js";
import type { CuspSlicerEvents } from "./events.js";

type Same<A, B> = (<T>() => T extends A ? 1 : 2) extends <T>() => T extends B ? 1 : 2 ? true : false;

/** Properties of the class itself that can be set. */
type Settable = {
  [Name in Exclude<keyof CuspSlicer, keyof LitElement>]: CuspSlicer[Name] extends (...given: never) => unknown
    ? never
    : Same<Pick<CuspSlicer, Name>, Readonly<Pick<CuspSlicer, Name>>> extends true
      ? never
      : Name;
}[Exclude<keyof CuspSlicer, keyof LitElement>];

/** `layerMin` is the attribute `layer-min`. */
type Hyphenated<Name extends string> = Name extends `${infer First}${infer Rest}`
  ? `${First extends Lowercase<First> ? First : `-${Lowercase<First>}`}${Hyphenated<Rest>}`
  : Name;

/** Numbers may be written as text. */
type Written<Value> = Value extends number ? Value | `${number}` : Value;

/** Properties, and attributes by their own names. */
export type CuspSlicerAttributes = {
  [Name in Settable as Name | Hyphenated<Name>]?: Written<CuspSlicer[Name]> | undefined;
};

/** Listeners, by what a framework writes before an event's name. */
export type CuspSlicerListeners<Prefix extends string> = {
  [Name in keyof CuspSlicerEvents as `${Prefix}${Name}`]?: ((event: CuspSlicerEvents[Name]) => void) | undefined;
};
