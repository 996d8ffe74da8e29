/** Orientation candidates cross between workers as packed numbers (`src/orientation/packed.rs`): objects take ten times as long. */
import type { Candidate, Exclusion, Metrics, PackedCandidates } from "./wire.js";

/** Numbers per candidate. */
const NUMBERS = 21;

/** Indexed by their number minus 1; 0 means not excluded. */
const EXCLUSIONS: readonly Exclusion[] = ["too-large", "too-high", "no-plan", "overhang", "islands", "cups"];

/** Unpacks candidates; null for a direction that is not measured. */
export function unpacked(numbers: PackedCandidates): (Candidate | null)[] {
  return Array.from({ length: numbers.length / NUMBERS }, (_, place) => {
    const [x = NaN, y = NaN, z = NaN, i = NaN, j = NaN, k = NaN, real = NaN, width = NaN, depth = NaN, height = NaN, ...rest] = numbers.subarray(NUMBERS * place, NUMBERS * (place + 1));
    const [energy = NaN, excluded = 0, ...measures] = rest;
    if (Number.isNaN(x)) return null;
    return {
      direction: [x, y, z],
      rotation: [i, j, k, real],
      size_mm: [width, depth, height],
      excluded: EXCLUSIONS[excluded - 1] ?? null,
      metrics: metricsOf(measures),
      energy: Number.isNaN(energy) ? null : energy,
    };
  });
}

function metricsOf(measures: readonly number[]): Candidate["metrics"] {
  const [layers = NaN, print_time_s = 0, max_error = 0, roughness_mm = 0, overhang_mm2 = 0, islands = 0, cups_mm2 = 0, support_ml = 0, contact_mm2 = 0] = measures;
  if (Number.isNaN(layers)) return null;
  return { layers, print_time_s, max_error, roughness_mm, overhang_mm2, islands, cups_mm2, support_ml, contact_mm2 };
}

/** Packs candidates; null stands for a direction that is not measured. */
export function packed(candidates: readonly (Candidate | null)[]): PackedCandidates {
  const numbers = new Float64Array(NUMBERS * candidates.length).fill(NaN);
  for (const [place, candidate] of candidates.entries()) {
    if (candidate === null) continue;
    const { direction, rotation, size_mm, energy, excluded, metrics } = candidate;
    const code = excluded === null ? 0 : EXCLUSIONS.indexOf(excluded) + 1;
    numbers.set([...direction, ...rotation, ...size_mm, energy ?? NaN, code, ...(metrics === null ? [] : numbersOf(metrics))], NUMBERS * place);
  }
  return numbers;
}

const numbersOf = (metrics: Metrics): number[] => {
  const { layers, print_time_s, max_error, roughness_mm, overhang_mm2, islands, cups_mm2, support_ml, contact_mm2 } = metrics;
  return [layers, print_time_s, max_error, roughness_mm, overhang_mm2, islands, cups_mm2, support_ml, contact_mm2];
};

/** Unpacks candidates of directions that are all measured. */
export function unpackedMeasured(numbers: PackedCandidates): Candidate[] {
  return unpacked(numbers).filter((candidate) => candidate !== null);
}
