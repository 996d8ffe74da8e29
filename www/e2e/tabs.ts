/**
 * Tabs that tests take and give back. The next test with the same options goes on in the same tab, whose process has
 * compiled the page's scripts and its WebAssembly already: there a page opens and plans in half the time.
 */
import type { Browser, BrowserContextOptions, Page } from "playwright-core";

/** What tests listen to on a page. */
const HEARD = ["request", "pageerror", "console", "download"] as const;

export class Tabs {
  readonly #idle = new Map<string, Page[]>();
  readonly #taken: { page: Page; options: string | null }[] = [];

  /**
   * An empty tab, for one test.
   *
   * @param isOwn for a test that leaves traces in the tab itself, such as scripts for every page or an emulated theme:
   * no other test had the tab, and none will
   */
  async take(browser: Browser, options: BrowserContextOptions, isOwn = false): Promise<Page> {
    const key = isOwn ? null : JSON.stringify(options);
    const idle = key === null ? undefined : this.#idle.get(key)?.pop();
    const page = idle ?? (await (await browser.newContext(options)).newPage());
    this.#taken.push({ page, options: key });
    return page;
  }

  /** After each test; after a failed one its tabs are closed, since nobody knows what it left there. */
  async giveBack(hasFailed: boolean): Promise<void> {
    await Promise.all(
      this.#taken.splice(0).map(async ({ page, options }) => {
        if (hasFailed || options === null) return page.context().close();
        await empty(page);
        this.#idle.set(options, [...(this.#idle.get(options) ?? []), page]);
      }),
    );
  }
}

/** Ends the page in a tab, with its workers and all that it stored. */
async function empty(page: Page): Promise<void> {
  for (const event of HEARD) page.removeAllListeners(event);
  await page.unrouteAll({ behavior: "ignoreErrors" });
  await page.evaluate(() => {
    localStorage.clear();
    sessionStorage.clear();
  });
  await page.context().clearCookies();
  await page.goto("about:blank");
  // Away from what the next page shows there.
  await page.mouse.move(0, 0);
}
