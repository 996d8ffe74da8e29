/** What a visitor does on the page, in any engine. */
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

/** A place in the window, in pixels. */
export interface Place {
  x: number;
  y: number;
}

export class Visitor {
  constructor(readonly session: Session) {}

  /** Opens the page as on a second visit: the tour of the first would stand in front of everything. */
  async open(address: string): Promise<void> {
    await this.session.open(address);
    await this.session.call(() => localStorage.setItem("cusp.tour", "shown"));
    await this.state("empty");
  }

  async state(...wanted: string[]): Promise<void> {
    await until(() => this.session.call((_, wanted) => wanted.includes(document.querySelector("cusp-workbench")?.getAttribute("state") ?? ""), wanted));
  }

  /** Waits, after a change of settings, until the plan on show matches them. */
  async settled(): Promise<void> {
    // A change makes the element busy before the next frame.
    await this.session.call(() => new Promise<void>((resolve) => requestAnimationFrame(() => resolve())));
    await this.state("done");
  }

  /** Drops a file as a file manager would. */
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

  /** Waits until the first element with such a name is there and can be clicked, and clicks it. */
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

  /** Presses keys, each while those before it that modify others are held. */
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

  /** Types into a field, in place of what it has. */
  async type(name: string, text: string): Promise<void> {
    await this.focus("input", name);
    await this.press(Key.CONTROL, "a");
    await this.#keys(Array.from(text).flatMap((letter) => [down(letter), up(letter)]));
  }

  /** Chooses in a list, whose items are the system's and out of reach, or moves a slider. */
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

  /** The words of the page, with every run of white space as one space. */
  words(): Promise<string> {
    return this.session.call((dom) => dom.all(".bench").map((it) => it.innerText).join(" ").replace(/\s+/g, " "));
  }

  layers(): Promise<number> {
    return this.session.call((dom) => Number(dom.all("[data-layers]")[0]?.dataset["layers"]));
  }

  /** Waits until the mask on show is that of this layer, counted from 0. */
  async mask(layer: number): Promise<void> {
    await until(() => this.session.call((dom, css) => dom.all(css).length > 0, `canvas[data-layer="${layer}"]`));
  }

  /** The middle of an element, in the window. */
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

  /** Clicks what saves a file, and waits for the file. */
  async download(name: string): Promise<{ name: string; bytes: Buffer }> {
    const { downloads } = this.session;
    for (const old of await readdir(downloads)) await rm(join(downloads, old));
    await this.click("button", name);
    // Until it is whole, it has another name beside it (Firefox) or in its place (WebKit).
    return until(async () => {
      const [name, ...others] = await readdir(downloads);
      if (name === undefined || others.length > 0 || /\.(part|wkdownload)$/.test(name)) return null;
      const bytes = await readFile(join(downloads, name));
      return bytes.length > 0 ? { name, bytes } : null;
    });
  }
}
