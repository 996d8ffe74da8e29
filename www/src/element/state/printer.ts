/** Printers as settings have them: by name, or described. */
import { said, SlicerError } from "../../api/error.js";
import { FORMATS } from "../../api/facts.js";
import type { Format, KnownPrinter, Printer } from "../../api/wire.js";

/** Name of a known printer, description of a custom one, or empty for none. */
export type ChosenPrinter = string | Printer;

/** The longest description that an address carries, as JSON: mail programs and servers cut or refuse very long addresses. */
export const ADDRESS_CHARS = 1500;

/**
 * The chosen printer; null if the name is unknown, or if a field of its description that is shown has the wrong type. In both cases the
 * core refuses it with a reason.
 */
export function printerOf(chosen: ChosenPrinter | undefined, known: readonly KnownPrinter[]): Printer | null {
  if (typeof chosen === "object") return isPrinter(chosen) ? chosen : null;
  return known.find(({ name }) => name === chosen) ?? null;
}

/** Returns true if the fields that are shown have the right types. */
export function isPrinter(value: unknown): value is Printer {
  if (typeof value !== "object" || value === null) return false;
  const { model = "", pixels, pitch_um, volume_mm, layer_mm = [1, 1], format = "png", reads = [] } = value as Record<string, unknown>;
  return (
    typeof model === "string" &&
    areLengths(pixels, 2) &&
    areLengths(pitch_um, 2) &&
    areLengths(volume_mm, 3) &&
    areLengths(layer_mm, 2) &&
    FORMATS.some((it) => it === format) &&
    Array.isArray(reads)
  );
}

function areLengths(value: unknown, count: number): boolean {
  return Array.isArray(value) && value.length === count && value.every((it) => Number.isFinite(it) && it > 0);
}

/** Make and model; defaults to the core's own words. */
export const modelOf = ({ model = "own printer" }: Printer): string => model;

/** Format implied by settings before there is a plan. */
export function formatFor({ printer, format }: { printer: ChosenPrinter; format: Format | "" }, known: readonly KnownPrinter[]): Format {
  return format || (printerOf(printer, known)?.format ?? "png");
}

/** Order of names. */
export const COLLATOR = new Intl.Collator("en", { numeric: true });

/** Maximum size of a description file: a hundred times a full description. */
const MOST_BYTES = 64_000;

/**
 * Reads a printer's description from JSON; its name defaults to that of the file. The core checks the values.
 *
 * @throws SlicerError
 */
export async function readPrinter(file: File): Promise<Printer> {
  const { size: bytes } = file;
  if (bytes > MOST_BYTES) throw new SlicerError("printer-too-long", "the file is too long to describe a printer", { bytes, most_bytes: MOST_BYTES });
  const text = await file.text().catch((cause: unknown) => {
    throw new SlicerError("file-unreadable", said(cause));
  });
  const name = file.name.replace(/\.json$/i, "");
  return { name, model: name, ...parsed(text) };
}

function parsed(text: string): Printer {
  try {
    const value: unknown = JSON.parse(text);
    if (typeof value === "object" && value !== null && !Array.isArray(value)) return value as Printer;
    throw new SyntaxError("it holds no object");
  } catch (error) {
    const system = said(error);
    throw new SlicerError("printer-not-json", `the file does not describe a printer in JSON: ${system}`, { system });
  }
}

/** Text of a printer in a URL; empty if its description has more than `chars` characters. */
export function printerText(chosen: ChosenPrinter, chars = ADDRESS_CHARS): string {
  if (typeof chosen === "string") return chosen;
  const text = JSON.stringify(chosen);
  return text.length > chars ? "" : text;
}

/** Parses the printer of a URL; no name begins with a brace. */
export function printerFrom(text: string): ChosenPrinter {
  if (!text.startsWith("{")) return text;
  try {
    return JSON.parse(text) as Printer;
  } catch {
    return "";
  }
}
