/** Fetches all languages, for tests, which need texts synchronously. */
import { fetchLanguage, LANGUAGES } from "./index.js";

for (const code of LANGUAGES) await fetchLanguage(code);
