/**
 * The profile and the plan as a uPlot chart: height up, the metric's density to the right, the layers as bands of colour.
 *
 * uPlot's x is the axis by which the data is sorted, here the height. Making that scale vertical (`ori: 1`) and the density horizontal
 * (`ori: 0`) gives the paper's figure, and keeps uPlot's own decimation, zoom and cursor.
 */
import type uPlot from "uplot";
import { css, ofThickness } from "../../view/legend/palette.js";
import type { Language } from "../../texts/index.js";
import { layerAt } from "../../view/scene/lookup.js";
import { METRICS } from "../state/metric.js";
import type { Shown } from "../state/result.js";

/** The data of the chart. */
export type ChartData = Omit<Shown, "layers" | "print_time_s" | "lift_mm" | "supports" | "voids">;

export interface ChartTheme {
  ink: string;
  /** Axis labels. */
  text: string;
  grid: string;
  /** Colour into which bands fade beyond the profile. */
  paper: string;
  /** Line between layers that are tall enough to distinguish. */
  seam: string;
  /** Marks of undersides out of tolerance. */
  bad: string;
  font: string;
}

/** Rows of pixels of one colour: that of the mean thickness of the layers they cross. */
export interface Band {
  row: number;
  rows: number;
  thickness_mm: number;
}

/** Minimum height of a layer on the screen to have a seam. */
const SEAM_FROM_PX = 5;

/** Allowance for rounding, as a fraction of a pixel row. */
const EDGE = 1e-6;

/** Width of these marks, and their least height. */
const OFF_PX = 5;
const LEAST_OFF_PX = 2;

/** Opacity of a band beyond the profile. */
const FADED = 0.45;

/** Factor beyond the greatest value, to keep its line visible. */
const MARGIN = 1.01;

/** Ticks of a density axis, as fractions of the bound. In a narrow chart, quarters would overlap. */
const QUARTERS = [0, 0.25, 0.5, 0.75, 1];
const HALVES = [0, 0.5, 1];
const NARROW_PX = 260;

/** Visible range of heights, mm. */
export type Heights = readonly [low: number, high: number];

/**
 * Zooms heights by `factor` so that `z_mm` lies at `place`, 0 the lower and 1 the upper edge. The result stays within the model, from 0 to
 * `whole_mm`, and spans at least `least_mm`.
 */
export function zoomHeights([low, high]: Heights, factor: number, z_mm: number, place: number, whole_mm: number, least_mm: number): Heights {
  const span = Math.min(whole_mm, Math.max(least_mm, (high - low) / factor));
  const start = Math.min(whole_mm - span, Math.max(0, z_mm - place * span));
  return [start, start + span];
}

/** End of the density axis: just beyond the metric's bound, or without one beyond the greatest value of the profile. */
export function densityEnd({ metric, profile }: ChartData): number {
  const end = METRICS[metric].bound ?? profile.reduce((most, value) => Math.max(most, value), 0);
  return end > 0 ? end * MARGIN : 1;
}

/** Heights of the bin centres in mm and the densities, in uPlot's format. */
export function chartData({ profile, bin_mm }: ChartData): uPlot.AlignedData {
  return [Float64Array.from(profile, (_, i) => (i + 0.5) * bin_mm), profile];
}

/**
 * The plan as `rows` rows of pixels from height `top` down to `bottom`, in mm; rows above or below the model are omitted. Cost: linear in
 * the layers in range plus the rows.
 */
export function bands(data: ChartData, top: number, bottom: number, rows: number): Band[] {
  const { z_mm, thickness_mm } = data;
  const step = (top - bottom) / rows;
  const end = z_mm.at(-1) ?? 0;
  const out: Band[] = [];
  for (let row = 0; row < rows; row++) {
    const high = top - row * step;
    const low = high - step;
    if (low >= end || high <= 0) continue;
    // A row that only touches a layer above it does not show that layer.
    const [first, last] = [layerAt(z_mm, low + EDGE * step), layerAt(z_mm, high - EDGE * step)];
    let sum = 0;
    for (let layer = first; layer <= last; layer++) sum += thickness_mm[layer] ?? 0;
    const mean = sum / (last - first + 1);
    const before = out.at(-1);
    if (before?.thickness_mm === mean && before.row + before.rows === row) before.rows++;
    else out.push({ row, rows: 1, thickness_mm: mean });
  }
  return out;
}

