/** The line at the download button: the format of the file, the printer's support for it, and the preparation of the model. */
import type { Format, KnownPrinter, Report } from "../../api/wire.js";
import type { Language } from "../../texts/index.js";
import { filled } from "../../texts/messages.js";
import { modelOf, printerOf } from "../state/printer.js";
import type { Result } from "../state/result.js";

/** Menu paths of the first layer's thickness in slicers for filament printers; the same in every language. */
const SETTINGS: Partial<Record<Format, string>> = {
  "prusa-3mf": "Print Settings → Layers and perimeters → First layer height",
  "orca-3mf": "Quality → Layer height → First layer height / Initial layer height",
};

export function fileWords({ report }: Pick<Result, "report">, printers: readonly KnownPrinter[], { texts, format: { either, mm } }: Language): string {
  const { file: words } = texts;
  const { format, extension, is_read_by_printer: isRead, filament } = report.print_file;
  const kinds: Partial<Record<Format, string>> = words.kinds;
  const kind = filled(kinds[format] ?? words.kinds.usual, { extension });
  if (filament !== undefined) {
    const set = words.match({ thickness: mm(filament.first_layer_mm), setting: SETTINGS[format] ?? "" });
    return words.together({ before: kind, next: set });
  }
  const printer = printerOf(report.options.printer, printers);
  const reading = (): string[] => {
    const refused = report.warnings.find(({ code }) => code === "one-thickness");
    if (refused?.code === "one-thickness") return [refused.detail.taker === format ? words.oneInFile : words.onePerPrint({ printer: refused.detail.taker })];
    if (printer === null) return [];
    const model = modelOf(printer);
    if (isRead) return [words.direct({ printer: model })];
    const { reads = [] } = printer;
    // No converter reads a zip of images.
    if (format === "png" || reads.length === 0) return [words.unreadable({ printer: model })];
    return [words.convert({ printer: model, extensions: either(reads.map((extension) => `.${extension}`)) })];
  };
  return [kind, ...reading(), prepared(report, words)].reduce((before, next) => words.together({ before, next }));
}

/** Sentence on the preparation of the models: supports, hollowing, or none. */
function prepared({ models }: Report, words: Language["texts"]["file"]): string {
  const isHollow = models.some(({ hollowed }) => hollowed !== undefined);
  const isSupported = models.some(({ supported }) => supported !== undefined);
  if (!isSupported) return isHollow ? words.hollow : words.asIs;
  return isHollow ? words.hollowSupported : words.supported;
}
