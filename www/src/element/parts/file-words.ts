/** The line at the download button: what the file is, whether the printer reads it, and that the model prints as it is. */
import type { Printer } from "../../api/wire.js";
import type { Language } from "../../texts/index.js";
import type { Result } from "../state/result.js";

export function fileWords({ report }: Pick<Result, "report">, printers: readonly Printer[], { texts, format: { either } }: Language): string {
  const { file: words } = texts;
  const { format, is_read_by_printer: isRead } = report.print_file;
  const printer = printers.find(({ name }) => name === report.printer);
  const reading = (): string[] => {
    if (format === "sl1" && report.planner !== "uniform") return [texts.settings.formatUniform];
    if (printer === undefined) return [];
    if (isRead) return [words.direct(printer.model)];
    // No converter reads a zip of images alone.
    if (format === "png") return [words.unreadable(printer.model)];
    return [words.convert(printer.model, either(printer.reads.map((extension) => `.${extension}`)))];
  };
  return words.together([words.kinds[format], ...reading(), words.asIs]);
}
