/** Figures as this shop writes them. */

const MONEY = new Intl.NumberFormat("en-IE", { style: "currency", currency: "EUR" });
const NUMBER = new Intl.NumberFormat("en-IE");
const MILLILITRES = new Intl.NumberFormat("en-IE", { maximumFractionDigits: 1, minimumFractionDigits: 1 });

const MINUTE_S = 60;
const HOUR_MINUTES = 60;

export const money = (cents: number): string => MONEY.format(cents / 100);

export const number = (value: number): string => NUMBER.format(value);

export const millilitres = (ml: number): string => `${MILLILITRES.format(ml)} ml`;

/** Seconds as `4 h 12 min`. */
export function time(seconds: number): string {
  const minutes = Math.ceil(seconds / MINUTE_S);
  const hours = Math.floor(minutes / HOUR_MINUTES);
  return hours === 0 ? `${minutes} min` : `${hours} h ${minutes % HOUR_MINUTES} min`;
}
