/** Keeps the open work in this browser, a moment after each change and when the page is hidden. */
import type { CuspSlicerEvents } from "../element/events.js";
import type { SlicerElement } from "../element/slicer-element.js";
import type { Snapshot } from "../element/state/snapshot.js";
import { hasKept, isKeeping, setKeeping } from "./keeping.js";

/** The part of the element used here. */
type Worked = Pick<SlicerElement, "work" | "state" | "lastThumbnail" | "addEventListener">;

/** Events after which the work may have changed. */
const EVENTS = ["cusp-load", "cusp-change", "cusp-paint", "cusp-plan"] as const satisfies readonly (keyof CuspSlicerEvents)[];

const DELAY_MS = 1000;

export class Autosave {
  readonly #element: Worked;
  readonly #failed: (name: string) => void;
  /** Ids of the works of this page, by the number of their set of models. */
  readonly #ids = new Map<number, string>();
  #timer: ReturnType<typeof setTimeout> | undefined;
  /** Saves run one after the other. */
  #saving: Promise<void> = Promise.resolve();
  /** Number of changes, and how many of them are kept. */
  #changes = 0;
  #kept = 0;
  #hasFailed = false;

  /** @param failed called with the name of a model if its work could not be kept */
  constructor(element: Worked, failed: (name: string) => void) {
    this.#element = element;
    this.#failed = failed;
    for (const name of EVENTS) element.addEventListener(name, () => this.changed());
    document.addEventListener("visibilitychange", () => {
      if (document.visibilityState === "hidden" && this.#timer !== undefined) this.#save();
    });
  }

  /** Returns true if nothing has changed since the work was kept. */
  get isKept(): boolean {
    return this.#kept === this.#changes;
  }

  /** Keeps the open work under this id, as when a kept one has been opened. */
  continues(id: string): void {
    const { job } = this.#element.work() ?? {};
    if (job !== undefined) this.#ids.set(job, id);
  }

  changed(): void {
    this.#changes++;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#save(), DELAY_MS);
  }

  #save(): void {
    clearTimeout(this.#timer);
    this.#timer = undefined;
    this.#saving = this.#saving.then(() => this.#keep());
  }

  async #keep(): Promise<void> {
    const changes = this.#changes;
    const { job, snapshot } = this.#element.work() ?? {};
    if (job === undefined || snapshot === undefined || !isKeeping() || !hasFile(snapshot)) return;
    // Kept only where the user can turn it off for good.
    if (!hasKept() && !setKeeping(true)) return;
    const id = this.#ids.get(job) ?? crypto.randomUUID();
    this.#ids.set(job, id);
    const name = snapshot.models[0]?.name ?? "";
    try {
      const { recentWorks, PICTURE_PX } = await import("./recent-work.js");
      const works = await recentWorks();
      if (works === null) return;
      const kept = await works.keep(id, snapshot);
      // Keeping was switched off meanwhile, perhaps in another tab.
      if (!isKeeping()) return await works.deleteAll();
      if (kept === null) return this.#fail(name);
      this.#kept = changes;
      this.#hasFailed = false;
      if (this.#element.state !== "done" || (await works.picture(kept)) !== null) return;
      // Without WebGL, there is no picture.
      await this.#element.lastThumbnail(PICTURE_PX).then((png) => works.setPicture(kept, png)).catch(() => undefined);
    } catch {
      this.#fail(name);
    }
  }

  /** Reports a failure once, not after each change. */
  #fail(name: string): void {
    if (!this.#hasFailed) this.#failed(name);
    this.#hasFailed = true;
  }
}

/** The example is not a file. */
const hasFile = ({ models }: Snapshot): boolean => models.some(({ file }) => file instanceof File);
