/** What somebody should know before the download: what the file is, what the printer makes of it, and what nobody added. */
import type { Language } from "../texts/index.js";
import { isRead, type PrintFile } from "./choice.js";
import type { Result } from "./result.js";

export function fileWords(file: PrintFile, { report }: Pick<Result, "report">, { texts, format: { either } }: Language): string {
  const { file: words } = texts;
  const { format, printer } = file;
  const reading = (): string[] => {
    if (format === "sl1" && report.planner !== "uniform") return [texts.settings.formatUniform];
    if (printer === null) return [];
    if (isRead(file)) return [words.direct(printer.model)];
    // No converter reads the images alone.
    if (format === "png") return [words.unreadable(printer.model)];
    return [words.convert(printer.model, either(printer.reads.map((extension) => `.${extension}`)))];
  };
  return words.together([words.kinds[format], ...reading(), words.asIs]);
}
