/** Copies with faulty placements. */
import type { ArrangeError, Placement } from "../../api/wire.js";

/** Indices of the placements named by problems, which count the copies of each model in the order of the placements. */
export function placesOf(problems: readonly ArrangeError[], placements: readonly Placement[]): ReadonlySet<number> {
  const named = problems.flatMap((problem): (readonly [model: number, copy: number])[] => {
    if (problem.code === "plate-outside") return [[problem.detail.model_number, problem.detail.copy_number]];
    if (problem.code !== "plate-collision") return [];
    const { model_numbers, copy_numbers } = problem.detail;
    return [0, 1].map((i) => [model_numbers[i] ?? 0, copy_numbers[i] ?? 0] as const);
  });
  const places = new Map<string, number>();
  const counts = new Map<number, number>();
  placements.forEach(({ model }, place) => {
    const copy = (counts.get(model) ?? 0) + 1;
    counts.set(model, copy);
    places.set(`${model + 1} ${copy}`, place);
  });
  return new Set(named.flatMap(([model, copy]) => places.get(`${model} ${copy}`) ?? []));
}
