/** Finds programs that tests run. */
import { delimiter, join } from "node:path";
import { isProgram } from "../examples/shop/cusp.js";

/** Folders of programs for administrators, which are not always on PATH. */
const FOLDERS = ["/usr/sbin", "/usr/local/sbin"];

/** The program that a variable names, or the first of its usual names that is there; null if there is none. */
export function program(names: readonly string[], variable?: string): string | null {
  const named = variable === undefined ? undefined : process.env[variable];
  if (named !== undefined && named !== "") return named;
  const folders = [...(process.env["PATH"] ?? "").split(delimiter), ...FOLDERS];
  return names.flatMap((name) => folders.map((folder) => join(folder, name))).find(isProgram) ?? null;
}
