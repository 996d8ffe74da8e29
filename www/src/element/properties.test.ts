import type { LitElement } from "lit";
import { expect, expectTypeOf, test } from "vitest";
import type { CuspSlicer } from "./cusp-slicer.js";
import { DECLARATIONS, PROPERTIES, READ_ONLY, type PropertyName } from "./properties.js";

type Same<A, B> = (<T>() => T extends A ? 1 : 2) extends <T>() => T extends B ? 1 : 2 ? true : false;

type Own = Exclude<keyof CuspSlicer, keyof LitElement>;

type IsReadOnly<Name extends Own> = Same<Pick<CuspSlicer, Name>, Readonly<Pick<CuspSlicer, Name>>>;

/** Properties of the class itself, without its methods. */
type Properties = { [Name in Own]: CuspSlicer[Name] extends (...given: never) => unknown ? never : Name }[Own];

type Settable = { [Name in Properties]: IsReadOnly<Name> extends true ? never : Name }[Properties];

test("the lists name every settable property and every read-only one", () => {
  // `dragging` and `recentPrinters` are internal.
  expectTypeOf<Exclude<Settable, "dragging" | "recentPrinters">>().toEqualTypeOf<PropertyName>();
  expectTypeOf<Exclude<Properties, Settable | "slicer">>().toEqualTypeOf<(typeof READ_ONLY)[number]>();
});

test("an attribute is its property's name with hyphens, and is declared to Lit", () => {
  const hyphenated = (name: string): string => name.replaceAll(/[A-Z]/g, (letter) => `-${letter.toLowerCase()}`);
  for (const [name, it] of Object.entries(PROPERTIES)) {
    expect(it?.attribute ?? hyphenated(name)).toBe(hyphenated(name));
    expect(name in DECLARATIONS).toBe(it !== null);
  }
});
