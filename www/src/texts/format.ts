/** Number formats of a language. Lengths are given in mm, times in s. */

import type { Metric, Unit } from "../api/wire.js";

/** Words of the formats: the units for hours and minutes after a number, and the separator of enumerations. */
export const FORMAT_WORDS = { hours: "h", minutes: "min", separator: ", " } as const;

export type Format = ReturnType<typeof formatOf>;

/** Word forms by plural category of the language; `other` for categories without one. */
export type Forms = Partial<Record<Intl.LDMLPluralRule, string>> & { other: string };

export function formatOf(locale: string, { hours, minutes, separator }: Readonly<Record<keyof typeof FORMAT_WORDS, string>>) {
  const formatters = new Map<string, Intl.NumberFormat>();
  const rules = new Intl.PluralRules(locale);

  function number(value: number, options: Intl.NumberFormatOptions): string {
    const key = JSON.stringify(options);
    let formatter = formatters.get(key);
    if (formatter === undefined) formatters.set(key, (formatter = new Intl.NumberFormat(locale, options)));
    return formatter.format(value);
  }

  /** A count: `1,200`. */
  const count = (value: number): string => number(value, { maximumFractionDigits: 0 });
  /** The word form for a number: `layer`, `layers`. */
  const plural = (value: number, forms: Forms): string => forms[rules.select(value)] ?? forms.other;
  /** A height or a size without its unit, to 0.1 mm: `60.0`. */
  const size = (value: number): string => number(value, { minimumFractionDigits: 1, maximumFractionDigits: 1 });
  /** A number on an axis, or as typed. */
  const tick = (value: number): string => number(value, { maximumFractionDigits: 3 });
  /** A number to at most six decimals. */
  const exact = (value: number): string => number(value, { maximumFractionDigits: 6 });
  const fine = (mm: number): string => `${tick(mm)}\u00a0mm`;
  const percent = (value: number, decimals = 0): string => number(value, { style: "percent", maximumFractionDigits: decimals });
  const volume = (mm3: number): string => `${number(mm3, { maximumSignificantDigits: 4 })}\u00a0mm³`;
  /** An error or a tolerance with the unit of its metric. */
  const error = (metric: Metric, value: number): string => {
    if (metric === "area") return percent(value, 2);
    // The default deviation has four decimals.
    if (metric === "deviation") return `${number(value, { maximumFractionDigits: 4 })}\u00a0mm`;
    return metric === "volume" ? volume(value) : fine(value);
  };
  const micrometres = { minimumFractionDigits: 3, maximumFractionDigits: 3 };
  const decimal = new Intl.NumberFormat(locale).formatToParts(0.5).find(({ type }) => type === "decimal")?.value ?? ".";

  return {
    locale,
    /** The decimal mark: `.` or `,`. */
    decimal,
    count,
    plural,
    size,
    tick,
    exact,
    error,
    /** A length to at most six decimals: `0.0125 mm`. */
    mm: (value: number): string => `${exact(value)}\u00a0mm`,
    /** A number to at most six decimals with its unit; by default the unit of the metric. */
    measure: (value: number, unit: Unit, metric: Metric = "cusp"): string =>
      unit === "" ? error(metric, value) : `${exact(value)}\u00a0${unit}`,
    /** A thickness, tolerance or error with its unit, to the micrometre, without trailing zeros: `0.05 mm`. */
    fine,
    /** A height on the model with its unit, always with three decimals to keep its width: `12.340 mm`. */
    height: (mm: number): string => `${number(mm, micrometres)}\u00a0mm`,
    /** A height without its unit, likewise. */
    bareHeight: (mm: number): string => number(mm, micrometres),
    /** A fraction as a percentage: `34 %` or `34%`, depending on the language, with at most this many decimals. */
    percent,
    /** A volume: `11.26 mm³`. */
    volume,
    /** An amount of resin: `44.4 ml`. */
    millilitres: (ml: number): string => `${number(ml, { maximumSignificantDigits: 3 })}\u00a0ml`,
    /** A machine time: `7.6 s`. */
    seconds: (value: number): string => `${number(value, { maximumFractionDigits: 1 })}\u00a0s`,
    /** Print time to the minute, as estimates are no more accurate: `2 h 14 min`. */
    time(seconds: number): string {
      const whole = Math.round(seconds / 60);
      if (whole < 1) return `<\u00a01\u00a0${minutes}`;
      const [h, rest] = [Math.floor(whole / 60), `${whole % 60}\u00a0${minutes}`];
      return h === 0 ? rest : `${count(h)}\u00a0${hours}\u00a0${rest}`;
    },
    /** A duration given in ms: `412 ms`, `1.3 s`. */
    duration(ms: number): string {
      if (ms < 1) return "< 1\u00a0ms";
      if (ms < 995) return `${number(ms, { maximumFractionDigits: 0 })}\u00a0ms`;
      return `${number(ms / 1000, { minimumFractionDigits: 1, maximumFractionDigits: 1 })}\u00a0s`;
    },
    /** An enumeration: `0.05, 0.1`. */
    list: (items: readonly string[]): string => items.join(separator),
    /** A list of all items: `a.stl and b.stl`. */
    all: (items: readonly string[]): string => new Intl.ListFormat(locale, { type: "conjunction" }).format(items),
    /** A list of alternatives: `.ctb or .goo`. */
    either: (items: readonly string[]): string => new Intl.ListFormat(locale, { type: "disjunction" }).format(items),
    /** Width × depth × height: `60.0 × 46.5 × 59.5 mm`. */
    dimensions: (mm: readonly [number, number, number]): string => `${mm.map(size).join(" × ")}\u00a0mm`,
  };
}
