/** Numbers in words, in the reader's own language conventions. Lengths come in mm. */

const formatters = new Map<string, Intl.NumberFormat>();

function number(value: number, options: Intl.NumberFormatOptions): string {
  const key = JSON.stringify(options);
  let formatter = formatters.get(key);
  if (formatter === undefined) formatters.set(key, (formatter = new Intl.NumberFormat(undefined, options)));
  return formatter.format(value);
}

/** A count: `1,200`. */
export const count = (value: number): string => number(value, { maximumFractionDigits: 0 });

/** A height or a size without its unit, to 0.1 mm: `60.0`. */
export const size = (value: number): string =>
  number(value, { minimumFractionDigits: 1, maximumFractionDigits: 1 });

/** A thickness, tolerance or error with its unit, to the micrometre, no idle zeros: `0.05 mm`. */
export const fine = (value: number): string => `${number(value, { maximumFractionDigits: 3 })}\u00a0mm`;

/** A height on the model with its unit, always to the micrometre, so that it does not jump about: `12.340 mm`. */
export const height = (value: number): string =>
  `${number(value, { minimumFractionDigits: 3, maximumFractionDigits: 3 })}\u00a0mm`;

/** Where something lies on the model: `12.340 to 12.390 mm`. */
export const interval = (from: number, to: number): string =>
  `${number(from, { minimumFractionDigits: 3, maximumFractionDigits: 3 })} to ${height(to)}`;

/** A part of one: `34 %` or `34%`, as the language has it, with so many decimals at most. */
export const percent = (value: number, decimals = 0): string =>
  number(value, { style: "percent", maximumFractionDigits: decimals });

/** A volume: `11.26 mm³`. */
export const volume = (mm3: number): string => `${number(mm3, { maximumSignificantDigits: 4 })}\u00a0mm³`;

/** An amount of resin: `44.4 ml`. */
export const millilitres = (ml: number): string => `${number(ml, { maximumSignificantDigits: 3 })}\u00a0ml`;

/** A time of a machine: `7.6 s`. */
export const seconds = (value: number): string => `${number(value, { maximumFractionDigits: 1 })}\u00a0s`;

/** The area of a section: `123.5 mm²`. */
export const area = (mm2: number): string => `${number(mm2, { maximumFractionDigits: 1 })}\u00a0mm²`;

/** The time of a print, which is known to the minute at best: `2 h 14 min`. */
export function time(seconds: number): string {
  const minutes = Math.round(seconds / 60);
  if (minutes < 1) return "<\u00a01\u00a0min";
  const [hours, rest] = [Math.floor(minutes / 60), `${minutes % 60}\u00a0min`];
  return hours === 0 ? rest : `${count(hours)}\u00a0h\u00a0${rest}`;
}

/** A duration given in ms: `412 ms`, `1.3 s`. */
export function duration(ms: number): string {
  if (ms < 1) return "< 1\u00a0ms";
  if (ms < 995) return `${number(ms, { maximumFractionDigits: 0 })}\u00a0ms`;
  return `${number(ms / 1000, { minimumFractionDigits: 1, maximumFractionDigits: 1 })}\u00a0s`;
}

/** Width × depth × height: `60.0 × 46.5 × 59.5 mm`. */
export const dimensions = (mm: readonly [number, number, number]): string => `${mm.map(size).join(" × ")}\u00a0mm`;

/** A number on an axis. */
export const tick = (value: number): string => number(value, { maximumFractionDigits: 3 });
