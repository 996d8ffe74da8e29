/** Texts of parts that are fetched on request: named settings, recent models, the tour, the keys. The texts are also fetched on request. */
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
    /** Replaces `save` if the name is in use. */
    replace: string;
    rename(name: string): string;
    delete(name: string): string;
    /** Explains which settings are saved. */
    about: string;
    saved(name: string): string;
    deleted(name: string): string;
    undo: string;
    /** Shown if the browser keeps nothing. */
    failed: string;
    copyLink: string;
    copied: string;
    /** Label of a field with the link, if the browser does not permit copying. */
    copyByHand: string;
    /** Saves the current settings as a file. */
    toFile: string;
    /** Explains the file's purpose and its omissions. */
    aboutFile: string;
    /** Shown when the file was saved. */
    inFile: string;
  };
  recent: {
    keep: string;
    /** Explains which models are kept, where, and the effect of switching it off. */
    about(models: string, bytes: string): string;
    none: string;
    delete(name: string): string;
    deleted(name: string): string;
    allDeleted: string;
    /** Shown if another tab has deleted the model. */
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
    /** Heading of the keys for placing support points and drain holes. */
    points: string;
    /** Heading of the keys for the layer slider and the chart. */
    layers: string;
    mask: string;
    directions: string;
    does: Readonly<Record<Does, string>>;
    names: Readonly<Record<KeyName, string>>;
    /** Label of the switch for `?`. */
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
