import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import satisfies from "spdx-satisfies";
import { expect, test } from "vitest";
import { crateParts, linkedCrates, npmParts, packageOf } from "./bill.js";

const root = fileURLToPath(new URL("..", import.meta.url));

/** npm packages for building and testing, which are not shipped, with licences that no other package may have. */
const TOOLS: Readonly<Record<string, string>> = {
  // Used by tests to find accessibility barriers.
  "axe-core": "MPL-2.0",
  // Used by Vite to write styles; a native program per platform.
  lightningcss: "MPL-2.0",
  // Data: browser support, and names of licences.
  "caniuse-lite": "CC-BY-4.0",
  "spdx-exceptions": "CC-BY-3.0",
  "spdx-license-ids": "CC0-1.0",
  "spdx-ranges": "(MIT AND CC-BY-3.0)",
};

interface Locked {
  license?: string | undefined;
  dev?: boolean | undefined;
}

/** Packages of a lock file whose licence is not allowed. */
function refused(packages: Readonly<Record<string, Locked>>, allowed: readonly string[]): string[] {
  return Object.entries(packages).flatMap(([place, { license = "none", dev }]) => {
    const name = place.replace(/.*node_modules\//, "");
    // Native programs are separate packages: `lightningcss-linux-x64-gnu`.
    const isTool = dev === true && Object.entries(TOOLS).some(([tool, own]) => license === own && (name === tool || name.startsWith(`${tool}-`)));
    return isTool || isAllowed(license, allowed) ? [] : [`${name}: ${license}`];
  });
}

function isAllowed(license: string, allowed: readonly string[]): boolean {
  try {
    return satisfies(license, [...allowed]);
  } catch {
    return false;
  }
}

test("every npm package has a licence that deny.toml allows crates", async () => {
  const rules = /allow = \[([^\]]*)\]/.exec(await readFile(`${root}/../deny.toml`, "utf8"))?.[1] ?? "";
  const allowed = [...rules.matchAll(/"([^"]*)"/g)].map(([, name = ""]) => name);
  const { packages } = JSON.parse(await readFile(`${root}/package-lock.json`, "utf8")) as { packages: Record<string, Locked> };
  expect(Object.keys(packages).length).toBeGreaterThan(50);
  expect(refused(packages, allowed)).toEqual([]);
});

test("a copyleft, an unknown and a missing licence are refused, and a tool's alone is excepted", () => {
  const of = (name: string, license?: string, dev?: boolean): string[] => refused({ [`node_modules/a/node_modules/${name}`]: { license, dev } }, ["MIT", "Apache-2.0"]);
  for (const fine of ["MIT", "MIT OR GPL-3.0-only", "(MIT AND Apache-2.0)"]) expect(of("one", fine), fine).toEqual([]);
  for (const bad of ["GPL-3.0-only", "MIT AND GPL-3.0-only", "SEE LICENSE IN file", "UNLICENSED", undefined]) expect(of("one", bad, true), bad).toHaveLength(1);
  expect(of("lightningcss-linux-x64-gnu", "MPL-2.0", true)).toEqual([]);
  expect(of("lightningcss", "MPL-2.0")).toHaveLength(1);
  expect(of("lightningcssx", "MPL-2.0", true)).toHaveLength(1);
});

test("the bill names the crates of others that a module links, with checksums and texts", async () => {
  const tree = "cusp-wasm v0.1.0 (/some where/cusp)\nserde v1.0.229\nserde v1.0.229 (*)\ncusp-slicer v0.1.0 (/cusp) (*)\n";
  expect([...linkedCrates(tree)]).toEqual(["serde 1.0.229"]);
  const [std, ...parts] = await crateParts(root);
  expect(std?.name).toBe("rust-std");
  const names = parts.map(({ name }) => name);
  expect(names).toContain("glam");
  expect(names).not.toContain("cusp-slicer");
  for (const { name, hash, notices } of parts) {
    expect(hash?.content, name).toMatch(/^[0-9a-f]{64}$/);
    expect(notices.every((text) => text !== ""), name).toBe(true);
  }
  expect((await crateParts(root, ["cusp_slicer_bg.wasm"]))[1]?.files).toEqual(["cusp_slicer_bg.wasm"]);
});

test("a tool is not bundled unnoticed", async () => {
  const bundled = [{ fileName: "index.js", moduleIds: [join(root, "node_modules/axe-core/axe.js")] }];
  await expect(npmParts(root, bundled)).rejects.toThrow("axe-core is bundled, but is a development dependency");
});

test("the package of a file is the innermost", () => {
  expect(packageOf("/a/node_modules/@lit/reactive-element/x.js")).toBe("@lit/reactive-element");
  expect(packageOf("C:\\a\\node_modules\\one\\node_modules\\two\\x.js")).toBe("two");
  expect(packageOf("/a/src/api/index.ts")).toBeUndefined();
});
