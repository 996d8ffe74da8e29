/** Number formats of the shop. */

const MONEY = new Intl.NumberFormat("en-IE", { style: "currency", currency: "EUR" });
const NUMBER = new Intl.NumberFormat("en-IE");
const MILLILITRES = new Intl.NumberFormat("en-IE", { maximumFractionDigits: 1, minimumFractionDigits: 1 });

const MINUTE_S = 60;
const HOUR_MINUTES = 60;

/** An amount in whole cents, like all prices of the shop. */
export const money = (cents: number): string => MONEY.format(cents / 100);

export const number = (value: number): string => NUMBER.format(value);

export const millilitres = (ml: number): string => `${MILLILITRES.format(ml)} ml`;

/** Seconds as `4 h 12 min`, rounded as in the element, so that a print has the same time everywhere on the page. */
export function time(seconds: number): string {
  const minutes = Math.round(seconds / MINUTE_S);
  if (minutes < 1) return "<\u00a01\u00a0min";
  const [hours, rest] = [Math.floor(minutes / HOUR_MINUTES), `${minutes % HOUR_MINUTES}\u00a0min`];
  return hours === 0 ? rest : `${number(hours)}\u00a0h\u00a0${rest}`;
}
