/**
 * Parses numbers as users type them: with a decimal comma or point, with or without a unit. Settings store them in canonical form: digits
 * with a decimal point, in the unit of the field.
 */

/** Unit of a field; empty for a count. */
export type FieldUnit = "mm" | "s" | "%" | "mm³" | "°" | "";

/** Reason for which a text is not a valid number: not a number at all, an unsuitable unit, or possible digit grouping. */
export type Misread = "number" | "unit" | "grouped";

export type Reading = { value: number; fault: null } | { value: null; fault: Misread };

const MM_PER_INCH = 25.4;
const MM_PER_MICROMETRE = 0.001;

/** Accepted units after a number, as normalised by {@link tidied}, with their size in the field's unit. */
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
  "°": new Map([["°", 1], ["deg", 1]]),
  "": new Map(),
};

/** Units suggested after an unsuitable one. */
export const UNITS_SHOWN: Readonly<Record<FieldUnit, readonly string[]>> = {
  mm: ["mm", "µm", "cm", "in", "thou"],
  s: ["s", "ms", "min"],
  "%": ["%"],
  "mm³": ["mm³"],
  "°": ["°"],
  "": [],
};

/** Decimals of a canonical number: a thousandth of any field's resolution, far above the error of a product. */
const CANONICAL = new Intl.NumberFormat("en", { useGrouping: false, maximumFractionDigits: 9 });

/**
 * Number of a text in the unit of its field, which is the default unit.
 *
 * A comma and a point are both decimal marks. Digit grouping is refused, with any mark: `1.000,5` is invalid. So is a text that could be a
 * thousand in one language and one in another, with the foreign mark before exactly three digits: `1,000` in English and `1.000` in German.
 * `0,065` is unambiguous, as no grouped number begins with 0.
 *
 * @param decimal decimal mark of the user's language; by default, either mark is accepted
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

/** Normalises a text: lower case, one form each for spaces, full-width digits and signs, the two signs for micro, and exponents. */
function tidied(text: string): string {
  return text.replace(/[¹²³⁰-₉]/g, "^$&").normalize("NFKC").trim().toLowerCase();
}

/** Returns true if digits that might be grouped are certainly a decimal number. */
function isPlain(digits: string, decimal: string | undefined): boolean {
  const [mark, ...more] = digits.replace(/\d/g, "");
  if (more.length > 0 || (mark !== "." && mark !== ",")) return false;
  return decimal === undefined || mark === decimal || digits.startsWith("0");
}

/** Canonical form of typed text; invalid text stays invalid in every language. */
export function canonical(text: string, unit: FieldUnit, decimal?: string): string {
  const { value } = read(text, unit, decimal);
  if (value !== null) return CANONICAL.format(value);
  // Settings have no language, by which alone `1.000` is known to be invalid.
  return read(text, unit).value === null ? text.trim() : text.trim().replace(/[.,]/, " ");
}

/** A canonical number with the decimal mark of a language; any other text unchanged. */
export function localised(text: string, decimal: string): string {
  return /^\d*\.?\d*$/.test(text) ? text.replace(".", decimal) : text;
}
