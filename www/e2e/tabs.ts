/**
 * A pool of tabs for tests. The next test with the same options reuses the tab, whose process has compiled the page's scripts and
 * WebAssembly: a page then opens and plans in half the time.
 */
import type { Browser, BrowserContextOptions, Page } from "playwright-core";
import { launch } from "./browser.js";

/** Page events with listeners of tests. */
const HEARD = ["request", "response", "pageerror", "console", "download"] as const;

export interface TabOptions extends BrowserContextOptions {
  /** Runs in the page before anything else. */
  before?: () => void;
}

export class Tabs {
  readonly #launch: () => Promise<Browser>;
  #browser: Promise<Browser> | null = null;
  readonly #idle = new Map<string, Page[]>();
  readonly #taken: { page: Page; key: string; scripts: { dispose(): Promise<void> }[] }[] = [];

  constructor(launch: () => Promise<Browser>) {
    this.#launch = launch;
  }

  /** An empty tab, for one test. */
  async take({ before, viewport, colorScheme = "light", reducedMotion = "no-preference", ...options }: TabOptions): Promise<Page> {
    const key = JSON.stringify(options);
    const page = this.#idle.get(key)?.pop() ?? (await this.#open(options));
    const scripts = before === undefined ? [] : [await page.addInitScript(before)];
    this.#taken.push({ page, key, scripts });
    if (viewport) await page.setViewportSize(viewport);
    await page.emulateMedia({ colorScheme, forcedColors: "none", reducedMotion });
    return page;
  }

  /** Called after each test. After a failed test, closes its tabs, whose state is unknown. */
  async giveBack(hasFailed: boolean): Promise<void> {
    await Promise.all(
      this.#taken.splice(0).map(async ({ page, key, scripts }) => {
        if (hasFailed) return page.context().close();
        await Promise.all(scripts.map((script) => script.dispose()));
        await empty(page);
        this.#idle.set(key, [...(this.#idle.get(key) ?? []), page]);
      }),
    );
  }

  async #open(options: BrowserContextOptions): Promise<Page> {
    const browser = await (this.#browser ??= this.#launch());
    return (await browser.newContext(options)).newPage();
  }
}

const all = new Map<string, Tabs>();

/** Tabs shared by all test files of this process, whose browser ends with it. */
export function tabs(flags?: readonly string[]): Tabs {
  const key = String(flags);
  const those = all.get(key) ?? new Tabs(() => launch(flags));
  all.set(key, those);
  return those;
}

/** Ends the page in a tab, with its workers and storage. */
async function empty(page: Page): Promise<void> {
  for (const other of page.context().pages()) if (other !== page) await other.close();
  for (const event of HEARD) page.removeAllListeners(event);
  await page.unrouteAll({ behavior: "ignoreErrors" });
  await page.evaluate(() => sessionStorage.clear());
  const { origin } = new URL(page.url());
  await page.goto("about:blank");
  const devtools = await page.context().newCDPSession(page);
  await devtools.send("Storage.clearDataForOrigin", { origin, storageTypes: "all" });
  await devtools.detach();
  await page.context().clearCookies();
  await page.context().clearPermissions();
  // Keeps the pointer away from the next page's content.
  await page.mouse.move(0, 0);
}
