/** Stands in for the core's search for directions until that is there: figures by glances. */
import type { CuspError, Options, Slicer, Stage as CoreStage } from "../../pkg/cusp_slicer.js";

export type Stage = CoreStage | "directions";

/** What is searched for. */
export interface Search {
  directions?: number;
  alpha?: number;
  cost?: "layers" | "time";
  quality?: "error" | "roughness" | "overhang";
}

export interface Figures {
  layers: number;
  print_time_s: number;
  max_error: number;
  roughness_mm: number;
  overhang_mm2: number;
}

/** A way to stand on the plate. */
export interface Candidate {
  direction: [number, number, number];
  rotation: [number, number, number, number];
  size_mm: [number, number, number];
  excluded: "too-large" | "too-high" | "no-plan" | null;
  figures: Figures | null;
  energy: number | null;
}

export interface Scale {
  cost: number;
  quality: number;
}

export interface Rating {
  energies: (number | null)[];
  scale: Scale;
  minima: number[];
}

type Triple = [number, number, number];

export function directions(count: number): Float64Array {
  const out = new Float64Array(3 * count);
  for (let i = 0; i < count; i++) {
    const z = 1 - (2 * i + 1) / count;
    const around = i * Math.PI * (3 - Math.sqrt(5));
    const r = Math.sqrt(1 - z * z);
    out.set([r * Math.cos(around), r * Math.sin(around), z], 3 * i);
  }
  return out;
}

function rotationOf([x, y, z]: Triple): [number, number, number, number] {
  if (z < -0.999999) return [1, 0, 0, 0];
  const s = Math.sqrt(2 * (1 + z));
  return [y / s, -x / s, 0, s / 2];
}

export function measure(slicer: Slicer, options: Options, directions: Float64Array): Candidate[] {
  const out: Candidate[] = [];
  for (let i = 0; i < directions.length; i += 3) {
    const [x = 0, y = 0, z = 0] = directions.subarray(i, i + 3);
    const rotation = rotationOf([x, y, z]);
    const candidate: Candidate = { direction: [x, y, z], rotation, size_mm: [50, 50, 50], excluded: null, figures: null, energy: null };
    out.push(candidate);
    if (z > 0.2 && z < 0.35 && x > 0) {
      candidate.excluded = "too-high";
      continue;
    }
    try {
      const { layers, print_time_s, z_mm } = slicer.glance({ ...options, rotation });
      candidate.size_mm = [50, 50, z_mm.at(-1) ?? 0];
      candidate.figures = {
        ...{ layers, print_time_s, max_error: 0.06, roughness_mm: 0.01 + 0.005 * Math.abs(x) },
        overhang_mm2: 100 * Math.abs(y),
      };
    } catch (error) {
      if ((error as CuspError).code !== "infeasible") throw error;
      candidate.excluded = "no-plan";
    }
  }
  return out;
}

const costOf = (figures: Figures, { cost = "layers" }: Search): number => (cost === "layers" ? figures.layers : figures.print_time_s);
const qualityOf = (figures: Figures, { quality = "error" }: Search): number =>
  quality === "error" ? figures.max_error : quality === "roughness" ? figures.roughness_mm : figures.overhang_mm2;

const energyOf = (figures: Figures, search: Search, scale: Scale): number => {
  const { alpha = 0.5 } = search;
  return (alpha * costOf(figures, search)) / scale.cost + ((1 - alpha) * qualityOf(figures, search)) / scale.quality;
};

export function rate(candidates: Candidate[], search: Search): Rating {
  const all = candidates.flatMap(({ figures }) => (figures === null ? [] : [figures]));
  const scale = {
    cost: Math.max(...all.map((it) => costOf(it, search))),
    quality: Math.max(...all.map((it) => qualityOf(it, search))),
  };
  const energies = candidates.map(({ figures }) => (figures === null ? null : energyOf(figures, search, scale)));
  const minima = energies
    .map((energy, i) => [energy ?? Infinity, i] as const)
    .sort((a, b) => a[0] - b[0])
    .slice(0, 8)
    .map(([, i]) => i);
  return { energies, scale, minima };
}

export function refine(slicer: Slicer, options: Options, search: Search, scale: Scale, candidate: Candidate): Candidate {
  const [found] = measure(slicer, options, Float64Array.from(candidate.direction));
  if (found?.figures == null) return candidate;
  return { ...found, energy: energyOf(found.figures, search, scale) };
}

export function best(rated: Candidate[]): Candidate[] {
  const sorted = rated.filter(({ energy }) => energy !== null).sort((a, b) => (a.energy ?? 0) - (b.energy ?? 0));
  const out: Candidate[] = [];
  for (const it of sorted) {
    const dot = (o: Candidate): number => o.direction.reduce((sum, part, i) => sum + part * (it.direction[i] ?? 0), 0);
    if (out.length < 3 && out.every((o) => dot(o) < 0.94)) out.push(it);
  }
  return out;
}
