/** Pages for a test file: one browser for all, a few tabs that they share, and no unnoticed errors at the end. */
import type { Browser, BrowserContextOptions, Page } from "playwright-core";
import { afterAll, afterEach, beforeAll, expect, inject } from "vitest";
import { launch, USUAL, visit, type Opened } from "./browser.js";
import { Tabs } from "./tabs.js";

/** @param isOwn see {@link Tabs.take} */
export type Start = (query?: string, options?: BrowserContextOptions, isOwn?: boolean) => Promise<Page>;

/** Call once at the top of a test file; returns a function that opens a page there. */
export function pages(flags?: readonly string[]): Start {
  let browser: Browser;
  let opened: Opened[] = [];
  const tabs = new Tabs();

  beforeAll(async () => {
    browser = await launch(flags);
  });

  afterAll(async () => {
    await browser.close();
  });

  afterEach(async ({ task }) => {
    const closing = opened;
    opened = [];
    await tabs.giveBack(task.result?.state === "fail");
    // In every test, no request left the page and no error went unnoticed.
    expect(closing.flatMap(({ strangers }) => strangers)).toEqual([]);
    expect(closing.flatMap(({ complaints }) => complaints)).toEqual([]);
  });

  return async (query = "", options = {}, isOwn = false) => {
    const tab = await tabs.take(browser, { ...USUAL, ...options }, isOwn);
    const it = await visit(tab, inject("address") + query);
    opened.push(it);
    return it.page;
  };
}
