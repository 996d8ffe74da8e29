/**
 * The npm package's bill of materials, and the notices of what is bundled into it and into the page: crates, which xtask lists in `pkg/crates.json`, and
 * npm packages, which are those of the bundled files.
 */
import { readdir, readFile } from "node:fs/promises";
import { join } from "node:path";

interface Crate {
  name: string;
  version: string;
  license: string;
  checksum: string;
  files: string[];
  notices: string[];
}

interface Locked {
  version: string;
  license?: string;
  integrity?: string;
  dev?: boolean;
}

/** Something of others that is part of the package. */
export interface Part {
  name: string;
  version: string;
  license: string;
  /** The package URL: the registry, the name and the version. */
  purl: string;
  hash?: { alg: string; content: string };
  /** The package's files that it is in. */
  files: readonly string[];
  notices: readonly string[];
}

/** A file that is made of others. */
export interface Bundled {
  fileName: string;
  moduleIds: readonly string[];
}

/** The npm package that a file belongs to; none if it is our own. */
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
    // Its licence would have been held to the rules for tools.
    if (dev === true) throw new Error(`${name} is bundled, but is a development dependency`);
    const files = chunks.filter(({ moduleIds }) => moduleIds.some((id) => packageOf(id) === name)).map(({ fileName }) => fileName);
    return {
      ...{ name, version, license, files },
      purl: `pkg:npm/${name.replace("@", "%40")}@${version}`,
      hash: { alg: "SHA-512", content: Buffer.from(integrity.replace("sha512-", ""), "base64").toString("hex") },
      notices: await notices(join(root, "node_modules", name)),
    };
  });
  return Promise.all(parts);
}

async function notices(folder: string): Promise<string[]> {
  const names = (await readdir(folder)).filter((name) => /^(licen[cs]e|copying|notice)/i.test(name)).sort();
  return Promise.all(names.map(async (name) => (await readFile(join(folder, name), "utf8")).replaceAll("\r", "").trim()));
}

/** @param only the modules of a package: what is in no other is left out. If absent, all modules, which are the page's */
export async function crateParts(root: string, only?: readonly string[]): Promise<Part[]> {
  const { rustc, crates } = JSON.parse(await readFile(join(root, "pkg/crates.json"), "utf8")) as { rustc: string; crates: Crate[] };
  const files = only ?? [...new Set(crates.flatMap(({ files }) => files))];
  const parts = crates.map(({ name, version, license, checksum, notices, ...crate }): Part => ({
    ...{ name, version, license, notices },
    purl: `pkg:cargo/${name}@${version}`,
    hash: { alg: "SHA-256", content: checksum },
    files: crate.files.filter((file) => files.includes(file)),
  }));
  return [standardLibrary(rustc, files), ...parts.filter((part) => part.files.length > 0)];
}

/** Rust's own, which comes with the compiler. */
function standardLibrary(rustc: string, files: readonly string[]): Part {
  const version = /\d+\.\d+\.\d+/.exec(rustc)?.[0];
  if (version === undefined) throw new Error(`no version in "${rustc}"`);
  const purl = `pkg:generic/rust-std@${version}`;
  return { name: "rust-std", version, license: "MIT OR Apache-2.0", purl, files, notices: ["Copyright (c) The Rust Project Contributors"] };
}

/** The bill as CycloneDX writes it. No time and no serial number: the same package has the same bytes. */
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

/** What licences ask whoever passes the package on to repeat: each text once, below the names of the parts that have it. */
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
