/** Builds the shop's page, and missing Rust parts. */
import { spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { build } from "vite";
import { findCusp } from "./cusp.js";

const at = (path: string): string => fileURLToPath(new URL(path, import.meta.url));

/** Builds the page and returns its folder. */
export async function buildPage(): Promise<string> {
  await build({ configFile: at("vite.config.ts"), logLevel: "error" });
  return at("dist");
}

/** Builds the element's WebAssembly package and the program that verifies plans, and returns the path of the latter. */
export function buildCore(): string {
  if (!existsSync(at("../../pkg/cusp_slicer.js"))) cargo("xtask", "build");
  if (findCusp() === null) cargo("build", "--release", "--bin", "cusp");
  const cusp = findCusp();
  if (cusp === null) throw new Error("there is no program `cusp`: name it in the variable CUSP");
  // Fails now rather than at the first order.
  const { status } = spawnSync(cusp, ["verify", "--help"], { stdio: "ignore" });
  if (status !== 0) throw new Error(`${cusp} cannot verify plans: build it anew by \`cargo build --release --bin cusp\``);
  return cusp;
}

function cargo(...call: string[]): void {
  console.log(`cargo ${call.join(" ")}`);
  const { error, status } = spawnSync("cargo", call, { cwd: at("../../.."), stdio: "inherit" });
  if (error !== undefined) throw new Error(`cargo could not be run (${error.message}): install Rust, or build www/pkg and cusp elsewhere`);
  if (status !== 0) throw new Error(`cargo ${call.join(" ")} failed`);
}
