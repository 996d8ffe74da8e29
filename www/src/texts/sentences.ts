/** Types of the catalogues' sentences: one for each code of a failure or warning, made from its details. */
import type { ErrorCode, ErrorDetails } from "../api/error.js";
import type { WarningCode, WarningDetails } from "../api/warning.js";
import type { FileKind, GpuFault, Metric, Quantity, StlExpected, Work } from "../api/wire.js";

/** The compiler requires every code in every catalogue. `metric` is that of tolerances without a unit. */
export type ErrorSentences = { readonly [Code in ErrorCode]: (detail: ErrorDetails[Code], metric: Metric) => string };
export type WarningSentences = { readonly [Code in WarningCode]: (detail: WarningDetails[Code]) => string };

/** Nouns with their article, as at the beginning of a sentence. */
export type QuantityNouns = Readonly<Record<Quantity, string>>;
export type GpuFaults = Readonly<Record<GpuFault, string>>;
/** Slow work as the subject of a sentence, and the advice as its end. */
export type WorkWords = Readonly<Record<Work, readonly [subject: string, way: string]>>;
export type StlNouns = Readonly<Record<StlExpected, string>>;

/** Names of the kinds of file, the same in every language. */
export const FILE_KINDS: Readonly<Record<FileKind, string>> = {
  ...{ amf: "AMF", ply: "PLY", step: "STEP", gltf: "glTF" },
  ...{ zip: "zip", gzip: "gzip", html: "HTML" },
  ...{ png: "PNG", jpeg: "JPEG", pdf: "PDF", dxf: "DXF" },
};

/** Keywords of text STL files, the same in every language. */
export const STL_KEYWORDS = {
  solid: "`solid`",
  normal: "`normal`",
  "outer-loop": "`outer loop`",
  vertex: "`vertex`",
  endloop: "`endloop`",
  endfacet: "`endfacet`",
} as const;

/** Prefix that the core's bindings add to a message of the parser. */
const BORDER = /^Failed to deserialize JsValue into type `[^`]*`: (Error: )?/;

/** A system message as the end of a sentence: it may already have a full stop. */
export function ended(system: string): string {
  const said = system.replace(BORDER, "").trim();
  return /[.!?。！？]$/.test(said) ? said : `${said}.`;
}

/** A sentence with the noun for a flat kind of file; null for other kinds. */
export function flatKind<T>(kind: FileKind, nouns: { picture: T; document: T; drawing: T }, sentence: (noun: T) => string): string | null {
  if (kind === "png" || kind === "jpeg") return sentence(nouns.picture);
  if (kind === "pdf") return sentence(nouns.document);
  return kind === "dxf" ? sentence(nouns.drawing) : null;
}

/** Selects the advice on a file of another kind. */
export function adviceOn<T>(kind: FileKind, advice: { packed: T; page: T; model: T }): T {
  if (kind === "html") return advice.page;
  return kind === "zip" || kind === "gzip" ? advice.packed : advice.model;
}
