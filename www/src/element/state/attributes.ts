/**
 * What a page says of an element by attributes and properties: what makes sense is taken; of the rest its developer is told,
 * and the last good value stays.
 */
import { SlicerError } from "../../api/error.js";
import { ATTRIBUTES, SETTING_NAMES, SETTINGS, type SettingName } from "../properties.js";
import { METRICS } from "./metric.js";
import type { Preferences } from "./preferences.js";
import { noneOf, type Read, type Reader, type Wrong } from "./readers.js";
import { DEFAULT_SETTINGS, withTolerance, type Fault, type Settings } from "./settings.js";

/** What these attributes set. */
export function settingsOf(names: readonly SettingName[]): ReadonlySet<keyof Settings> {
  return new Set(names.map((name) => SETTINGS[name].sets));
}

/** Attributes that are judged here. */
type Name = { [N in keyof typeof ATTRIBUTES]: (typeof ATTRIBUTES)[N] extends { read: Reader<unknown> } ? N : never }[keyof typeof ATTRIBUTES];

type Value<N extends Name> = (typeof ATTRIBUTES)[N]["read"] extends Reader<infer T> ? T : never;

type Values = Partial<{ [N in SettingName]: Value<N> | null }>;

/** A setting that the page has given, and what it was before. */
interface Given {
  said: unknown;
  before: Partial<Settings>;
  after: Partial<Settings>;
}

export class Attributes {
  readonly #preferences: Preferences;
  readonly #tell: (error: SlicerError) => void;
  /** Settings given since the page's script has begun; in whatever order they come, they count together. */
  #turn: { base: Settings; said: Map<SettingName, unknown>; values: Values } | null = null;
  #given = new Map<SettingName, Given>();
  #errors: SlicerError[] = [];
  #isScheduled = false;

  /** @param tell is given what makes no sense, once the script that said it has ended */
  constructor(preferences: Preferences, tell: (error: SlicerError) => void) {
    this.#preferences = preferences;
    this.#tell = tell;
  }

  /** What an attribute says; null where it says nothing, undefined where that makes no sense. */
  read<N extends Name>(name: N, said: unknown): Value<N> | null | undefined {
    if (said === null || said === undefined || (typeof said === "string" && said.trim() === "")) return null;
    const { value, wrong } = ATTRIBUTES[name].read(said) as Read<Value<N>>;
    if (wrong !== undefined) this.#note(name, said, wrong, value !== undefined);
    return value;
  }

  /** Takes a setting. */
  set(name: SettingName, said: unknown): void {
    const value = this.read(name, said);
    if (value === undefined) return;
    this.#turn ??= { base: this.#preferences.settings, said: new Map(), values: {} };
    const { base, values } = this.#turn;
    this.#turn.said.set(name, said);
    Object.assign(values, { [name]: value });
    this.#preferences.preset(patchOf(values, base));
    this.#schedule();
  }

  /** Judges what was given until now; by itself that happens when the page's script has ended. */
  settle(): void {
    const turn = this.#turn;
    this.#turn = null;
    if (turn !== null) {
      for (const [name, said] of turn.said) {
        this.#given.set(name, { said, before: pick(turn.base, SETTINGS[name].sets), after: pick(this.#preferences.settings, SETTINGS[name].sets) });
      }
      this.#judge([...turn.said.keys()]);
    }
    for (const error of this.#errors.splice(0)) this.#tell(error);
  }

  /** Judges again what depends on the printers and resins that there are, since these have come. */
  offered(): void {
    this.settle();
    this.#judge(SETTING_NAMES);
    this.settle();
  }

  #judge(names: readonly SettingName[]): void {
    for (const name of SETTING_NAMES) {
      const given = names.includes(name) ? this.#given.get(name) : undefined;
      const wrong = this.#wrong(name);
      if (given === undefined || wrong === null || !this.#holds(given)) continue;
      this.#given.delete(name);
      this.#preferences.preset(given.before);
      // What was there before may have been given before anybody knew the names.
      const isNameless = wrong.known !== undefined && this.#wrong(name) !== null;
      if (isNameless) this.#preferences.preset(pick(DEFAULT_SETTINGS, SETTINGS[name].sets));
      this.#note(name, given.said, wrong, false);
    }
  }

  /** Whether nobody has changed it since. */
  #holds({ after }: Given): boolean {
    const { settings } = this.#preferences;
    return (Object.keys(after) as (keyof Settings)[]).every((key) => settings[key] === after[key]);
  }

  /** What is wrong with a setting beside the others. */
  #wrong(name: SettingName): Wrong | null {
    const { faults, settings, printers, resins } = this.#preferences;
    const within = (fault: Fault | undefined, scale = 1): Wrong | null => (fault === undefined ? null : { words: said(fault, scale) });
    switch (name) {
      case "printer":
        return unknown(settings.printer, printers.map(({ name }) => name));
      case "resin":
        return unknown(settings.resin, resins.map(({ name = "" }) => name));
      case "tolerance":
        return within(faults.tolerance, METRICS[settings.metric].scale);
      case "layer-max":
        return within(faults.layerMax);
      case "layer-min":
        return within(faults.layerMin ?? (faults.layerMax?.kind === "upsideDown" ? faults.layerMax : undefined));
      default:
        return null;
    }
  }

  #note(attribute: Name, value: unknown, { words, known }: Wrong, isPart: boolean): void {
    const rest = isPart ? "the others count" : "the last good value stays";
    const detail = { attribute, value, ...(known !== undefined && { known }) };
    this.#errors.push(new SlicerError("bad-attribute", `${attribute}="${String(value)}" ${words}; ${rest}`, detail));
    this.#schedule();
  }

  #schedule(): void {
    if (this.#isScheduled) return;
    this.#isScheduled = true;
    queueMicrotask(() => {
      this.#isScheduled = false;
      this.settle();
    });
  }
}

/** A name that is none of those known; where none is known yet any will do. */
function unknown(name: string, known: readonly string[]): Wrong | null {
  return name === "" || known.length === 0 || known.includes(name) ? null : noneOf(known);
}

function said(fault: Fault, scale: number): string {
  switch (fault.kind) {
    case "upsideDown":
      return "leaves no layer thickness between layer-min and layer-max";
    case "whole":
      return "is no whole number";
    default:
      return `is not from ${fault.least / scale} to ${fault.most / scale}`;
  }
}

function pick<Key extends keyof Settings>(settings: Settings, key: Key): Pick<Settings, Key> {
  return { [key]: settings[key] } as Pick<Settings, Key>;
}

/** The change of settings that these values mean; null is the usual. */
function patchOf(values: Values, base: Settings): Partial<Settings> {
  const { printer, resin, format, metric, tolerance } = values;
  const [thinnest, thickest] = [values["layer-min"], values["layer-max"]];
  const patch: Partial<Settings> = {};
  if (printer !== undefined) patch.printer = printer ?? "";
  if (resin !== undefined) patch.resin = resin ?? "";
  if (format !== undefined) patch.format = format ?? "";
  if (metric !== undefined) patch.metric = metric ?? DEFAULT_SETTINGS.metric;
  if (thinnest !== undefined) patch.layerMin = thinnest === null ? DEFAULT_SETTINGS.layerMin : String(thinnest);
  if (thickest !== undefined) patch.layerMax = thickest === null ? DEFAULT_SETTINGS.layerMax : String(thickest);
  if (tolerance !== undefined) {
    const { scale } = METRICS[patch.metric ?? base.metric];
    Object.assign(patch, withTolerance({ ...base, ...patch }, tolerance === null ? "" : String(tolerance * scale)));
  }
  return patch;
}
