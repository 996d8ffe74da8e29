/** Cancelling at every stage, and the state afterwards. */
import type { Page } from "playwright-core";
import { expect, test } from "vitest";
import { download, drop, layers, maskOf, openPanel, state, words } from "./browser.js";
import { pages } from "./pages.js";
import { sphere } from "./solids.js";

const start = pages();

// Enough facets and rays to observe each stage.
const heavy = { name: "heavy.stl", bytes: sphere(10, 700).bytes };

/** Presses Cancel as soon as the progress bar shows this stage; runs in the page to avoid delay. */
async function cancelWhen(page: Page, stage: string): Promise<void> {
  await page.evaluate((wanted) => {
    const root = document.querySelector("cusp-workbench")?.shadowRoot;
    if (!root) throw new Error("there is no page");
    const press = (): void => {
      const bar = root.querySelector(".progress");
      if (bar?.querySelector(".words")?.textContent?.trim() !== wanted) return;
      observer.disconnect();
      document.documentElement.dataset["cancelled"] = wanted;
      bar.querySelector("button")?.click();
    };
    const observer = new MutationObserver(press);
    observer.observe(root, { subtree: true, childList: true, characterData: true });
    press();
  }, stage);
}

const cancelled = (page: Page): Promise<string | null> => page.locator("html").getAttribute("data-cancelled");

test("a cancel answers at every stage and leaves what was there before, by button and by Escape", async () => {
  const page = await start();
  await cancelWhen(page, "Reading the model");
  await drop(page, heavy);
  await expect.poll(() => cancelled(page)).toBe("Reading the model");
  await state(page, "empty");

  await drop(page, heavy);
  await state(page, "done");
  const count = await layers(page);
  await cancelWhen(page, "Scanning its shape");
  await page.getByLabel("Resolution").selectOption("4096");
  await expect.poll(() => cancelled(page)).toBe("Scanning its shape");
  await state(page, "done");
  expect(await layers(page)).toBe(count);
  await openPanel(page, "Mask");
  const slider = page.getByRole("slider", { name: "Layer", exact: true });
  await slider.focus();
  await page.keyboard.press("Home");
  await maskOf(page, 0);

  await cancelWhen(page, "Drawing the layers");
  await page.getByRole("button", { name: /Download print file/ }).click();
  await expect.poll(() => words(page)).toContain("The download was cancelled.");
  await state(page, "done");
  expect((await download(page)).suggestedFilename()).toBe("heavy-cusp.zip");

  // Pressed in the page after some turns of its event loop, of which a frozen page has none. A busy machine might look too late, after the
  // plan.
  await page.evaluate(() => {
    let turns = 0;
    const counting = setInterval(() => {
      if (document.querySelector("cusp-workbench[state=busy]") === null || ++turns < 4) return;
      clearInterval(counting);
      document.body.dispatchEvent(new KeyboardEvent("keydown", { key: "Escape", bubbles: true, composed: true }));
    }, 10);
  });
  await page.getByRole("button", { name: "Plan again" }).click();
  await expect.poll(() => words(page)).toContain("This is the last plan that worked");
  await state(page, "done");
  await page.getByRole("button", { name: "Plan again" }).click();
  await expect.poll(() => words(page)).not.toContain("This is the last plan that worked");
  await state(page, "done");
});
