/** Finds the native program that verifies plans. */
import { accessSync, constants } from "node:fs";
import { delimiter, join } from "node:path";
import { fileURLToPath } from "node:url";

const NAME = process.platform === "win32" ? "cusp.exe" : "cusp";

/** Path of the program: from CUSP, else built from this repository, else the first on PATH; null if there is none. */
export function findCusp(): string | null {
  const named = process.env["CUSP"];
  if (named !== undefined && named !== "") return named;
  const built = ["release", "debug"].map((profile) => fileURLToPath(new URL(`../../../target/${profile}/${NAME}`, import.meta.url)));
  const onPath = (process.env["PATH"] ?? "").split(delimiter).map((folder) => join(folder, NAME));
  return [...built, ...onPath].find(isProgram) ?? null;
}

export function isProgram(path: string): boolean {
  try {
    accessSync(path, constants.X_OK);
    return true;
  } catch {
    return false;
  }
}
