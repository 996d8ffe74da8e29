/** The npm package's bill of materials, and the notices of package and page. */
import { existsSync } from "node:fs";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { expect, test } from "vitest";
import { builtPackage } from "./built.js";
import { www } from "./package-apps.js";

interface Component {
  purl: string;
  licenses: { expression: string }[];
  evidence: { occurrences: { location: string }[] };
}

test("the bill names what is bundled, where it is, and the notices repeat the licences", async () => {
  const packed = await builtPackage();
  const read = (file: string): Promise<string> => readFile(join(packed, file), "utf8");
  const { components } = JSON.parse(await read("sbom.json")) as { components: Component[] };
  const files = (name: string): string[] => components.filter(({ purl }) => purl.startsWith(`pkg:${name}@`)).flatMap(({ evidence }) => evidence.occurrences.map(({ location }) => location));
  expect(files("npm/three")).toEqual([expect.stringMatching(/^three-.*\.js$/)]);
  expect(files("npm/comlink")).toContain("worker.js");
  expect(files("cargo/glam")).toContain("cusp_slicer_bg.wasm");
  expect(files("cargo/wgpu")).not.toEqual([]);
  expect(components.filter(({ evidence }) => !evidence.occurrences.every(({ location }) => existsSync(join(packed, location))))).toEqual([]);
  const notices = await read("NOTICES.txt");
  expect(notices).toContain("Copyright (c) 2017 Google LLC");
  for (const { purl } of components) expect(notices).toContain(decodeURIComponent(purl).replace(/^pkg:[a-z]+\/(.*)@/, "$1 "));
});

test("the page has the notices of its own modules too, and keeps none of them for later", async () => {
  const read = (file: string): Promise<string> => readFile(join(www, "dist", file), "utf8");
  const notices = await read("NOTICES.txt");
  for (const part of ["lit 3.", "three 0.", "comlink 4.", "uplot 1.", "wgpu 3", "png 0.", "zip "]) expect(notices).toContain(part);
  expect(await read("service-worker.js")).not.toContain("NOTICES");
});
