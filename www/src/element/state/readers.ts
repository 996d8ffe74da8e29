/** Readers of attribute and property values, which describe the expected value if one is invalid. */
import { isPrinter, type ChosenPrinter } from "./printer.js";

/** Description of the expected value. */
export interface Wrong {
  /** Completes a sentence that begins with the attribute. */
  words: string;
  /** The valid names, if there is a list. */
  known?: readonly string[];
}

export interface Read<T> {
  /** Null if nothing was set; absent if the value is invalid. */
  value?: T | null;
  wrong?: Wrong;
}

export type Reader<T> = (said: unknown) => Read<T>;

/** A longer list is counted in the sentence, not listed; the error's detail has it. */
const MOST_TOLD = 20;

export const noneOf = (known: readonly string[]): Wrong => {
  const told = known.length > MOST_TOLD ? `the ${known.length} known ones` : known.join(", ");
  return { words: `is none of ${told}`, known };
};

export const text: Reader<string> = (said) => (typeof said === "string" ? { value: said } : { wrong: { words: "is no text" } });

/** Reads a name, or a description set as a property. The core checks the values of a description. */
export const printer: Reader<ChosenPrinter> = (said) => {
  if (typeof said === "string" || isPrinter(said)) return { value: said };
  return { wrong: { words: "is neither a name nor a description with pixels, pitch_um and volume_mm" } };
};

const numberOf = (said: unknown): number => (typeof said === "string" ? Number(said) : typeof said === "number" ? said : Number.NaN);

export const number: Reader<number> = (said) => {
  const value = numberOf(said);
  return Number.isFinite(value) ? { value } : { wrong: { words: "is no number" } };
};

export const fraction: Reader<number> = (said) => {
  const value = numberOf(said);
  return value >= 0 && value <= 1 ? { value } : { wrong: { words: "is no number from 0 to 1" } };
};

export const languageTag: Reader<string> = (said) => {
  try {
    return { value: new Intl.Locale(String(said)).toString() };
  } catch {
    return { wrong: { words: "is no BCP 47 language tag" } };
  }
};

export const oneOf =
  <T extends string>(known: readonly T[]): Reader<T> =>
  (said) => {
    const value = known.find((it) => it === said);
    return value === undefined ? { wrong: noneOf(known) } : { value };
  };

/** Reads several names: the known ones apply and the others are reported. Invalid if none is known. */
export const someOf =
  <T extends string>(known: readonly T[]): Reader<readonly T[]> =>
  (said) => {
    const named = String(said).trim().split(/\s+/);
    const value = known.filter((it) => named.includes(it));
    const strange = named.filter((it) => !known.some((one) => one === it));
    if (strange.length === 0) return { value };
    const words = `names ${strange.join(", ")}, but there are only ${known.join(", ")}`;
    return { wrong: { words, known }, ...(value.length > 0 && { value }) };
  };
