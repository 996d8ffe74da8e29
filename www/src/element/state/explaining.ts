/** Explanation of the last failure. The code is fetched with the first failure. */
import { fetchRest, type Language } from "../../texts/index.js";
import type { Failure, Problem } from "./problem.js";
import type { Settings } from "./settings.js";

type Asked = readonly [failure: Failure, language: Language, fixed: ReadonlySet<keyof Settings>];

export class Explaining {
  readonly #changed: () => void;
  #asked: Asked | null = null;
  #problem: Problem | null = null;

  constructor(changed: () => void) {
    this.#changed = changed;
  }

  /**
   * Null if nothing failed, or until the explanation is loaded. The same failure in another language keeps the old explanation until then.
   */
  of(...[failure, language, fixed]: readonly [Failure | null, Language, ReadonlySet<keyof Settings>]): Problem | null {
    if (failure !== this.#asked?.[0]) this.#problem = null;
    if (failure === null) this.#asked = null;
    else if (failure !== this.#asked?.[0] || language !== this.#asked[1] || fixed !== this.#asked[2]) void this.#explain([failure, language, fixed]);
    return this.#problem;
  }

  async #explain(asked: Asked): Promise<void> {
    this.#asked = asked;
    const problem = await explained(asked);
    if (this.#asked !== asked) return;
    this.#problem = problem;
    this.#changed();
  }
}

async function explained(asked: Asked): Promise<Problem> {
  try {
    const [{ explain }] = await Promise.all([import("./problem.js"), fetchRest()]);
    return explain(...asked);
  } catch {
    // If the code cannot be loaded, as without a connection, shows the core's own sentence.
    const [{ error: { code, message } }] = asked;
    return { code, title: message, text: "", offers: [], field: null };
  }
}
