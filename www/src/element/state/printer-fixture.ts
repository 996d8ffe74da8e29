/** A known printer whose fields tests can override. */
import type { KnownPrinter } from "../../api/wire.js";

export const knownPrinter = (patch: Partial<KnownPrinter> & Pick<KnownPrinter, "name">): KnownPrinter => ({
  model: patch.name,
  pixels: [100, 100],
  pitch_um: [50, 50],
  volume_mm: [5, 5, 5],
  is_mirrored: true,
  layer_mm: [0.02, 0.2],
  step_mm: 0.002,
  format: "chitubox",
  is_little_endian: false,
  has_tilting_vat: false,
  reads_format: false,
  reads: ["ctb"],
  variable_layers: "untried",
  variable_layers_source: "",
  compensation: {},
  proportional_greys: false,
  ...patch,
});
