/** The line at the download button: what the file is, whether the printer reads it, and that the model prints as it is. */
import type { KnownPrinter } from "../../api/wire.js";
import type { Language } from "../../texts/index.js";
import { modelOf, printerOf } from "../state/printer.js";
import type { Result } from "../state/result.js";

export function fileWords({ report }: Pick<Result, "report">, printers: readonly KnownPrinter[], { texts, format: { either } }: Language): string {
  const { file: words } = texts;
  const { format, extension, is_read_by_printer: isRead } = report.print_file;
  const printer = printerOf(report.options.printer, printers);
  const reading = (): string[] => {
    const refused = report.warnings.find(({ code }) => code === "one-thickness");
    if (refused?.code === "one-thickness") return [refused.detail.taker === format ? words.oneInFile : words.onePerPrint(refused.detail.taker)];
    if (printer === null) return [];
    const model = modelOf(printer);
    if (isRead) return [words.direct(model)];
    const { reads = [] } = printer;
    // No converter reads a zip of images alone.
    if (format === "png" || reads.length === 0) return [words.unreadable(model)];
    return [words.convert(model, either(reads.map((extension) => `.${extension}`)))];
  };
  return words.together([words.kinds[format](extension), ...reading(), words.asIs]);
}
