/**
 * The profile and the plan as a uPlot chart: height upwards, the metric's density to the right, the layers as bands of colour.
 *
 * uPlot's x is the axis that the data is sorted by, which here is the height: turning that scale upright (`ori: 1`) and
 * the density level (`ori: 0`) gives the paper's figure with uPlot's own decimation, zoom and cursor still working.
 */
import type uPlot from "uplot";
import { css, ofThickness } from "../../view/legend/palette.js";
import type { Language } from "../../texts/index.js";
import { layerAt } from "../../view/scene/lookup.js";
import { METRICS } from "../state/metric.js";
import type { Shown } from "../state/result.js";

/** What the chart is drawn from. */
export type ChartData = Omit<Shown, "layers" | "print_time_s">;

export interface ChartTheme {
  ink: string;
  /** Axis labels. */
  text: string;
  grid: string;
  /** What the bands fade into beyond the profile. */
  paper: string;
  /** Between layers, where they are tall enough to tell apart. */
  seam: string;
  font: string;
}

/** Rows of pixels that share a colour: the mean thickness of the layers they meet. */
export interface Band {
  row: number;
  rows: number;
  thickness_mm: number;
}

/** Layers lower than this on the screen run together without a seam. */
const SEAM_FROM_PX = 5;

/** Part of a row of pixels that rounding may get wrong. */
const EDGE = 1e-6;

/** How much of its colour a band keeps beyond the profile. */
const FADED = 0.45;

/** Room beyond the greatest value, so that its line is seen. */
const MARGIN = 1.01;

const QUARTERS = [0, 0.25, 0.5, 0.75, 1];

/** Where the axis of the densities ends. */
export function densityEnd({ metric, profile }: ChartData): number {
  const end = METRICS[metric].bound ?? profile.reduce((most, value) => Math.max(most, value), 0);
  return end > 0 ? end * MARGIN : 1;
}

/** The bin centres as heights, and the densities, as uPlot wants them. */
export function chartData({ profile, bin_mm }: ChartData): uPlot.AlignedData {
  return [Float64Array.from(profile, (_, i) => (i + 0.5) * bin_mm), profile];
}

/**
 * The plan as `rows` rows of pixels from the height `top` down to `bottom`; rows above or below the model are left out.
 * Cost: the layers in range plus the rows.
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

/** The whole plot as a strip one pixel wide, to be repeated sideways: so the bands can fill any shape. */
function bandPattern(u: uPlot, data: ChartData, theme: ChartTheme): CanvasPattern | string {
  const { bbox } = u;
  const { min, max } = u.scales["x"] ?? {};
  const strip = document.createElement("canvas");
  strip.width = 1;
  strip.height = u.ctx.canvas.height;
  const pen = strip.getContext("2d");
  if (pen === null || min == null || max == null || max <= min) return "transparent";
  for (const band of bands(data, max, min, bbox.height)) {
    pen.fillStyle = css(ofThickness("classic", band.thickness_mm, data.limits));
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

/** Full colour lies under the profile; beyond it the same bands go on, faded into the paper. */
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

/** Everything uPlot needs for a chart of this size in CSS pixels. */
export function chartOptions(
  data: ChartData,
  theme: ChartTheme,
  { texts, format }: Language,
  [width, height]: readonly [number, number],
): uPlot.Options {
  const total = data.profile.length * data.bin_mm;
  const { bound, tick } = METRICS[data.metric];
  const end = densityEnd(data);
  let pattern: CanvasPattern | string = "transparent";
  const axis: uPlot.Axis = {
    stroke: theme.text,
    font: `12px ${theme.font}`,
    labelFont: `12px ${theme.font}`,
    labelSize: 22,
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
      // Points stand in the middle of their bins; the axis goes on to the ends of the first and the last.
      x: {
        time: false,
        ori: 1,
        dir: 1,
        range: (_u, min, max) => [min <= data.bin_mm ? 0 : min, max >= total - data.bin_mm ? total : max],
      },
      density: { ori: 0, dir: 1, range: [0, end] },
    },
    axes: [
      { ...axis, scale: "x", side: 3, label: texts.chart.heights, size: 44, values: (_u, ticks) => ticks.map((value) => format.tick(value)) },
      {
        ...axis,
        scale: "density",
        side: 2,
        label: texts.metrics[data.metric].axis,
        size: 30,
        // Where the end is known, quarters of it; else uPlot finds round numbers.
        ...(bound !== null && { splits: QUARTERS.map((part) => part * bound) }),
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
    },
  };
}
