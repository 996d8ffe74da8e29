/**
 * Builds the npm package into `dist-package/` and packs it: `npm run package`.
 *
 * The package is self-contained, so it works both from a plain web server and through a bundler. The URLs of the worker and of the
 * WebAssembly module stay as in the source, `new URL("./worker.js", import.meta.url)`, because bundlers look for that form. three.js is in
 * chunks that only the 3-D view loads.
 */
import { execFileSync } from "node:child_process";
import { copyFile, cp, mkdir, readdir, readFile, rm, writeFile } from "node:fs/promises";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { rolldown, type OutputChunk, type Plugin } from "rolldown";
import { anyLanguage } from "./any-language.js";
import { bill, crateParts, noticesOf, npmParts } from "./bill.js";
import { dictionaries } from "./dictionaries.js";
import { reference } from "./reference.js";

const root = fileURLToPath(new URL("..", import.meta.url));
const out = join(root, "dist-package");

/** Maximum size of everything except three.js, gzipped. */
const LIMIT_BYTES = 1_180_000;

const ENTRIES = {
  index: "src/api/index.ts",
  element: "src/element/register.ts",
  "element-class": "src/element/index.ts",
} as const;

/** Built separately as one file, to copy if a bundler does not support workers. */
const WORKER = { worker: "src/api/worker.ts" } as const;

/** Entries that add the element's types to a framework's markup, with the packages that define the markup. */
const FRAMEWORKS = {
  react: ["react", "@types/react"],
  preact: ["preact"],
  solid: ["solid-js"],
  vue: ["vue"],
  svelte: ["svelte"],
} as const;

/** Messages of the page, which is not in the package. */
const PAGE_ROOMS = /^(after|page|print|visit|workbench)\./;

const WASM = "cusp_slicer_bg.wasm";

/** Rewrites URLs for a package whose files are in one folder. */
const flatAddresses: Plugin = {
  name: "cusp:flat-addresses",
  transform: {
    filter: { id: /src\/api\/spawn\.ts$/ },
    handler: (code) => code.replace(`"../../pkg/${WASM}"`, `"./${WASM}"`).replace(`"./worker.ts"`, `"./worker.js"`),
  },
};

/** Provides the globals that lit needs on import, so that a server can import it too. */
const onServers: Plugin = {
  name: "cusp:on-servers",
  transform: {
    filter: { id: /node_modules[\\/](@lit[\\/]reactive-element|lit-html)[\\/]/ },
    handler: (code) => `import { HTMLElement, document } from ${JSON.stringify(join(root, "package/server.ts"))};\n${code}`,
  },
};

/** Loads style sheets as text, which elements adopt. */
const inlineStyles: Plugin = {
  name: "cusp:inline-styles",
  async resolveId(source, importer) {
    if (!source.endsWith("?inline")) return null;
    const resolved = await this.resolve(source.slice(0, -"?inline".length), importer);
    return resolved === null ? null : `${resolved.id}?inline`;
  },
  async load(id) {
    if (!id.endsWith("?inline")) return null;
    const text = await readFile(id.slice(0, -"?inline".length), "utf8");
    return { code: `export default ${JSON.stringify(text)};`, moduleType: "js" };
  },
};

/** lit and three.js store their versions in globals, to warn of a second copy; these do not belong on a host's page. */
const noGlobals: Plugin = {
  name: "cusp:no-globals",
  transform: {
    filter: { id: /node_modules[\\/](@lit|lit-html|lit-element|three)[\\/]/ },
    handler(code) {
      const names = /(?:[\w$]+\.)?\b(litPropertyMetadata|reactiveElementVersions|litHtmlVersions|litElementVersions|__THREE__)\b/g;
      const own = code.replaceAll(names, "OWN.$1");
      return own === code ? null : `const OWN = {};\n${own}`;
    },
  },
};

async function bundle(input: Readonly<Record<string, string>>, isOneFile = false): Promise<readonly OutputChunk[]> {
  const build = await rolldown({
    cwd: root,
    input,
    platform: "browser",
    plugins: [flatAddresses, inlineStyles, noGlobals, anyLanguage, onServers, dictionaries(new URL("..", import.meta.url), PAGE_ROOMS)],
    resolve: { conditionNames: ["production", "browser", "import", "default"] },
    transform: { target: "es2022" },
  });
  const { output } = await build.write({
    dir: out,
    format: "es",
    minify: true,
    entryFileNames: "[name].js",
    chunkFileNames: "[name]-[hash].js",
    codeSplitting: isOneFile ? false : { groups: [{ name: "three", test: /node_modules[\\/]three[\\/]/ }] },
  });
  return output.filter((it) => it.type === "chunk");
}

/** Files imported by the entries, directly or indirectly. */
function loadedAtOnce(chunks: readonly OutputChunk[]): ReadonlySet<string> {
  const loaded = new Set(chunks.filter(({ isEntry }) => isEntry).map(({ fileName }) => fileName));
  // The loop also visits the files that it adds.
  for (const name of loaded) chunks.find(({ fileName }) => fileName === name)?.imports.forEach((file) => loaded.add(file));
  return loaded;
}

