/** Forwards the reports of a session: as events to the page, and to callers that wait for a plan. */
import type { SlicerError } from "../api/error.js";
import type { Check, Model, Plan } from "../api/index.js";
import type { Candidate, Price } from "../api/wire.js";
import type { CuspSlicerEvents } from "./events.js";
import { secondsLeft, type Busy } from "./parts/progress.js";
import type { Result } from "./state/result.js";
import type { Host } from "./state/host.js";

interface Waiting {
  resolve(result: Plan): void;
  reject(error: unknown): void;
}

/** The part of an element that reports use. */
type Speaker = Pick<HTMLElement, "dispatchEvent"> & { requestUpdate(): void; readonly query: string };

interface Asked {
  /** Returns true if the last plan is for the current settings. */
  isCurrent(): boolean;
  hasView(): boolean;
  /** The list of printers has arrived. */
  offered(): void;
  /** Called with an error of the page, such as an invalid attribute. */
  misused(error: SlicerError): void;
}

export class Reports implements Host {
  readonly #speaker: Speaker;
  readonly #asked: Asked;
  #waiting: Waiting[] = [];

  constructor(speaker: Speaker, asked: Asked) {
    this.#speaker = speaker;
    this.#asked = asked;
  }

  /** Resolves with the next plan for the current settings; rejects if one fails or is cancelled. */
  nextPlan(): Promise<Plan> {
    return new Promise((resolve, reject) => this.#waiting.push({ resolve, reject }));
  }

  /** Dispatches an event; returns false if the page called `preventDefault()`. */
  tell<Name extends keyof CuspSlicerEvents>(name: Name, detail: CuspSlicerEvents[Name]["detail"]): boolean {
    const isCancelable = name === "cusp-export";
    return this.#speaker.dispatchEvent(new CustomEvent(name, { detail, bubbles: true, composed: true, cancelable: isCancelable }));
  }

  requestUpdate(): void {
    this.#speaker.requestUpdate();
  }

  hasView(): boolean {
    return this.#asked.hasView();
  }

  loaded(model: Model): void {
    this.tell("cusp-load", model);
  }

  planned(result: Result): void {
    if (this.#asked.isCurrent()) this.#settle(({ resolve }) => resolve(result));
    this.tell("cusp-plan", result);
  }

  failed(error: SlicerError): void {
    this.#settle(({ reject }) => reject(error));
    this.tell("cusp-error", error);
  }

  checked(check: Check): void {
    this.tell("cusp-check", check);
  }

  unchecked(error: SlicerError): void {
    this.#asked.misused(error);
  }

  offered(): void {
    this.#asked.offered();
  }

  cancelled(): void {
    this.#settle(({ reject }) => reject(new DOMException("cancelled", "AbortError")));
  }

  progressed(busy: Busy): void {
    const { task, stage, fraction, done } = busy;
    this.tell("cusp-progress", { task, stage, fraction, done, left_s: secondsLeft(busy, performance.now()) });
  }

  painted(weights: Float32Array | null, final: boolean): void {
    this.tell("cusp-paint", { weights, final });
  }

  oriented(candidate: Candidate): void {
    this.tell("cusp-orientation", candidate);
  }

  priced(price: Price): void {
    this.tell("cusp-price", price);
  }

  mispriced(error: SlicerError): void {
    this.#asked.misused(error);
  }

  settingsChanged(): void {
    this.tell("cusp-change", { query: this.#speaker.query });
  }

  #settle(tell: (waiting: Waiting) => void): void {
    const waiting = this.#waiting;
    this.#waiting = [];
    waiting.forEach(tell);
  }
}
