/** The 3-D view in the element: profile, plan and numbers follow the model while it is turned. */
import type { Page } from "playwright-core";
import { expect, test } from "vitest";
import { layers, settled, state } from "./browser.js";
import { pages } from "./pages.js";
import { SOFTWARE_GL } from "./view-pages.js";

const start = pages(SOFTWARE_GL);

const said = (page: Page): Promise<string> =>
  page.locator("cusp-view #state").evaluate((it) => (it.textContent ?? "").replace(/\s+/g, " ").trim());

async function example(): Promise<Page> {
  const page = await start("?backend=cpu&rays=512");
  await page.getByRole("button", { name: "Try the example" }).click();
  await state(page, "done");
  await page.waitForSelector("cusp-view");
  return page;
}

test("turned by keyboard, the model is planned anew as it stands; undo and a button turn it back", async () => {
  const page = await example();
  const upright = await layers(page);
  await page.getByRole("radio", { name: "Turn the model" }).click();
  await page.locator("cusp-view .scene").focus();
  for (let i = 0; i < 18; i++) await page.keyboard.press("ArrowUp");
  await settled(page);
  await expect.poll(() => layers(page)).not.toBe(upright);
  const lying = await layers(page);
  const { searchParams } = new URL(page.url());
  const rotation = (searchParams.get("rotation") ?? "").split(",").map(Number);
  expect(Math.hypot(...rotation)).toBeCloseTo(1, 4);
  // A quarter turn about one axis.
  expect(Math.abs(rotation[3] ?? 0)).toBeCloseTo(Math.SQRT1_2, 3);
  await expect.poll(() => said(page)).toMatch(/ × 26\.\d mm, /);

  await page.getByRole("button", { name: "As in the file" }).click();
  await settled(page);
  expect(await layers(page)).toBe(upright);
  expect(new URL(page.url()).searchParams.has("rotation")).toBe(false);
  await page.getByRole("button", { name: "Undo" }).click();
  await settled(page);
  expect(await layers(page)).toBe(lying);
});

test("while the model is held, numbers and profile follow by previews; let go, it is planned", async () => {
  const page = await example();
  const upright = await layers(page);
  const tell = (rotation: number[], final: boolean): Promise<void> =>
    page.evaluate(
      ([rotation, final]) => {
        const root = document.querySelector("cusp-workbench")?.shadowRoot?.querySelector("cusp-model")?.shadowRoot;
        root?.querySelector("cusp-view")?.dispatchEvent(new CustomEvent("cusp-rotate", { detail: { rotation, final } }));
      },
      [rotation, final] as const,
    );
  await tell([Math.SQRT1_2, 0, 0, Math.SQRT1_2], false);
  await expect.poll(() => layers(page)).not.toBe(upright);
  // A preview is not a task: nothing is busy, and no plan was made.
  await state(page, "done");
  expect(new URL(page.url()).searchParams.has("rotation")).toBe(false);
  const previewed = await layers(page);
  await tell([Math.SQRT1_2, 0, 0, Math.SQRT1_2], true);
  await settled(page);
  expect(new URL(page.url()).searchParams.has("rotation")).toBe(true);
  // Planned from the same facets; rays only leave out those that lie inside.
  expect(Math.abs((await layers(page)) - previewed)).toBeLessThan(0.02 * previewed);
});

test("beside the chart, heights are where the chart has them", async () => {
  const page = await example();
  const beside = page.getByRole("switch", { name: "Beside the profile" });
  await expect.poll(() => beside.isChecked()).toBe(true);
  /** Upper edge and plate of the model on the screen, and those of the chart's plot. */
  const edges = (): Promise<number[]> =>
    page.evaluate(async () => {
      const root = document.querySelector("cusp-workbench")?.shadowRoot;
      const panel = root?.querySelector("cusp-model")?.shadowRoot;
      const view = panel?.querySelector("cusp-view");
      const over = root?.querySelector("cusp-chart")?.shadowRoot?.querySelector(".u-over")?.getBoundingClientRect();
      const aligned = panel?.querySelector<HTMLElement>("[role=switch]");
      if (!view || !over || !aligned) throw new Error("there is no view beside a chart");
      const frame = new Promise<{ top_px: number; bottom_px: number }>((resolve) => {
        // It reports where heights are when it is aligned again.
        const hear = (event: Event): void => {
          const { detail } = event as CustomEvent<{ top_px: number; bottom_px: number } | null>;
          if (detail === null) return aligned.click();
          view.removeEventListener("cusp-frame", hear);
          resolve(detail);
        };
        view.addEventListener("cusp-frame", hear);
        aligned.click();
      });
      const { top } = view.getBoundingClientRect();
      const { top_px, bottom_px } = await frame;
      return [top + top_px - over.top, top + bottom_px - over.bottom];
    });
  for (const distance of await edges()) expect(Math.abs(distance)).toBeLessThan(1);
});
