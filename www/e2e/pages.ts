/** Pages for a test file: one browser for all, a fresh context for each page, and no unnoticed errors at the end. */
import type { Browser, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, expect, inject } from "vitest";
import { launch, open, type Opened } from "./browser.js";

export type Start = (query?: string, options?: Parameters<typeof open>[2]) => Promise<Page>;

/** Call once at the top of a test file; returns a function that opens a page there. */
export function pages(flags: readonly string[] = []): Start {
  let browser: Browser;
  let opened: Opened[] = [];

  beforeAll(async () => {
    browser = await launch(flags);
  });

  afterAll(async () => {
    await browser.close();
  });

  afterEach(async () => {
    const closing = opened;
    opened = [];
    await Promise.all(closing.map(({ page }) => page.context().close()));
    // In every test, no request left the page and no error went unnoticed.
    expect(closing.flatMap(({ strangers }) => strangers)).toEqual([]);
    expect(closing.flatMap(({ complaints }) => complaints)).toEqual([]);
  });

  return async (query = "", options = {}) => {
    const it = await open(browser, inject("address") + query, options);
    opened.push(it);
    return it.page;
  };
}
