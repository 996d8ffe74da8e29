/** Actions of a visitor on the page, in any engine. */
import { readdir, readFile, rm } from "node:fs/promises";
import { join } from "node:path";
import { Key } from "selenium-webdriver";
import { vi } from "vitest";
import type { DroppedFile } from "../browser.js";
import type { Session } from "./session.js";

const PATIENCE = { timeout: 45_000, interval: 100 };

/** Waits until there is a value. */
const until = <R>(find: () => Promise<R>): Promise<NonNullable<R>> => vi.waitUntil(find, PATIENCE) as Promise<NonNullable<R>>;

const down = (value: string) => ({ type: "keyDown", value }) as const;
const up = (value: string) => ({ type: "keyUp", value }) as const;

/** A position in the window, in pixels. */
export interface Place {
  x: number;
  y: number;
}

export class Visitor {
  constructor(readonly session: Session) {}

  /** Opens the page as on a second visit, since the tour of the first would cover everything. */
  async open(address: string): Promise<void> {
    await this.session.open(address);
    await this.session.call(() => localStorage.setItem("cusp.tour", "shown"));
    await this.state("empty");
  }

  async state(...wanted: string[]): Promise<void> {
    await until(() => this.session.call((_, wanted) => wanted.includes(document.querySelector("cusp-workbench")?.getAttribute("state") ?? ""), wanted));
  }

  /** Waits, after a change of settings, until the plan shown matches them. */
  async settled(): Promise<void> {
    // A change makes the element busy before the next frame.
    await this.session.call(() => new Promise<void>((resolve) => requestAnimationFrame(() => resolve())));
    await this.state("done");
  }

  /** Drops a file, like a file manager. */
  async drop({ name, bytes }: DroppedFile): Promise<void> {
    await this.session.call(
      (_, name, base64) => {
        const dataTransfer = new DataTransfer();
        dataTransfer.items.add(new File([Uint8Array.from(atob(base64), (it) => it.charCodeAt(0))], name));
        for (const type of ["dragenter", "dragover", "drop"]) {
          document.querySelector("cusp-workbench")?.dispatchEvent(new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true, composed: true }));
        }
      },
      name,
      Buffer.from(bytes).toString("base64"),
    );
  }

  /** Clicks the first element with a matching name, once present and clickable. */
  async click(css: string, name: string): Promise<void> {
    const place = await until(() =>
      this.session.call(
        (dom, css, name) => {
          const it = dom.named(css, name);
          if (it === undefined || it.matches(":disabled")) return null;
          it.scrollIntoView({ block: "nearest", behavior: "instant" });
          const box = it.getBoundingClientRect();
          const [x, y] = [Math.round(box.x + box.width / 2), Math.round(box.y + box.height / 2)];
          const hit = (it.getRootNode() as ShadowRoot).elementFromPoint(x, y);
          const labels = [...((it as HTMLInputElement).labels ?? [])];
          return [it, ...labels].some((target) => target.contains(hit)) ? { x, y } : null;
        },
        css,
        name,
      ),
    );
    await this.pointer(["pointerMove", place], ["pointerDown"], ["pointerUp"]);
  }

  /** Moves and presses the mouse. */
  async pointer(...steps: (["pointerMove", Place] | ["pointerDown"] | ["pointerUp"])[]): Promise<void> {
    const actions = steps.map(([type, place]) => (type === "pointerMove" ? { type, x: Math.round(place.x), y: Math.round(place.y) } : { type, button: 0 }));
    await this.session.act({ type: "pointer", id: "mouse", actions });
  }

  /** Presses keys while holding preceding modifiers. */
  async press(...keys: string[]): Promise<void> {
    await this.#keys([...keys.map(down), ...keys.toReversed().map(up)]);
  }

  async #keys(actions: ReturnType<typeof down | typeof up>[]): Promise<void> {
    await this.session.act({ type: "key", id: "keyboard", actions });
  }

  async focus(css: string, name: string): Promise<void> {
    await until(() =>
      this.session.call(
        (dom, css, name) => {
          const it = dom.named(css, name);
          it?.focus();
          return it !== undefined;
        },
        css,
        name,
      ),
    );
  }

  /** Replaces the text of a field by typing. */
  async type(name: string, text: string): Promise<void> {
    await this.focus("input", name);
    await this.press(Key.CONTROL, "a");
    await this.#keys(Array.from(text).flatMap((letter) => [down(letter), up(letter)]));
  }

  /** Selects from a list, whose native items cannot be clicked, or moves a slider. */
  async set(name: string, value: string): Promise<void> {
    await until(() =>
      this.session.call(
        (dom, name, value) => {
          const it = dom.named("select, input[type=range]", name) as HTMLInputElement | undefined;
          if (it === undefined) return false;
          it.value = value;
          for (const type of ["input", "change"]) it.dispatchEvent(new Event(type, { bubbles: true, composed: true }));
          return true;
        },
        name,
        value,
      ),
    );
  }

  async valueOf(name: string): Promise<string> {
    return until(() => this.session.call((dom, name) => (dom.named("input, select", name) as HTMLInputElement | undefined)?.value ?? null, name));
  }

  /** The page's text with white space normalised. */
  words(): Promise<string> {
    return this.session.call((dom) => dom.all(".bench").map((it) => it.innerText).join(" ").replace(/\s+/g, " "));
  }

  layers(): Promise<number> {
    return this.session.call((dom) => Number(dom.all("[data-layers]")[0]?.dataset["layers"]));
  }

  /** Waits until the mask of this layer is shown, counted from 0. */
  async mask(layer: number): Promise<void> {
    await until(() => this.session.call((dom, css) => dom.all(css).length > 0, `canvas[data-layer="${layer}"]`));
  }

  /** Centre of an element, in the window. */
  middle(css: string): Promise<Place> {
    return until(() =>
      this.session.call((dom, css) => {
        const [it] = dom.all(css);
        if (it === undefined) return null;
        it.scrollIntoView({ block: "nearest", behavior: "instant" });
        const box = it.getBoundingClientRect();
        return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
      }, css),
    );
  }

  /** Clicks the control that saves a file, and waits for the file. */
  async download(name: string): Promise<{ name: string; bytes: Buffer }> {
    const { downloads } = this.session;
    for (const old of await readdir(downloads)) await rm(join(downloads, old));
    await this.click("button", name);
    // An incomplete download has an additional file (Firefox) or another name (WebKit).
    return until(async () => {
      const [name, ...others] = await readdir(downloads);
      if (name === undefined || others.length > 0 || /\.(part|wkdownload)$/.test(name)) return null;
      const bytes = await readFile(join(downloads, name));
      return bytes.length > 0 ? { name, bytes } : null;
    });
  }
}
