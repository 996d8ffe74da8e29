/** Undo and redo of any value. */

/** Changes of one kind within this time of each other form one step, like the letters of a word. */
const TOGETHER_MS = 1000;
const MOST_STEPS = 100;

export class History<T> {
  #past: T[] = [];
  #future: T[] = [];
  #last: { kind: string; at_ms: number } | null = null;

  get canUndo(): boolean {
    return this.#past.length > 0;
  }

  get canRedo(): boolean {
    return this.#future.length > 0;
  }

  /** Records the value before a change; quick changes of the same `kind`, such as typing, are undone together. */
  note(before: T, kind: string, now_ms: number): void {
    const isMore = this.#last?.kind === kind && now_ms - this.#last.at_ms < TOGETHER_MS;
    this.#last = { kind, at_ms: now_ms };
    this.#future = [];
    if (!isMore) this.#past = [...this.#past, before].slice(-MOST_STEPS);
  }

  /** The previous value, given the current one; null if there is none. */
  undo(now: T): T | null {
    const before = this.#past.pop();
    if (before === undefined) return null;
    this.#future.push(now);
    this.#last = null;
    return before;
  }

  redo(now: T): T | null {
    const after = this.#future.pop();
    if (after === undefined) return null;
    this.#past.push(now);
    this.#last = null;
    return after;
  }
}
