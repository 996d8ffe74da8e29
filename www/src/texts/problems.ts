/** Texts about failures. They are long and rarely needed, so they are fetched with the first failure. */
import { Catalogues } from "./catalogues.js";
import { problems as en, type ProblemTexts } from "./en/problems.js";
import type { Format } from "./format.js";
import type { Language } from "./index.js";

const catalogues = new Catalogues<(format: Format) => ProblemTexts>(en, {
  de: () => import("./de/problems.js").then(({ problems: words }) => ({ words })),
  es: () => import("./es/problems.js").then(({ problems: words }) => ({ words })),
  fr: () => import("./fr/problems.js").then(({ problems: words }) => ({ words })),
  zh: () => import("./zh/problems.js").then(({ problems: words }) => ({ words })),
});

export async function fetchProblemTexts({ code, format }: Language): Promise<ProblemTexts> {
  await catalogues.fetch(code);
  return catalogues.of(code)(format);
}
