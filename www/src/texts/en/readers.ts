/** Sentences about unreadable models, as in the command line. */
import type { ThreeMfFeature, XmlFault } from "../../api/wire.js";
import type { Format } from "../format.js";
import type { ErrorSentences } from "../sentences.js";

const XML: Readonly<Record<XmlFault, string>> = {
  "cut-short": "it ends before its elements do",
  "not-xml": "it is not XML in UTF-8",
  "wrong-end-tag": "an end tag does not match its start tag",
  attribute: "an attribute is not a name and a value in quotes",
  "long-tag": "a tag is too long",
  deep: "too many elements lie inside each other",
  doctype: "it has a document type, which 3MF forbids",
};

const FEATURES: Readonly<Record<ThreeMfFeature, string>> = {
  "beam-lattice": "a lattice of beams",
  slices: "slices",
  displacement: "displaced facets",
  booleans: "boolean operations",
  volumetric: "volumetric data",
};

export const readers = ({ count }: Pick<Format, "count">) =>
  ({
    "threemf-no-directory": () => "The 3MF file is damaged or cut short: its directory is missing; copy or export it again.",
    "threemf-no-part": ({ part }) => `The 3MF file has no part ${part}; export the model again.`,
    "threemf-damaged-part": ({ part }) => `The part ${part} of the 3MF file is damaged; copy or export it again.`,
    "threemf-packed": ({ part, method }) =>
      `The part ${part} of the 3MF file is packed by method ${count(method)}, encrypted or not; 3MF knows 0 and 8; export the model again.`,
    "threemf-too-large": ({ part, most_bytes }) =>
      `The part ${part} of the 3MF file inflates to more than ${count(most_bytes)} bytes, too much for its size; export the model again.`,
    "threemf-xml": ({ part, line, fault }) => `${part}, line ${count(line)}: ${XML[fault]}; export the model again.`,
    "threemf-bad-attribute": ({ part, line, attribute, found }) =>
      `${part}, line ${count(line)}: \`${found}\` is no value of ${attribute}; export the model again.`,
    "threemf-no-vertex": ({ part, line, vertex, vertices }) =>
      `${part}, line ${count(line)}: there is no vertex ${count(vertex)}: the mesh has ${count(vertices)}, from 0; export the model again.`,
    "threemf-no-object": ({ part, line, object }) =>
      `${part}, line ${count(line)}: there is no object ${count(object)}; export the model again.`,
    "threemf-nested": ({ part, line, object, most_levels }) =>
      `${part}, line ${count(line)}: object ${count(object)} is more than ${count(most_levels)} levels deep, or a part of itself; export the model again.`,
    "threemf-too-many": ({ most_facets }) =>
      `The objects of the 3MF file repeat each other to more than ${count(most_facets)} facets; print fewer copies.`,
    "threemf-overflow": ({ part, object }) => `${part}: object ${count(object)} has coordinates too large to compute; export the model again.`,
    "threemf-feature": ({ part, object, feature }) =>
      `${part}: object ${count(object)} is made of ${FEATURES[feature]}, which Cusp does not read; export the model as a mesh.`,
    "threemf-encrypted": ({ part }) => `${part}: the model is encrypted; export it without encryption.`,
    "threemf-extension": ({ part, extension }) =>
      `${part}: the model requires the extension ${extension}, which Cusp does not know; export it without.`,
    "threemf-no-facets": ({ skipped }) =>
      `The 3MF file has no facets to print: ${count(skipped)} of its objects are supports, surfaces or not to be printed; export the model again.`,
    "obj-bad-vertex": ({ line, found }) =>
      `Line ${count(line)}: a vertex needs three finite numbers, but has \`${found}\`; export the model again.`,
    "obj-bad-corner": ({ line, found, vertices }) =>
      `Line ${count(line)}: \`${found}\` is not the number of a vertex: the file has ${count(vertices)}; export the model again.`,
    "obj-few-corners": ({ line, corners }) =>
      `Line ${count(line)}: a face needs at least three corners, and has ${count(corners)}; export the model again.`,
    "obj-free-form": ({ line, keyword }) =>
      `Line ${count(line)}: \`${keyword}\` is a free-form surface without facets; export the model as polygons.`,
    "obj-too-many": ({ line, most_facets }) =>
      `Line ${count(line)}: the faces come to more than ${count(most_facets)} facets, too many for the size of the file; export the model again.`,
    "obj-no-faces": () => "The OBJ holds no faces; export the model again.",
  }) satisfies Partial<ErrorSentences>;
