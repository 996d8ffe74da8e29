/** Settings as a file for the command line, `cusp slice --config cusp.toml`: TOML with the core's option names. */
import { check, fromAddress } from "../element/state/settings.js";
import { savedQuery } from "./saved-settings.js";

export const FILE_NAME = "cusp.toml";

/** File for the settings of a query, without those of the model; null if a field is invalid. */
export function settingsFile(query: string): string | null {
  const checked = check(fromAddress(savedQuery(query)));
  if (!checked.ok) return null;
  const lines = Object.entries(checked.options).map(([key, value]) => `${key} = ${toml(value)}\n`);
  return `# Cusp settings. Lengths are in millimetres, times in seconds.\n${lines.join("")}`;
}

/** Formats a value on one line. */
function toml(value: unknown): string {
  if (Array.isArray(value)) return `[${value.map(toml).join(", ")}]`;
  if (typeof value === "object" && value !== null) {
    const fields = Object.entries(value).filter(([, field]) => field !== null && field !== undefined);
    return `{ ${fields.map(([key, field]) => `${key} = ${toml(field)}`).join(", ")} }`;
  }
  // JSON strings, numbers and booleans are also valid TOML, except for one control character.
  return JSON.stringify(value).replaceAll("\u007f", "\\u007f");
}
