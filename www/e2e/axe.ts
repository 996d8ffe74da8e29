/** Checks a page for accessibility. */
import axe from "axe-core";
import type { Page } from "playwright-core";

/**
 * Rules broken, with the offending elements.
 *
 * @param rules by default all
 */
export async function broken(page: Page, rules?: readonly string[]): Promise<string[]> {
  // Evaluated, not added as a script, since the page's policy forbids inline scripts.
  if (!(await page.evaluate(() => "axe" in window))) await page.evaluate(axe.source);
  const { violations } = await page.evaluate(
    (rules) => (window as unknown as { axe: { run(options: axe.RunOptions): Promise<axe.AxeResults> } }).axe.run({ resultTypes: ["violations"], ...(rules !== null && { runOnly: [...rules] }) }),
    rules ?? null,
  );
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 120)).join(" | ")}`);
}