/** Writes the declarations. lit is bundled, so a stand-in replaces its types. */
async function declare(): Promise<void> {
  const types = join(out, "types");
  execFileSync(process.execPath, [join(root, "node_modules/typescript/bin/tsc"), "-p", "package/tsconfig.json", "--outDir", types], {
    cwd: root,
    stdio: "inherit",
  });
  const declarations = await readFile(join(root, "pkg/cusp_slicer.d.ts"), "utf8");
  await mkdir(join(types, "pkg"), { recursive: true });
  // The host's type library may not have `Symbol.dispose` yet.
  await writeFile(join(types, "pkg/cusp_slicer.d.ts"), declarations.replaceAll(/^.*\[Symbol\.dispose\].*\n/gm, ""));
  await copyFile(join(root, "package/lit.d.ts"), join(types, "lit.d.ts"));
  await cp(join(root, "package/types"), types, { recursive: true });
  for (const name of await readdir(types, { recursive: true })) {
    if (!name.endsWith(".d.ts")) continue;
    const path = join(types, name);
    const text = await readFile(path, "utf8");
    const lit = relative(dirname(path), join(types, "lit.js")).replaceAll("\\", "/");
    const own = text.replaceAll(/(from |import\()["']lit["']/g, `$1"${lit.startsWith(".") ? lit : `./${lit}`}"`);
    if (own !== text) await writeFile(path, own);
  }
}

/** The guide for readers without the checkout: links to other files lead to this version in the repository, if there is one. */
function withoutFiles(guide: string, repository: string | undefined): string {
  return guide.replaceAll(/\[([^\]]*)\]\(([^)#:][^):]*)\)/g, (_link, text: string, file: string) =>
    repository === undefined ? text : `[${text}](${new URL(file, `${repository}/docs/`).href})`,
  );
}

async function describe(chunks: readonly OutputChunk[]): Promise<void> {
  const { version, license } = JSON.parse(await readFile(join(root, "package.json"), "utf8")) as Record<string, string>;
  const repository = /^repository = "(.*)"$/m.exec(await readFile(join(root, "../Cargo.toml"), "utf8"))?.[1];
  const entry = (types: string, file: string): Record<string, string> => ({
    types: `./types/${types}.d.ts`,
    default: `./${file}.js`,
  });
  // With pnpm and Yarn, a package sees only its declared dependencies, so these let declarations find a framework.
  const peers = Object.values(FRAMEWORKS).flat();
  const description = {
    name: "cusp-slicer",
    version,
    description: "Slices STL models for resin printers in the browser: layers as thin as the surface needs, and no thinner",
    license,
    ...(repository === undefined ? {} : { repository: { type: "git", url: `git+${repository}.git` } }),
    type: "module",
    keywords: ["3d-printing", "slicer", "resin", "stl", "custom-element", "wasm"],
    exports: {
      ".": entry("src/api/index", "index"),
      "./element": entry("src/element/register", "element"),
      "./element-class": entry("src/element/index", "element-class"),
      ...Object.fromEntries(Object.keys(FRAMEWORKS).map((name) => [`./${name}`, entry(name, "element")])),
      "./worker.js": "./worker.js",
      [`./${WASM}`]: `./${WASM}`,
      "./package.json": "./package.json",
    },
    peerDependencies: Object.fromEntries(peers.map((name) => [name, "*"])),
    peerDependenciesMeta: Object.fromEntries(peers.map((name) => [name, { optional: true }])),
    // A bundler may drop an unused import of these two, but no other.
    sideEffects: chunks.map(({ fileName }) => `./${fileName}`).filter((name) => !["./index.js", "./element-class.js"].includes(name)),
  };
  await writeFile(join(out, "package.json"), `${JSON.stringify(description, null, 2)}\n`);
  const guide = await readFile(join(root, "../docs/embed.md"), "utf8");
  await writeFile(join(out, "README.md"), withoutFiles(guide, repository === undefined ? undefined : `${repository}/blob/v${version}`));
  await writeFile(join(out, "REFERENCE.md"), await reference());
  for (const name of ["LICENSE-APACHE", "LICENSE-MIT"]) await copyFile(join(root, "..", name), join(out, name));
}

/** Writes the bill of materials and the notices. */
async function account(chunks: readonly OutputChunk[]): Promise<void> {
  const { name, version, license } = JSON.parse(await readFile(join(out, "package.json"), "utf8")) as { name: string; version: string; license: string };
  const parts = [...(await npmParts(root, chunks)), ...(await crateParts(root, [WASM]))];
  await writeFile(join(out, "sbom.json"), bill({ name, version, license }, parts));
  await writeFile(join(out, "NOTICES.txt"), noticesOf(parts));
}

/** Gzipped size of a browser's download: at first, and additionally with the 3-D view, which is three.js. */
async function weigh(chunks: readonly OutputChunk[]): Promise<Record<"first" | "three", number>> {
  const gzipped = (bytes: string | Uint8Array): number => gzipSync(bytes, { level: 9 }).length;
  const sum = (some: readonly OutputChunk[]): number => some.reduce((total, { code }) => total + gzipped(code), 0);
  const three = sum(chunks.filter(({ name }) => name === "three"));
  return { first: sum(chunks) - three + gzipped(await readFile(join(out, WASM))), three };
}

export async function main(): Promise<void> {
  await rm(out, { recursive: true, force: true });
  const chunks = [...(await bundle(ENTRIES)), ...(await bundle(WORKER, true))];
  const loaded = loadedAtOnce(chunks);
  if (chunks.some(({ name, fileName }) => name === "three" && loaded.has(fileName))) throw new Error("three is loaded before it is needed");
  await copyFile(join(root, "pkg", WASM), join(out, WASM));
  await declare();
  await describe(chunks);
  await account(chunks);
  const { first, three } = await weigh(chunks);
  console.log(`gzipped ${first} bytes, and ${three} of three for the 3-D view`);
  if (first > LIMIT_BYTES) throw new Error(`that is more than ${LIMIT_BYTES} bytes`);
  const packed = execFileSync("npm", ["pack", "--json", "--loglevel=error"], { cwd: out, encoding: "utf8" });
  const [tarball] = JSON.parse(packed) as { filename: string; size: number }[];
  if (tarball === undefined) throw new Error("npm pack made no tarball");
  console.log(`dist-package/${tarball.filename} ${tarball.size} bytes`);
}
