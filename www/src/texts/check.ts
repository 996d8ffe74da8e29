/** Checks dictionaries against English: in the build and in a unit test. */
import "../page/texts.js";
import "../page/visit-texts.js";
import "../print/texts.js";
import "../workbench/after-download.js";
import "../workbench/texts.js";
import "./findings.js";
import { languageOf } from "./index.js";
import { ENGLISH, isFormat, PLACEHOLDER, type Dictionary } from "./messages.js";
import "./bridges.js";
import "./orientation.js";
import "./own-printer.js";
import "./masking.js";
import "./painting.js";
import "./placing.js";
import "./problems.js";
import "./viewing.js";
import "./warnings.js";

export { LANGUAGES } from "./index.js";

/** All messages in English. */
export const english: Dictionary = Object.fromEntries(ENGLISH);

/** Errors of a dictionary, each with its file and key: a key that English does not have, other placeholders, unknown formats, an empty text. */
export function faultsOf(file: string, dictionary: Dictionary): string[] {
  return Object.entries(dictionary).flatMap(([key, text]) => {
    const model = english[key];
    if (model === undefined) return [`${file}: ${key}: English has no such key`];
    if (text === "") return [`${file}: ${key}: the text is empty`];
    const [needed, found] = [namesOf(model), namesOf(text)];
    const unknown = specsOf(text).filter((spec) => !isKnown(spec));
    return [
      ...(needed === found ? [] : [`${file}: ${key}: the placeholders are ${found || "none"}, not ${needed || "none"}`]),
      ...unknown.map((spec) => `${file}: ${key}: there is no format ${spec}`),
    ];
  });
}

/** Keys that a dictionary lacks, so that English replaces them. */
export const untranslated = (dictionary: Dictionary): string[] => Object.keys(english).filter((key) => dictionary[key] === undefined);

const namesOf = (text: string): string => [...new Set([...text.matchAll(PLACEHOLDER)].map(([, name = ""]) => name))].sort((a, b) => a.localeCompare(b)).join(", ");
const specsOf = (text: string): string[] => [...text.matchAll(PLACEHOLDER)].map(([, , spec = ""]) => spec);

/** A format, or the beginning of the keys of nouns. */
const isKnown = (spec: string): boolean => isFormat(spec, languageOf("en").format) || Object.keys(english).some((key) => key.startsWith(`${spec}.`));
