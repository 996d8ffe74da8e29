/** Undo and redo of strokes. A stroke stores only the facets that it changed. */

export interface Stroke {
  readonly facets: Uint32Array;
  readonly before: Float32Array;
  readonly after: Float32Array;
}

const MOST_STROKES = 100;

/** The change of weights as a stroke; null if nothing changed. */
export function strokeOf(facets: Iterable<number>, before: (facet: number) => number, after: Float32Array): Stroke | null {
  const changed = [...facets].filter((facet) => before(facet) !== after[facet]);
  if (changed.length === 0) return null;
  return {
    facets: Uint32Array.from(changed),
    before: Float32Array.from(changed, before),
    after: Float32Array.from(changed, (facet) => after[facet] ?? 0),
  };
}

export class Strokes {
  #past: Stroke[] = [];
  #future: Stroke[] = [];

  get canUndo(): boolean {
    return this.#past.length > 0;
  }

  get canRedo(): boolean {
    return this.#future.length > 0;
  }

  /** Records a new stroke and drops undone ones. */
  note(stroke: Stroke): void {
    this.#past = [...this.#past, stroke].slice(-MOST_STROKES);
    this.#future = [];
  }

  /** Undoes the last stroke; returns the changed facets, or null if there is none. */
  undo(weights: Float32Array): Uint32Array | null {
    const stroke = this.#past.pop();
    if (stroke === undefined) return null;
    this.#future.push(stroke);
    return written(weights, stroke.facets, stroke.before);
  }

  redo(weights: Float32Array): Uint32Array | null {
    const stroke = this.#future.pop();
    if (stroke === undefined) return null;
    this.#past.push(stroke);
    return written(weights, stroke.facets, stroke.after);
  }
}

function written(weights: Float32Array, facets: Uint32Array, values: Float32Array): Uint32Array {
  for (const [i, facet] of facets.entries()) weights[facet] = values[i] ?? 0;
  return facets;
}
