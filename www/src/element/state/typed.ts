/**
 * Numbers as people type them: with a decimal comma or point, with or without a unit. Settings hold them in canonical form:
 * digits with a decimal point, in the unit of the field.
 */

/** The unit of a field; empty for a count. */
export type FieldUnit = "mm" | "s" | "%" | "mm³" | "";

/**
 * Why a text is no number for a field: it is none at all, it has a unit that does not fit, or thousands may be separated
 * in it.
 */
export type Misread = "number" | "unit" | "grouped";

export type Reading = { value: number; fault: null } | { value: null; fault: Misread };

const MM_PER_INCH = 25.4;
const MM_PER_MICROMETRE = 0.001;

/** What may be typed after a number, as {@link tidied} has it, and how many of the field's unit it is. */
const UNITS: Readonly<Record<FieldUnit, ReadonlyMap<string, number>>> = {
  mm: new Map([
    ["mm", 1],
    ...["μm", "um", "μ", "micron", "microns"].map((name) => [name, MM_PER_MICROMETRE] as const),
    ["cm", 10],
    ...["in", "inch", "inches", '"', "′′"].map((name) => [name, MM_PER_INCH] as const),
    ...["thou", "mil", "mils"].map((name) => [name, MM_PER_INCH / 1000] as const),
  ]),
  s: new Map([["s", 1], ["sec", 1], ["ms", 0.001], ["min", 60]]),
  "%": new Map([["%", 1]]),
  "mm³": new Map([["mm^3", 1], ["mm3", 1]]),
  "": new Map(),
};

/** The units to name to somebody who typed another one. */
export const UNITS_SHOWN: Readonly<Record<FieldUnit, readonly string[]>> = {
  mm: ["mm", "µm", "cm", "in", "thou"],
  s: ["s", "ms", "min"],
  "%": ["%"],
  "mm³": ["mm³"],
  "": [],
};

/** Decimals of a canonical number: a thousandth of what any field tells apart, far above the error of a product. */
const CANONICAL = new Intl.NumberFormat("en", { useGrouping: false, maximumFractionDigits: 9 });

/**
 * The number of a text in the unit of its field, which applies if none is typed.
 *
 * A comma and a point are both decimal marks. Thousands must not be separated, by any mark: `1.000,5` is refused. So is a
 * text that reads as a thousand in one language and as one in another: with the mark that is not the reader's own before exactly
 * three digits, such as `1,000` in English and `1.000` in German. `0,065` is clear, as no thousands begin with 0.
 *
 * @param decimal the decimal mark of the person's language; without it, either mark is taken as one
 */
export function read(text: string, unit: FieldUnit, decimal?: string): Reading {
  const [, start = "", name = ""] = /^([\d.,'’\s]*)(.*)$/s.exec(tidied(text)) ?? [];
  const digits = start.trim();
  if (/^\d{1,3}([.,'’\s]\d{3})+([.,]\d*)?$/.test(digits) && !isPlain(digits, decimal)) return { value: null, fault: "grouped" };
  if (!/^\d*[.,]?\d+$|^\d+[.,]$/.test(digits)) return { value: null, fault: "number" };
  const scale = name === "" ? 1 : UNITS[unit].get(name);
  if (scale === undefined) return { value: null, fault: unit === "" ? "number" : "unit" };
  return { value: Number(digits.replace(",", ".")) * scale, fault: null };
}

/** In lower case, with one form for spaces, digits and signs of every width, for both signs of micro, and for exponents. */
function tidied(text: string): string {
  return text.replace(/[¹²³⁰-₉]/g, "^$&").normalize("NFKC").trim().toLowerCase();
}

/** Returns true if digits that might be thousands are certainly a number with a decimal mark. */
function isPlain(digits: string, decimal: string | undefined): boolean {
  const [mark, ...more] = digits.replace(/\d/g, "");
  if (more.length > 0 || (mark !== "." && mark !== ",")) return false;
  return decimal === undefined || mark === decimal || digits.startsWith("0");
}

/** The canonical form of what was typed; a text that is no number stays one that is none in any language. */
export function canonical(text: string, unit: FieldUnit, decimal?: string): string {
  const { value } = read(text, unit, decimal);
  if (value !== null) return CANONICAL.format(value);
  // Settings have no language, which alone tells that `1.000` is no number.
  return read(text, unit).value === null ? text.trim() : text.trim().replace(/[.,]/, " ");
}

/** A canonical number with the decimal mark of a language; any other text as it is. */
export function localised(text: string, decimal: string): string {
  return /^\d*\.?\d*$/.test(text) ? text.replace(".", decimal) : text;
}
