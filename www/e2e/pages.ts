/** Pages for a test file, in tabs shared with others. Fails on unexpected errors at the end. */
import type { Page } from "playwright-core";
import { afterEach, expect, inject } from "vitest";
import { USUAL, visit, type Opened } from "./browser.js";
import { tabs, type TabOptions } from "./tabs.js";

export type Start = (query?: string, options?: TabOptions) => Promise<Page>;

/** Call once at the top of a test file; returns a function that opens a page there. */
export function pages(flags?: readonly string[]): Start {
  const own = tabs(flags);
  let opened: Opened[] = [];

  afterEach(async ({ task }) => {
    const closing = opened;
    opened = [];
    await own.giveBack(task.result?.state === "fail");
    // In every test, no request left the page and no error went unnoticed.
    expect(closing.flatMap(({ strangers }) => strangers)).toEqual([]);
    expect(closing.flatMap(({ complaints }) => complaints)).toEqual([]);
  });

  return async (query = "", options = {}) => {
    const it = await visit(await own.take({ ...USUAL, ...options }), inject("address") + query);
    opened.push(it);
    return it.page;
  };
}
