/** Fetches every language, for tests: they ask for texts without waiting. */
import { fetchLanguage, LANGUAGES } from "./index.js";

for (const code of LANGUAGES) await fetchLanguage(code);
