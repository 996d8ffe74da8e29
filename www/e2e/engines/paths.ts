/** The main paths through the page in an engine other than Chromium. Their results are identical to the last byte. */
import { execFileSync } from "node:child_process";
import { mkdtemp, readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { crc32 } from "node:zlib";
import { strFromU8, unzipSync } from "fflate";
import { Key } from "selenium-webdriver";
import { afterAll, afterEach, beforeAll, describe, expect, inject, test, vi } from "vitest";
import { findCusp } from "../../examples/shop/cusp.js";
import type { Candidate } from "../../src/api/wire.js";
import type { CuspOrientation } from "../../src/element/panels/orientation-panel.js";
import { AIMS } from "../../src/element/state/orientation.js";
import { fetchLanguage, languageOf, LANGUAGES } from "../../src/texts/index.js";
import { serve } from "../serve.js";
import { cup, sphere } from "../solids.js";
import { Outside } from "./outside.js";
import { Programs, within } from "./programs.js";
import type { Engine, Session } from "./session.js";
import { Visitor, type Place } from "./visitor.js";

declare module "vitest" {
  interface TaskMeta {
    /** Reason for skipping a test. */
    reason?: string;
  }
}

const ball = { name: "ball.stl", bytes: sphere(10, 96).bytes };
/** Casting its rays takes long enough to cancel. */
const fine = { name: "fine.stl", bytes: sphere(10, 400).bytes };
/** Few facets, and different orientations. */
const mug = { name: "mug.stl", bytes: cup(20, 30, 2) };

/** Few rays where the number does not matter, since engines draw and compute on two cores. */
const FEW = "?rays=512";

/** The page's note on a plan that no longer matches the settings. */
const KEPT = "This is the last plan that worked";

/** Starts of a browser before its tests fail: on busy cores a driver may wait forever for a browser that is already running. */
const STARTS = 3;
const START_MS = 30_000;

const cusp = findCusp();

type Posed = Pick<Candidate, "rotation" | "energy" | "metrics">;

const ignored = (reason: string): { skip: boolean; meta: { reason: string } } => ({ skip: true, meta: { reason } });

export function paths(engine: Engine): void {
  const reason = engine.lacks();
  // Without the native program, there are no files to compare.
  const withCusp = reason === null && cusp === null ? ignored("no native cusp: name it in the variable CUSP") : {};

  describe(engine.name, reason === null ? {} : ignored(reason), () => {
    let folder: string;
    let session: Session;
    let visitor: Visitor;
    let outside: Outside;
    const programs = new Programs();
    /** Foreign hosts that the page has requested. */
    const asked = (): string[] => outside.hosts().filter((host) => !engine.asks(host));

    beforeAll(async () => {
      folder = await mkdtemp(join(inject("scratch"), "engine-"));
      for (const { name, bytes } of [ball, fine, mug]) await writeFile(join(folder, name), bytes);
      outside = await Outside.open();
      session = await begin();
      visitor = new Visitor(session);
    }, STARTS * START_MS + 20_000);

    /** Starts the browser, and starts another in its place if it does not answer in time. */
    const begin = async (): Promise<Session> => {
      for (let left = STARTS; ; ) {
        const own = await mkdtemp(join(folder, "browser-"));
        try {
          return await within(START_MS, engine.name, engine.start(own, programs, outside.port));
        } catch (error) {
          await programs.end();
          if (--left === 0) throw error;
          console.warn(`${String(error)}; ${left} more to start`);
        }
      }
    };

    afterAll(async () => {
      await programs.end();
      outside.close();
    });

    afterEach(async () => {
      expect(await session.complaints()).toEqual([]);
      expect(asked()).toEqual([]);
      // Each test is a first visit.
      await session.call(() => localStorage.clear());
    });

    const give = (name: string): Promise<void> =>
      session.give(() => document.querySelector("cusp-workbench")?.shadowRoot?.querySelector("input[type=file]") ?? document.querySelector("[part=drop] input"), join(folder, name));

    const plan = (): Promise<{ z_mm: number[]; crc32: number | null }> =>
      session.call(() => {
        const report = document.querySelector("cusp-workbench")?.result?.report;
        if (report === undefined) throw new Error("there is no plan");
        return { z_mm: report.z_mm, crc32: report.models[0]?.weights_crc32 ?? null };
      });

    /** Number of pixels that are not dark in the picture of a mask. */
    const lit = (): Promise<number> =>
      session.call((dom) => {
        const [canvas] = dom.all("canvas[data-layer]") as HTMLCanvasElement[];
        const data = canvas?.getContext("2d")?.getImageData(0, 0, canvas.width, canvas.height).data ?? [];
        let lit = 0;
        for (let at = 0; at < data.length; at += 4) if (data[at] !== 0) lit++;
        return lit;
      });

    const search = (): Promise<string> => session.call(() => location.search);

    test.each([
      ["zip", "", []],
      ["goo", "?printer=mars-4-ultra", ["--printer", "mars-4-ultra"]],
    ] as const)("the print file of a dropped model is that of the command line, byte for byte: %s", withCusp, async (format, query, options) => {
      await visitor.open(inject("address") + query);
      await visitor.drop(ball);
      await visitor.state("done");
      const { name, bytes } = await visitor.download("^Download print file");
      expect(name).toBe(`ball-cusp.${format}`);
      const own = join(folder, `own.${format}`);
      execFileSync(cusp ?? "cusp", ["slice", ...options, "-o", own, join(folder, ball.name)], { stdio: "ignore" });
      expect(bytes.equals(await readFile(own))).toBe(true);
    });

    test("what leaves this machine is seen, so each test would notice that the page asks another for something", async () => {
      // A page that navigates to another host by itself makes Firefox 140 hang occasionally, and WebKitGTK loads no picture for a `data:`
      // page.
      await session.open(`http://127.0.0.1:${outside.port}/`);
      await vi.waitFor(() => expect(asked()).toContain("another.test"), { timeout: 10_000, interval: 50 });
      // A browser may request an icon by itself.
      await visitor.open(inject("address"));
      await session.complaints();
      asked();
    });

    test("a chosen file is planned, and its masks are looked through by keyboard", async () => {
      await visitor.open(inject("address") + FEW);
      await give(ball.name);
      await visitor.state("done");
      const count = await visitor.layers();
      expect(count).toBeGreaterThan(134);
      expect(count).toBeLessThan(400);
      await visitor.click("[role=tab]", "^Mask$");
      await visitor.focus("input[type=range]", "^Layer$");
      await visitor.press(Key.HOME);
      await visitor.mask(0);
      await visitor.press(Key.ARROW_UP);
      await visitor.mask(1);
      const first = await lit();
      await visitor.set("^Layer$", String(Math.round(count / 2)));
      await visitor.mask(Math.round(count / 2) - 1);
      expect(await lit()).toBeGreaterThan(4 * first);
      const { bytes } = await visitor.download("^Download print file");
      const manifest = JSON.parse(strFromU8(unzipSync(bytes)["manifest.json"] ?? new Uint8Array())) as { layer_files: { lit_pixels: number }[] };
      expect(manifest.layer_files).toHaveLength(count);
    });

    test("settings plan again, are undone by button and by keyboard, and are in the address", async () => {
      await visitor.open(inject("address") + FEW);
      await visitor.drop(ball);
      await visitor.state("done");
      const before = await visitor.layers();
      await visitor.type("^Tolerance", "0.055");
      await expect.poll(search).toContain("tolerance=0.055");
      await visitor.settled();
      const after = await visitor.layers();
      expect(after).toBeGreaterThan(before);
      await visitor.set("^Measure errors by", "area");
      await expect.poll(search).toContain("metric=area");
      await visitor.settled();
      await visitor.click("button", "^Undo$");
      await expect.poll(search).not.toContain("metric");
      await visitor.settled();
      expect(await visitor.layers()).toBe(after);
      await visitor.focus("select", "^Measure errors by");
      // Input within a second is undone together; a busy machine takes longer.
      await expect
        .poll(async () => {
          await visitor.press(Key.CONTROL, "z");
          return search();
        })
        .not.toContain("tolerance");
      await expect.poll(() => visitor.layers()).toBe(before);
      expect(await visitor.valueOf("^Tolerance")).toBe("0.065");
    });

    test("a cancel while rays are cast leaves the plan, and so does Escape", async () => {
      await visitor.open(inject("address"));
      await give(fine.name);
      await visitor.state("done");
      const count = await visitor.layers();
      for (const by of ["button", "Escape"]) {
        // In the page itself, to avoid delay.
        await session.call((_, by) => {
          const root = document.querySelector("cusp-workbench")?.shadowRoot;
          if (!root) throw new Error("there is no page");
          const look = (): void => {
            const bar = root.querySelector(".progress");
            if (bar?.querySelector(".words")?.textContent?.trim() !== "Scanning its shape") return;
            observer.disconnect();
            document.documentElement.dataset["seen"] = by;
            if (by === "button") bar.querySelector("button")?.click();
          };
          const observer = new MutationObserver(look);
          observer.observe(root, { subtree: true, childList: true, characterData: true });
        }, by);
        await visitor.set("^Resolution", "4096");
        await expect.poll(() => session.call(() => document.documentElement.dataset["seen"]), { interval: 20 }).toBe(by);
        if (by === "Escape") await visitor.press(Key.ESCAPE);
        await visitor.state("done");
        expect(await visitor.layers()).toBe(count);
        expect(await visitor.words()).toContain(KEPT);
        await visitor.click("button", "^Undo$");
        await expect.poll(() => visitor.words()).not.toContain(KEPT);
        await visitor.state("done");
      }
    });

    test("the search for an orientation finds what the command line does, and a pose is applied and undone", withCusp, async () => {
      await visitor.open(inject("address") + FEW);
      await give(mug.name);
      await visitor.state("done");
      const before = await visitor.layers();
      await visitor.click("nav button", "Orient");
      await visitor.click("button", "^Find the best orientation$");
      const best = (): Promise<Posed[]> =>
        session.call((dom) => (dom.all("cusp-orientation")[0] as CuspOrientation | undefined)?.searched?.best.map(({ rotation, energy, metrics }) => ({ rotation, energy, metrics })) ?? []);
      await expect.poll(best, { timeout: 40_000 }).not.toEqual([]);
      const weights = Object.entries(AIMS.ranking).map(([term, weight]) => `--rank=${term}=${weight}`);
      const told = execFileSync(cusp ?? "cusp", ["orient", ...weights, "--json", join(folder, mug.name)], { encoding: "utf8" });
      const found = await best();
      expect(found.length).toBeGreaterThan(1);
      // JSON has no negative zeros.
      const plain = (JSON.parse(told) as { best: Posed[] }).best.map(({ rotation, energy, metrics }) => ({ rotation: rotation.map((it) => it + 0), energy, metrics }));
      expect(found).toEqual(plain.slice(0, found.length));
      await visitor.click("button.pose", "Orientation 3:");
      await expect.poll(() => visitor.layers()).not.toBe(before);
      await visitor.settled();
      await visitor.click("button", "^Undo$");
      await expect.poll(() => visitor.layers()).toBe(before);
    });

    test("what is painted to matter less has fewer layers; saved and loaded, the weights give the same plan", async () => {
      const brush = async (): Promise<void> => {
        await visitor.open(inject("address") + FEW);
        await visitor.drop(ball);
        await visitor.state("done");
        await visitor.click("input[type=radio]", "^Paint$");
      };
      await brush();
      const before = await plan();
      expect(before.crc32).toBeNull();
      await visitor.set("^Size", "95");
      const middle = await visitor.middle("cusp-view");
      const [left, right] = [-6, 6].map((by) => ({ ...middle, x: middle.x + by })) as [Place, Place];
      // From above, the ball's top is in the middle, with thin layers. View and brush are fetched, and do nothing before.
      await expect
        .poll(async () => {
          await visitor.focus(".scene", "");
          for (let i = 0; i < 4; i++) await visitor.press(Key.ARROW_DOWN);
          await visitor.pointer(["pointerMove", left], ["pointerDown"], ["pointerMove", right], ["pointerMove", middle], ["pointerUp"]);
          await visitor.settled();
          return (await plan()).z_mm.length;
        })
        .toBeLessThan(before.z_mm.length);
      const { name, bytes } = await visitor.download("^Save weights$");
      expect(name).toBe("ball.weights");
      // The plan of an earlier stroke may have ended the wait above.
      const facets = (ball.bytes.length - 84) / 50;
      await expect.poll(async () => (await plan()).crc32).toBe(crc32(bytes.subarray(-4 * facets)));
      const painted = await plan();
      await writeFile(join(folder, name), bytes);

      await brush();
      expect(await plan()).toEqual(before);
      await session.give(() => document.querySelector("cusp-workbench")?.shadowRoot?.querySelector("cusp-model")?.shadowRoot?.querySelector(".paint input[type=file]"), join(folder, name));
      await expect.poll(plan).toEqual(painted);
    });

    test("loaded once, the page opens and slices without a network", async () => {
      const own = await serve();
      await visitor.open(own.address);
      await session.call(async () => void (await navigator.serviceWorker.ready));
      await own.close();
      await visitor.open(`${own.address}?height=20`);
      await give(ball.name);
      await visitor.state("done");
      expect(await visitor.layers()).toBeGreaterThan(134);
    });

    test("the page speaks every language, whatever the engine's own is called", async () => {
      await visitor.open(inject("address") + FEW);
      await visitor.drop(ball);
      await visitor.state("done");
      for (const code of LANGUAGES) {
        await fetchLanguage(code);
        // The list's label depends on the language, but no other list offers languages.
        await visitor.set("English.*Deutsch|Language|Sprache|Idioma|Langue|语言", code);
        await expect.poll(() => visitor.words()).toContain(languageOf(code).texts.plan.download);
        expect(await session.call(() => document.documentElement.lang.slice(0, 2))).toBe(code);
      }
    });
  });
}
