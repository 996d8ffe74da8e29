/**
 * Reads the attributes and properties that a page sets. Valid values are applied; invalid ones are reported to the page's developer, and
 * the last valid value stays.
 */
import { SlicerError } from "../../api/error.js";
import { ATTRIBUTES, SETTING_NAMES, SETTINGS, type SettingName } from "../properties.js";
import { METRICS } from "./metric.js";
import { isEqual } from "./plain.js";
import type { Preferences } from "./preferences.js";
import { noneOf, type Read, type Reader, type Wrong } from "./readers.js";
import { DEFAULT_SETTINGS, defaultsOf, limitsFor, withTolerance, type Fault, type Settings } from "./settings.js";

/** The settings that these attributes set. */
export function settingsOf(names: readonly SettingName[]): ReadonlySet<keyof Settings> {
  return new Set(names.map((name) => SETTINGS[name].sets));
}

/** Attributes checked here. */
type Name = { [N in keyof typeof ATTRIBUTES]: (typeof ATTRIBUTES)[N] extends { read: Reader<unknown> } ? N : never }[keyof typeof ATTRIBUTES];

type Value<N extends Name> = (typeof ATTRIBUTES)[N]["read"] extends Reader<infer T> ? T : never;

type Values = Partial<{ [N in SettingName]: Value<N> | null }>;

/** A setting given by the page, and the previous one. */
interface Given {
  said: unknown;
  before: Partial<Settings>;
  after: Partial<Settings>;
}

export class Attributes {
  readonly #preferences: Preferences;
  readonly #tell: (error: SlicerError) => void;
  /** Settings given since the page's script began; checked together, independent of their order. */
  #turn: { base: Settings; said: Map<SettingName, unknown>; values: Values } | null = null;
  #given = new Map<SettingName, Given>();
  #errors: SlicerError[] = [];
  /** The last invalid value of each attribute without a valid one since. Prevents an endless loop in a page that renders on errors. */
  readonly #told = new Map<Name, unknown>();
  #isScheduled = false;

  /** @param tell receives an error for each invalid value, once the script that set it has ended */
  constructor(preferences: Preferences, tell: (error: SlicerError) => void) {
    this.#preferences = preferences;
    this.#tell = tell;
  }

  /** Value of an attribute; null if absent or empty, undefined if invalid. Faults are reported. */
  read<N extends Name>(name: N, said: unknown): Value<N> | null | undefined {
    const isNothing = said === null || said === undefined || (typeof said === "string" && said.trim() === "");
    const { value, wrong }: Read<Value<N>> = isNothing ? { value: null } : (ATTRIBUTES[name].read(said) as Read<Value<N>>);
    if (wrong === undefined) this.#told.delete(name);
    else if (!this.#told.has(name) || !isEqual(said, this.#told.get(name))) {
      this.#told.set(name, said);
      this.#note(name, said, wrong, value !== undefined);
    }
    return value;
  }

  /** Applies a setting. */
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

  /** Checks the settings given so far. Called automatically once the page's script has ended. */
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

  /** Checks the settings again when the lists of printers or resins arrive. */
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
      // The previous name may itself have been set before the list arrived.
      const isNameless = wrong.known !== undefined && this.#wrong(name) !== null;
      if (isNameless) this.#preferences.preset(pick(DEFAULT_SETTINGS, SETTINGS[name].sets));
      this.#note(name, given.said, wrong, false);
    }
  }

  /** Returns true if the setting has not changed since the page gave it. */
  #holds({ after }: Given): boolean {
    const { settings } = this.#preferences;
    return (Object.keys(after) as (keyof Settings)[]).every((key) => settings[key] === after[key]);
  }

  /** Fault of a setting, given the others; null if valid. */
  #wrong(name: SettingName): Wrong | null {
    const { faults, settings, printers, resins } = this.#preferences;
    const within = (fault: Fault | undefined, scale = 1): Wrong | null => (fault === undefined ? null : { words: said(fault, scale) });
    switch (name) {
      case "printer":
        return typeof settings.printer === "string" ? unknown(settings.printer, printers.map(({ name }) => name)) : null;
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
    const text = typeof value === "string" || typeof value === "number" ? `"${value}"` : JSON.stringify(value);
    this.#errors.push(new SlicerError("bad-attribute", `${attribute}=${text} ${words}; ${rest}`, detail));
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

/** Fault of an unknown name. Any name is valid until the list has arrived. */
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

/** Change of settings for these values; null means the default. */
function patchOf(values: Values, base: Settings): Partial<Settings> {
  const { printer, resin, format, metric, tolerance } = values;
  const [thinnest, thickest] = [values["layer-min"], values["layer-max"]];
  const patch: Partial<Settings> = {};
  if (printer !== undefined) patch.printer = printer ?? "";
  if (resin !== undefined) patch.resin = resin ?? "";
  if (format !== undefined) Object.assign(patch, limitsFor(base, format ?? ""), { format: format ?? "" });
  if (metric !== undefined) patch.metric = metric ?? DEFAULT_SETTINGS.metric;
  const usual = defaultsOf(patch.format ?? base.format, base.nozzle);
  if (thinnest !== undefined) patch.layerMin = thinnest === null ? usual.layerMin : String(thinnest);
  if (thickest !== undefined) patch.layerMax = thickest === null ? usual.layerMax : String(thickest);
  if (tolerance !== undefined) {
    const { scale } = METRICS[patch.metric ?? base.metric];
    Object.assign(patch, withTolerance({ ...base, ...patch }, tolerance === null ? "" : String(tolerance * scale)));
  }
  return patch;
}
