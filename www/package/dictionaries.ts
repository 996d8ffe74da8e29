/** Divides dictionaries for a build, and stops it if one does not fit the English messages. */
import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { runnerImport, type Plugin } from "vite";

/** Messages of rooms that are fetched on demand. */
const REST = /^(after|bridges|check|errors|headings|infeasible|names|nouns|orientation|own|page\.notices|painting|placing|print|towers|visit|warnings)\.|^view\.(?!region|title)|^details\.(?!ran|cpu|gpu|methods)|^mask\.(?!region|said)|^plate\.(title|remove|spacing|turn|step|plate|previous|next|each|whole|all|others|moved)|^settings\.(bottom|contact|flats|least|lift|overcure|penetration|pillar|raft|retained|step|support[A-Z])/;
const IMPORT = /(first|rest): \(\) => import\("\.\/(\w+)\.json"\)/g;
const PART = /^\0dictionary\/(\w+)-(first|rest)$/;

/**
 * A plugin for the dictionaries of a checkout whose `www/` is at `root`.
 *
 * @param without keys that this build does not need
 */
export function dictionaries(root: URL, without = /^$/): Plugin {
  const read = (code: string): Record<string, string> => JSON.parse(readFileSync(new URL(fileOf(code), root), "utf8")) as Record<string, string>;
  return {
    name: "cusp:dictionaries",
    apply: "build",
    // Before others rewrite the imports.
    enforce: "pre",
    async buildStart() {
      const checks = fileURLToPath(new URL("src/texts/check.ts", root));
      const { LANGUAGES, faultsOf, untranslated } = (await runnerImport<typeof import("../src/texts/check.js")>(checks)).module;
      const faults = LANGUAGES.filter((code) => code !== "en").flatMap((code) => {
        const dictionary = read(code);
        const missing = untranslated(dictionary);
        if (missing.length > 0) this.info(`${fileOf(code)}: ${missing.length} messages are not translated, such as ${missing[0]}`);
        return faultsOf(fileOf(code), dictionary);
      });
      if (faults.length > 0) this.error(faults.join("\n"));
    },
    transform: {
      filter: { id: /src[\\/]texts[\\/]index\.ts$/ },
      handler(code) {
        const divided = code.replaceAll(IMPORT, '$1: () => import("\\0dictionary/$2-$1")');
        if (divided === code) this.error("the dictionaries are imported otherwise");
        return divided;
      },
    },
    resolveId: (source) => (PART.test(source) ? source : null),
    load(id) {
      const [, code, part] = PART.exec(id) ?? [];
      if (code === undefined) return null;
      const messages = Object.entries(read(code)).filter(([key]) => REST.test(key) === (part === "rest") && !without.test(key));
      return { code: `export default ${JSON.stringify(Object.fromEntries(messages))};`, moduleType: "js" };
    },
  };
}

const fileOf = (code: string): string => `src/texts/${code}.json`;
