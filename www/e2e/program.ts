/** Finds programs for tests. */
import { delimiter, join } from "node:path";
import { isProgram } from "../examples/shop/cusp.js";

/** Folders of system programs, which are not always on PATH. */
const FOLDERS = ["/usr/sbin", "/usr/local/sbin"];

/** Path of the program named by a variable, or the first of its usual names that exists; null if there is none. */
export function program(names: readonly string[], variable?: string): string | null {
  const named = variable === undefined ? undefined : process.env[variable];
  if (named !== undefined && named !== "") return named;
  const folders = [...(process.env["PATH"] ?? "").split(delimiter), ...FOLDERS];
  return names.flatMap((name) => folders.map((folder) => join(folder, name))).find(isProgram) ?? null;
}
