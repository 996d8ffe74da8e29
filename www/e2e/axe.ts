/** Checks a page for accessibility. */
import axe from "axe-core";
import type { Page } from "playwright-core";

/** Rules broken, with the elements that break them. */
export async function broken(page: Page): Promise<string[]> {
  // Evaluated, not added as a script: the page's policy allows no inline scripts.
  await page.evaluate(axe.source);
  const { violations } = await page.evaluate(() =>
    (window as unknown as { axe: { run(): Promise<axe.AxeResults> } }).axe.run(),
  );
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 120)).join(" | ")}`);
}
