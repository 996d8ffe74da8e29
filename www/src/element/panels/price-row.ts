/** Price of a result by the page's prices. */
import { html, nothing, type TemplateResult } from "lit";
import type { Price } from "../../api/wire.js";
import type { Language } from "../../texts/index.js";

/** The total in the language's format, with the core's number of decimals: some browsers have other ones. */
const money = ({ currency, digits, total }: Price, locale: string): string =>
  new Intl.NumberFormat(locale, { style: "currency", currency, minimumFractionDigits: digits, maximumFractionDigits: digits }).format(total / 10 ** digits);

export function priceRow(price: Price | null, { texts, format }: Language): TemplateResult | typeof nothing {
  return price === null ? nothing : html`<p class="price">${texts.plan.price} <strong>${money(price, format.locale)}</strong></p>`;
}