/** Bands of the whole plot as a pattern one pixel wide, repeated horizontally to fill any shape. */
function bandPattern(u: uPlot, data: ChartData, theme: ChartTheme): CanvasPattern | string {
  const { bbox } = u;
  const { min, max } = u.scales["x"] ?? {};
  const strip = document.createElement("canvas");
  strip.width = 1;
  strip.height = u.ctx.canvas.height;
  const pen = strip.getContext("2d");
  if (pen === null || min == null || max == null || max <= min) return "transparent";
  for (const band of bands(data, max, min, bbox.height)) {
    pen.fillStyle = css(ofThickness(band.thickness_mm, data.limits));
    pen.fillRect(0, bbox.top + band.row, 1, band.rows);
  }
  const perMm = bbox.height / (max - min);
  pen.fillStyle = theme.seam;
  for (let i = layerAt(data.z_mm, min); i <= layerAt(data.z_mm, max); i++) {
    const z = data.z_mm[i] ?? 0;
    if ((data.thickness_mm[i] ?? 0) * perMm < SEAM_FROM_PX || z <= min || z > max) continue;
    pen.fillRect(0, Math.round(bbox.top + (max - z) * perMm), 1, 1);
  }
  return u.ctx.createPattern(strip, "repeat-x") ?? "transparent";
}

/** Fills the plot with faded bands; the profile is later filled in full colour. */
function drawFaded(u: uPlot, pattern: CanvasPattern | string, theme: ChartTheme): void {
  const { ctx, bbox } = u;
  ctx.save();
  ctx.fillStyle = theme.paper;
  ctx.fillRect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.globalAlpha = FADED;
  ctx.fillStyle = pattern;
  ctx.fillRect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.restore();
}

/** Marks undersides that stay out of tolerance, beside the plot, whose colours have every red. */
function drawOff(u: uPlot, { off_mm }: ChartData, theme: ChartTheme): void {
  const { ctx, bbox } = u;
  const [width, least] = [OFF_PX, LEAST_OFF_PX].map((px) => px * devicePixelRatio) as [number, number];
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left - width, bbox.top, width, bbox.height);
  ctx.clip();
  ctx.fillStyle = theme.bad;
  for (const [low, high] of off_mm) {
    const [bottom, top] = [low, high].map((z_mm) => u.valToPos(z_mm, "x", true)) as [number, number];
    ctx.fillRect(bbox.left - width, top, width, Math.max(bottom - top, least));
  }
  ctx.restore();
}

/** uPlot options for a chart of this size in CSS pixels. Axis labels are HTML outside, where long ones can wrap. */
export function chartOptions(
  data: ChartData,
  theme: ChartTheme,
  { format }: Language,
  [width, height]: readonly [number, number],
): uPlot.Options {
  const total = data.profile.length * data.bin_mm;
  const { bound, tick } = METRICS[data.metric];
  const end = densityEnd(data);
  let pattern: CanvasPattern | string = "transparent";
  const axis: uPlot.Axis = {
    stroke: theme.text,
    font: `12px ${theme.font}`,
    grid: { show: false },
    ticks: { stroke: theme.grid, size: 4, width: 1 },
  };
  return {
    width,
    height,
    pxAlign: true,
    legend: { show: false },
    cursor: { x: true, y: false, points: { show: false }, drag: { x: true, y: false, setScale: true, dist: 6 } },
    scales: {
      // Points are at bin centres; the axis extends to the outer edges of the first and the last bin.
      x: {
        time: false,
        ori: 1,
        dir: 1,
        range: (_u, min, max) => [min <= data.bin_mm ? 0 : min, max >= total - data.bin_mm ? total : max],
      },
      density: { ori: 0, dir: 1, range: [0, end] },
    },
    axes: [
      { ...axis, scale: "x", side: 3, size: 44, values: (_u, ticks) => ticks.map((value) => format.tick(value)) },
      {
        ...axis,
        scale: "density",
        side: 2,
        size: 30,
        // Quarters of the bound, if there is one; otherwise uPlot picks round numbers.
        ...(bound !== null && { splits: (u) => (u.width < NARROW_PX ? HALVES : QUARTERS).map((part) => part * bound) }),
        values: (_u, ticks) => ticks.map((value) => tick(value, format)),
      },
    ],
    series: [{}, { scale: "density", stroke: theme.ink, width: 1, fill: () => pattern, points: { show: false } }],
    hooks: {
      drawClear: [
        (u) => {
          pattern = bandPattern(u, data, theme);
          drawFaded(u, pattern, theme);
        },
      ],
      draw: [(u) => drawOff(u, data, theme)],
    },
  };
}
