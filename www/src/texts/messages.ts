/**
 * Messages with named placeholders, in English and in the language of a dictionary. `{name}` is a value as given, `{name|mm}` one in a
 * format, `{name|one:# layer|other:# layers}` the form for a number, and `{name|names.xml}` the message `names.xml.…` that the value names.
 * `best.layers` is a field of the value `best`.
 */
import type { FileKind, Metric, Unit } from "../api/wire.js";
import type { Format, Forms } from "./format.js";

/** Values of a message's placeholders. */
export interface Spoken {
  readonly format: Format;
  /** The text of a key, such as `plan.layers`, in this language or else in English. */
  message(key: string): string | undefined;
}

/** Messages of a language by key. */
export type Dictionary = Readonly<Record<string, string>>;

export type Tree = string | readonly Tree[] | { readonly [name: string]: Tree };

/** Values by the names of their placeholders. */
type Given = Readonly<Record<string, unknown>>;

type NumberFormat = { [Name in keyof Format]: Format[Name] extends (value: number) => string ? Name : never }[keyof Format];
type Placeholder<Text> = Text extends `${string}{${infer Inside}}${infer Rest}` ? Inside | Placeholder<Rest> : never;
type Name<Inside> = Inside extends `${infer Before}|${string}` ? Before : Inside;
type Value<Inside> = Inside extends `${string}|${infer Spec}` ? (Spec extends NumberFormat | `${Intl.LDMLPluralRule}:${string}` ? number : string) : string;

/** The values of a message; the compiler names a missing or surplus one. */
export type Values<Text> = { readonly [Inside in Placeholder<Text> as Name<Inside>]: Value<Inside> };

/** A tree of messages in a language: a text, or a function of its values. */
export type Bound<English> = English extends string
  ? [Placeholder<English>] extends [never]
    ? string
    : (values: Values<English>) => string
  : { readonly [Key in keyof English]: Bound<English[Key]> };

/** Every English message that has been loaded, by key. */
export const ENGLISH = new Map<string, string>();

/** Registers a room's English messages under a prefix, and returns the room in any language. */
export function room<const English extends Tree>(prefix: string, english: English): (language: Spoken) => Bound<English> {
  register(prefix, english);
  const rooms = new WeakMap<Spoken, unknown>();
  return (language) => {
    if (!rooms.has(language)) rooms.set(language, bind(prefix, english, language));
    return rooms.get(language) as never;
  };
}

const under = (prefix: string, name: string): string => (prefix === "" ? name : `${prefix}.${name}`);

function register(key: string, english: Tree): void {
  if (typeof english === "string") ENGLISH.set(key, english);
  else for (const [name, tree] of Object.entries(english)) register(under(key, name), tree);
}

function bind(key: string, english: Tree, language: Spoken): unknown {
  if (typeof english === "string") return english.includes("{") ? (values: Given) => say(key, values, language) : language.message(key);
  if (Array.isArray(english)) return english.map((tree: Tree, i) => bind(`${key}.${i}`, tree, language));
  const bound = {};
  for (const [name, tree] of Object.entries(english)) {
    const own = under(key, name);
    // Looked up at each use, since the rest of a dictionary arrives later.
    const isPlain = typeof tree === "string" && !tree.includes("{");
    Object.defineProperty(bound, name, { enumerable: true, ...(isPlain ? { get: () => language.message(own) } : { value: bind(own, tree, language) }) });
  }
  return bound;
}

/** A bound message with values that it may need. */
export function filled<All>(message: string | ((values: All) => string), values: All): string {
  return typeof message === "string" ? message : message(values);
}

export const PLACEHOLDER = /\{([\w.]+)(?:\|([^}]*))?\}/g;
const FORMS = /^(?:zero|one|two|few|many|other):/;

/** The message of a key; the last part of a key that is not known. */
export function say(key: string, values: Given, language: Spoken): string {
  const text = language.message(key) ?? key.slice(key.lastIndexOf(".") + 1);
  return text.replace(PLACEHOLDER, (_placeholder, name: string, spec = "") => write(field(values, name), spec, values, language));
}

const field = (values: unknown, name: string): unknown => name.split(".").reduce((value, key) => (value as Given)[key], values);

/** Formats that are no number's. */
const OTHERS: Readonly<Record<string, (value: never, format: Format, values: { metric: Metric; unit: Unit }) => string>> = {
  "": String,
  either: (value: readonly string[], { either }) => either(value),
  error: (value: number, { error }, { metric }) => error(metric, value),
  measure: (value: number, { measure }, { unit, metric }) => measure(value, unit, metric),
  ended,
  fileKind: (kind: FileKind) => FILE_KINDS[kind],
};

function write(value: unknown, spec: string, values: Given, language: Spoken): string {
  const { format } = language;
  if (Array.isArray(value) && spec !== "either") return format.list(value.map((item) => write(item, spec, values, language)));
  if (FORMS.test(spec)) return format.plural(value as number, formsOf(spec)).replace("#", () => format.count(value as number));
  const other = OTHERS[spec];
  if (other !== undefined) return other(value as never, format, values as never);
  return spec in format ? format[spec as NumberFormat](value as number) : say(`${spec}.${String(value)}`, values, language);
}

/** True for the name of a format. */
export const isFormat = (spec: string, format: Format): boolean => FORMS.test(spec) || spec in OTHERS || spec in format;

const formsOf = (spec: string): Forms =>
  Object.fromEntries(spec.split("|").map((form) => [form.slice(0, form.indexOf(":")), form.slice(form.indexOf(":") + 1)])) as Forms;

/** Names of the kinds of file, the same in every language. */
const FILE_KINDS: Readonly<Record<FileKind, string>> = {
  ...{ amf: "AMF", ply: "PLY", step: "STEP", gltf: "glTF" },
  ...{ zip: "zip", gzip: "gzip", html: "HTML" },
  ...{ png: "PNG", jpeg: "JPEG", pdf: "PDF", dxf: "DXF" },
};

/** Prefix that the core's bindings add to a message of the parser. */
const BORDER = /^Failed to deserialize JsValue into type `[^`]*`: (Error: )?/;

/** A system message as the end of a sentence: it may already have a full stop. */
function ended(system: string): string {
  const said = system.replace(BORDER, "").trim();
  return /[.!?。！？]$/.test(said) ? said : `${said}.`;
}
