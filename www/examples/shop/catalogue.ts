/** The shop's catalogue, and its rules for plans. The page offers it; the server checks every order against it. */
import type { Limits, Prices, Resin } from "cusp-slicer";

/** A resin with every value that determines print time and exposure, so that a plan cannot set its own. */
export interface ShopResin extends Required<Omit<Resin, "print_through">> {
  /** Description for customers: the resin's use. */
  note: string;
  /** CSS class of its swatch. */
  swatch: string;
  ml_cents: number;
}

export interface ShopPrinter {
  /** Name as listed by `cusp printers`. */
  name: string;
  title: string;
  note: string;
  hour_cents: number;
}

/** Values common to all resins: the shop has one kind of vat and one way to move the plate. */
const SHARED = {
  exposures: [],
  layer_mm: 0.05,
  bottom_layers: 4,
  wait_s: 1,
  lift_mm: 5,
  lift_mm_min: 65,
  return_mm_min: 150,
  compensation: { xy_mm: 0, bottom_xy_mm: 0, faded_layers: 0, z_mm: 0 },
};

export const RESINS: readonly ShopResin[] = [
  { ...SHARED, name: "Stone grey", exposure_s: 2.5, bottom_exposure_s: 25, penetration_mm: 0.15, density_g_ml: 1.1, note: "Sharp detail, matt", swatch: "stone", ml_cents: 24 },
  { ...SHARED, name: "Tough black", exposure_s: 3.2, bottom_exposure_s: 32, penetration_mm: 0.13, density_g_ml: 1.13, note: "For parts that bend", swatch: "tough", ml_cents: 38 },
  { ...SHARED, name: "Clear", exposure_s: 2, bottom_exposure_s: 22, penetration_mm: 0.19, density_g_ml: 1.12, note: "Lets light through", swatch: "clear", ml_cents: 32 },
];

export const PRINTERS: readonly ShopPrinter[] = [
  { name: "mars-4-ultra", title: "Fine", note: "18 µm pixels, 153 × 77 × 165 mm", hour_cents: 320 },
  { name: "saturn-3-ultra", title: "Large", note: "24 µm pixels, 218 × 122 × 260 mm", hour_cents: 410 },
];

/** Prices of a resin on a printer, for the formula in docs/price.md. Taxes are included. */
export function pricesOf(printer: ShopPrinter, resin: ShopResin): Prices {
  return {
    currency: "EUR",
    setup: 450,
    machine_per_h: printer.hour_cents,
    resin_per_ml: resin.ml_cents,
    quantity_breaks: [
      { copies: 5, discount: 0.05 },
      { copies: 10, discount: 0.1 },
    ],
    minimum: 900,
  };
}

/** Limits by which the shop prints a model unchanged, reviews it, or refuses it (docs/printability.md). Omitted ones have the defaults. */
export const LIMITS: Limits = {
  wall_mm: 0.5,
  cup_mm2: 25,
  severity: { trap: "reject", "loose-body": "reject" },
};

export const MOST_COPIES = 20;

/** Range that a customer may choose from, mm. */
export const TOLERANCE_MM = { least: 0.01, most: 0.15 };
export const HEIGHT_MM = { least: 5, most: 260 };

/** Options decided by the shop alone: the sampling density, which determines the cost of checking a plan, and the planning method. */
export const FIXED = {
  rays: 2048,
  antialias: 1,
  layer_min_mm: 0.05,
  layer_max_mm: 0.15,
  thicknesses_mm: [],
  ranges: [],
  planes_mm: [],
  snap: "auto",
  flat_area_mm2: 1,
  metric: "cusp",
  source: "exact",
  saliency: false,
  weight_min: 0.25,
  planner: { kind: "optimal" },
  minimize: "layers",
  backend: "auto",
  gpu_method: "auto",
} as const;

/** Maximum file sizes, in bytes. A plan is JSON, a model an STL of about a million facets. */
export const MOST_BYTES = { plan: 4e6, model: 50e6, print: 250e6 };

export type PartName = keyof typeof MOST_BYTES;
