/** Sentences about unreadable models, as in the command line. */
import type { ThreeMfFeature, XmlFault } from "../api/wire.js";

export const readers = {
  "threemf-no-directory": "The 3MF file is damaged or cut short: its directory is missing; copy or export it again.",
  "threemf-no-part": "The 3MF file has no part {part}; export the model again.",
  "threemf-damaged-part": "The part {part} of the 3MF file is damaged; copy or export it again.",
  "threemf-packed": "The part {part} of the 3MF file is encrypted or packed by method {method|count}; 3MF allows methods 0 and 8, unencrypted; export the model again.",
  "threemf-too-large": "The part {part} of the 3MF file inflates to more than {most_bytes|count} bytes, too much for its size; export the model again.",
  "threemf-xml": "{part}, line {line|count}: {fault|names.xml}; export the model again.",
  "threemf-bad-attribute": "{part}, line {line|count}: `{found}` is no value of {attribute}; export the model again.",
  "threemf-no-vertex": "{part}, line {line|count}: there is no vertex {vertex|count}: the mesh has {vertices|count}, from 0; export the model again.",
  "threemf-no-object": "{part}, line {line|count}: there is no object {object|count}; export the model again.",
  "threemf-nested": "{part}, line {line|count}: object {object|count} is more than {most_levels|count} levels deep, or a part of itself; export the model again.",
  "threemf-too-many": "The objects of the 3MF file repeat each other to more than {most_facets|count} facets; print fewer copies.",
  "threemf-overflow": "{part}: object {object|count} has coordinates too large to compute; export the model again.",
  "threemf-feature": "{part}: object {object|count} is made of {feature|names.features}, which Cusp does not read; export the model as a mesh.",
  "threemf-encrypted": "{part}: the model is encrypted; export it without encryption.",
  "threemf-extension": "{part}: the model requires the extension {extension}, which Cusp does not know; export it without.",
  "threemf-no-facets": "The 3MF file has no facets to print: {skipped|count} of its objects are supports, surfaces or not to be printed; export the model again.",
  "obj-bad-vertex": "Line {line|count}: a vertex needs three finite numbers, but has `{found}`; export the model again.",
  "obj-bad-corner": "Line {line|count}: `{found}` is not the number of a vertex: the file has {vertices|count}; export the model again.",
  "obj-few-corners": "Line {line|count}: a face needs at least three corners, and has {corners|count}; export the model again.",
  "obj-free-form": "Line {line|count}: `{keyword}` is a free-form surface without facets; export the model as polygons.",
  "obj-too-many": "Line {line|count}: the faces come to more than {most_facets|count} facets, too many for the size of the file; export the model again.",
  "obj-no-faces": "The OBJ holds no faces; export the model again.",
} as const;

export const readerNames = {
  xml: {
    "cut-short": "it ends before its elements do",
    "not-xml": "it is not XML in UTF-8",
    "wrong-end-tag": "an end tag does not match its start tag",
    attribute: "an attribute is not a name and a value in quotes",
    "long-tag": "a tag is too long",
    deep: "too many elements lie inside each other",
    doctype: "it has a document type, which 3MF forbids",
  },
  features: {
    "beam-lattice": "a lattice of beams",
    slices: "slices",
    displacement: "displaced facets",
    booleans: "boolean operations",
    volumetric: "volumetric data",
  },
} as const satisfies { xml: Record<XmlFault, string>; features: Record<ThreeMfFeature, string> };
