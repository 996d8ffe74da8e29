/** Fetches all languages, for tests, which need texts synchronously. */
import { fetchLanguage, fetchRest, LANGUAGES } from "./index.js";

await fetchRest();
for (const code of LANGUAGES) await fetchLanguage(code);
