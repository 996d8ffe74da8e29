/** The texts of what is fetched when a person asks for it, as they are themselves: named settings, recent models, the tour, the keys. */
import type { Language } from "../../../texts/index.js";
import type { Does, KeyName } from "../../key-table.js";
import { Catalogues } from "../../../texts/catalogues.js";
import { words as en } from "./en.js";

export interface VisitWords {
  saved: {
    none: string;
    /** Label of the field for a name. */
    name: string;
    save: string;
    /** In place of `save` where the name is in use. */
    replace: string;
    rename(name: string): string;
    delete(name: string): string;
    /** What belongs to named settings. */
    about: string;
    saved(name: string): string;
    deleted(name: string): string;
    undo: string;
    /** The browser keeps nothing. */
    failed: string;
    copyLink: string;
    copied: string;
    /** Where the browser does not let the page copy: label of a field with the link. */
    copyByHand: string;
    /** Saves the current settings as a file. */
    toFile: string;
    /** What the file is for, and what is not in it. */
    aboutFile: string;
    /** The file was saved. */
    inFile: string;
  };
  recent: {
    keep: string;
    /** What is kept, where, and what switching it off does. */
    about(models: string, bytes: string): string;
    none: string;
    delete(name: string): string;
    deleted(name: string): string;
    allDeleted: string;
    /** Another tab deleted the model. */
    gone(name: string): string;
  };
  tour: {
    region: string;
    steps: readonly (readonly [title: string, text: string])[];
    place(step: string, steps: string): string;
    next: string;
    skip: string;
    done: string;
  };
  keys: {
    title: string;
    close: string;
    everywhere: string;
    /** The tools that place support points and drain holes. */
    points: string;
    /** The slider of layers and the chart. */
    layers: string;
    mask: string;
    directions: string;
    does: Readonly<Record<Does, string>>;
    names: Readonly<Record<KeyName, string>>;
    /** The switch for `?`. */
    questionMark: string;
    tour: string;
  };
}

const catalogues = new Catalogues<VisitWords>(en, {
  de: () => import("./de.js"),
  es: () => import("./es.js"),
  fr: () => import("./fr.js"),
  zh: () => import("./zh.js"),
});

export function fetchVisitWords({ code }: Language): Promise<void> {
  return catalogues.fetch(code);
}

export function visitWords({ code }: Language): VisitWords {
  return catalogues.of(code);
}
