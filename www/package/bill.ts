/**
 * The npm package's bill of materials, and the notices for code bundled into it and into the page: crates as listed by cargo, and npm
 * packages of the bundled files.
 */
import { execFileSync } from "node:child_process";
import { readdir, readFile } from "node:fs/promises";
import { dirname, join } from "node:path";

/** The WebAssembly modules, with the features of `wasm/` that each is built with. */
const MODULES: Readonly<Record<string, readonly string[]>> = {
  "cusp_slicer_bg.wasm": [],
  "cusp_reader_bg.wasm": ["--features", "reader"],
};

/** A package as `cargo metadata` describes it. */
interface Crate {
  name: string;
  version: string;
  license: string | null;
  manifest_path: string;
}

interface Locked {
  version: string;
  license?: string;
  integrity?: string;
  dev?: boolean;
}

/** A third-party component of the package. */
export interface Part {
  name: string;
  version: string;
  license: string;
  /** The package URL: the registry, the name and the version. */
  purl: string;
  hash?: { alg: string; content: string };
  /** Files of the package that contain it. */
  files: readonly string[];
  notices: readonly string[];
}

/** A bundled file with the modules in it. */
export interface Bundled {
  fileName: string;
  moduleIds: readonly string[];
}

/** npm package of a file; undefined for our own files. */
export function packageOf(file: string): string | undefined {
  return /.*node_modules[\\/]((?:@[^\\/]+[\\/])?[^\\/]+)/.exec(file)?.[1]?.replace("\\", "/");
}

/** @param root the folder of `package-lock.json` */
export async function npmParts(root: string, chunks: readonly Bundled[]): Promise<Part[]> {
  const { packages } = JSON.parse(await readFile(join(root, "package-lock.json"), "utf8")) as { packages: Record<string, Locked> };
  const names = new Set(chunks.flatMap(({ moduleIds }) => moduleIds.flatMap((id) => packageOf(id) ?? [])));
  const parts = [...names].sort().map(async (name): Promise<Part> => {
    const { version, license, integrity, dev } = packages[`node_modules/${name}`] ?? {};
    if (version === undefined || license === undefined || integrity === undefined) throw new Error(`the lock file does not describe ${name}`);
    // Its licence would have been checked by the rules for tools.
    if (dev === true) throw new Error(`${name} is bundled, but is a development dependency`);
    const files = chunks.filter(({ moduleIds }) => moduleIds.some((id) => packageOf(id) === name)).map(({ fileName }) => fileName);
    return {
      ...{ name, version, license, files },
      purl: `pkg:npm/${name.replace("@", "%40")}@${version}`,
      hash: { alg: "SHA-512", content: Buffer.from(integrity.replace("sha512-", ""), "base64").toString("hex") },
      notices: await notices(join(root, "node_modules", name), ""),
    };
  });
  return Promise.all(parts);
}

/** Names of files with notices that licences require to be passed on. */
const NOTICE = /^(licen[cs]e|copying|copyright|notice|unlicense)/i;
/** Licence files of a crate for alternatives to MIT. */
const OTHER_LICENCE = /apache|zlib|unlicense|0bsd/i;

/** Notices that must be repeated by everyone who ships a package. If the licence is a choice that includes MIT, only MIT's. */
async function notices(folder: string, license: string): Promise<string[]> {
  const entries = await readdir(folder, { withFileTypes: true });
  const all = entries.filter((entry) => entry.isFile() && NOTICE.test(entry.name)).map(({ name }) => name).sort();
  const isChoice = license.includes(" OR ") && all.some((name) => /mit/i.test(name));
  const names = isChoice ? all.filter((name) => !OTHER_LICENCE.test(name)) : all;
  return Promise.all(names.map(async (name) => (await readFile(join(folder, name), "utf8")).replaceAll("\r", "").trim()));
}

/** @param files the modules of a package; by default all, as in the page */
export async function crateParts(root: string, files: readonly string[] = Object.keys(MODULES)): Promise<Part[]> {
  const cargo = (...given: string[]): string => execFileSync("cargo", given, { cwd: join(root, ".."), encoding: "utf8", maxBuffer: 1 << 26 });
  const linked = new Map(files.map((file) => [file, linkedCrates(cargo(...TREE, ...(MODULES[file] ?? [])))]));
  const { packages } = JSON.parse(cargo("metadata", "--locked", "--format-version", "1", "--filter-platform", TARGET)) as { packages: Crate[] };
  const lock = await readFile(join(root, "../Cargo.lock"), "utf8");
  const found = packages.map(async ({ name, version, license, manifest_path }): Promise<Part | null> => {
    const own = files.filter((file) => linked.get(file)?.has(`${name} ${version}`));
    if (own.length === 0) return null;
    const checksum = new RegExp(`^name = "${name}"\nversion = "${version.replaceAll(".", "\\.")}"\nsource = .*\nchecksum = "(.*)"`, "m").exec(lock)?.[1];
    if (license === null || checksum === undefined) throw new Error(`cargo knows no licence or no checksum of ${name} ${version}`);
    // Notation of a choice in older manifests.
    const expression = license.replaceAll("/", " OR ");
    return {
      ...{ name, version, license: expression, files: own },
      purl: `pkg:cargo/${name}@${version}`,
      hash: { alg: "SHA-256", content: checksum },
      notices: await notices(dirname(manifest_path), expression),
    };
  });
  const parts = (await Promise.all(found)).filter((part) => part !== null);
  if (parts.length === 0) throw new Error("cargo tree names no crates");
  return [standardLibrary(execFileSync("rustc", ["--version"], { cwd: join(root, ".."), encoding: "utf8" }), files), ...parts];
}

const TARGET = "wasm32-unknown-unknown";
const TREE = ["tree", "--locked", "--target", TARGET, "--package", "cusp-wasm", "--edges", "normal,no-proc-macro", "--prefix", "none", "--format", "{p}"];

/** Names and versions of third-party crates in the output of `cargo tree`, where our own are followed by their folders. */
export function linkedCrates(tree: string): ReadonlySet<string> {
  return new Set(tree.split("\n").flatMap((line) => /^(\S+) v(\S+)(?: \(\*\))?$/.exec(line)?.slice(1).join(" ") ?? []));
}

/** Rust's standard library, which comes with the compiler. */
function standardLibrary(rustc: string, files: readonly string[]): Part {
  const version = /\d+\.\d+\.\d+/.exec(rustc)?.[0];
  if (version === undefined) throw new Error(`no version in "${rustc}"`);
  const purl = `pkg:generic/rust-std@${version}`;
  return { name: "rust-std", version, license: "MIT OR Apache-2.0", purl, files, notices: ["Copyright (c) The Rust Project Contributors"] };
}

/** The bill in CycloneDX. Without time and serial number, so that the same package has the same bytes. */
export function bill(own: { name: string; version: string; license: string }, parts: readonly Part[]): string {
  const component = ({ name, version, license, purl, hash, files }: Part): object => ({
    ...{ type: "library", name, version, purl },
    licenses: [{ expression: license }],
    ...(hash === undefined ? {} : { hashes: [hash] }),
    evidence: { occurrences: files.map((location) => ({ location })) },
  });
  const { license, ...rest } = own;
  const metadata = { component: { type: "library", ...rest, purl: `pkg:npm/${own.name}@${own.version}`, licenses: [{ expression: license }] } };
  return JSON.stringify({ bomFormat: "CycloneDX", specVersion: "1.6", version: 1, metadata, components: parts.map(component) });
}

/** Notices to repeat by everyone who passes the package on: each text once, below the names of its components. */
export function noticesOf(parts: readonly Part[]): string {
  const byText = new Map<string, string[]>();
  for (const { name, version, license, notices } of parts) {
    for (const text of notices.length > 0 ? notices : [`(no text in its package; ${license})`]) {
      byText.set(text, [...(byText.get(text) ?? []), `${name} ${version}`]);
    }
  }
  const sections = [...byText].map(([text, names]) => `${names.join(", ")}\n\n${text}\n`);
  return ["Cusp contains the following, under the licences of their authors.\n", ...sections].join(`\n${"-".repeat(80)}\n\n`);
}
