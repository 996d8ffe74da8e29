/** The example shop as a customer sees it, in a real browser. */
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import type { Page } from "playwright-core";
import { afterEach, expect, test, type TestContext } from "vitest";
import { findCusp } from "../examples/shop/cusp.js";
import { pricesOf } from "../examples/shop/catalogue.js";
import { FOLDERS, type Order } from "../examples/shop/server/store.js";
import { broken } from "./axe.js";
import { state, USUAL } from "./browser.js";
import { prism, sealed, sphere } from "./solids.js";
import { expectNoLeftovers, orders, printer, resin, shops } from "./shop-open.js";
import { tabs, type TabOptions } from "./tabs.js";

const cusp = findCusp();
const { folder: newFolder, open: start, program } = shops();

const own = tabs();

afterEach(({ task }) => own.giveBack(task.result?.state === "fail"));

/** A test that needs the native program, and is skipped with a message without it. */
function withCusp(name: string, body: (cusp: string) => Promise<void>, timeout_ms?: number): void {
  const run = async (context: TestContext): Promise<void> => {
    if (cusp === null) return context.skip("no native cusp: name it in the variable CUSP, or build it in ../target");
    await body(cusp);
  };
  test(name, run, timeout_ms);
}

async function visit(address: string, options: TabOptions = {}): Promise<Page> {
  const page = await own.take({ ...USUAL, ...options });
  await page.goto(address);
  await state(page, "empty");
  return page;
}

/** Opens a model and waits until it can be ordered. */
async function opened(page: Page, model: Uint8Array): Promise<void> {
  await load(page, model);
  await state(page, "done");
  await expect.poll(() => page.locator("#order").isEnabled()).toBe(true);
}

const load = (page: Page, model: Uint8Array): Promise<void> =>
  page.evaluate((bytes) => {
    // The element shows the outcome itself.
    document.querySelector("cusp-slicer")?.load(new File([Uint8Array.from(bytes)], "small.stl")).catch(() => undefined);
  }, [...model]);

const small = sphere(4, 24).bytes;
/** Two of them cost more than the minimum. */
const ball = sphere(10, 48).bytes;

const press = (page: Page): Promise<void> => page.getByRole("button", { name: "Add to order" }).click();
/** Totals of the lines shown, in cents. */
async function totals(page: Page, list: string): Promise<number[]> {
  const texts = await page.locator(`${list} dd:last-child`).allInnerTexts();
  return texts.map((text) => Math.round(100 * Number(text.replace("€", ""))));
}

const alert = (page: Page): Promise<string> => page.locator("#problem:not(:empty)").innerText();

/** Changes the page's form data, as a customer could with the browser's tools. */
async function cheat(page: Page, change: (form: FormData) => Promise<void> | void): Promise<void> {
  await page.evaluate(`(() => {
    const change = ${change.toString()};
    const send = window.fetch;
    window.fetch = async (address, init) => {
      if (init?.body instanceof FormData) await change(init.body);
      return send(address, init);
    };
  })()`);
}

function isRunning(pid: number): boolean {
  try {
    return process.kill(pid, 0);
  } catch {
    return false;
  }
}

withCusp("a customer sees look, time, resin and price, chooses, and orders", async (cusp) => {
  const open = await start(cusp);
  const page = await visit(open.address);
  const complaints: string[] = [];
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("console", (message) => void (message.type() === "error" && complaints.push(message.text())));
  await opened(page, ball);
  expect(await page.locator("#figures").innerText()).toMatch(/^\d+\u00a0min · \d+\.\d ml$/);
  const price = page.locator("#price");
  // The minimum price of an order.
  expect(await price.innerText()).toBe("€9.00");

  await page.getByRole("slider", { name: "Quality" }).press("ArrowRight");
  await page.getByText(resin.name).click();
  await page.getByLabel("Copies").fill("99");
  expect(await page.locator("#order").isDisabled()).toBe(true);
  expect(await page.locator("#price-note").innerText()).toBe("From 1 to 20 copies, please.");
  await page.getByLabel("Copies").fill("2");
  await page.evaluate(() => {
    const slicer = document.querySelector("cusp-slicer");
    if (slicer !== null) slicer.query = `${slicer.query}&rotation=0.1,-0.2,0.05,1`;
  });
  const shown = (): Promise<{ print_time_s: number; resin_ml: number; made: unknown[] }> =>
    page.evaluate(() => {
      const { print_time_s, resin_ml, resin, options } = document.querySelector("cusp-slicer")?.result?.report ?? {};
      return { print_time_s: print_time_s ?? 0, resin_ml: resin_ml ?? 0, made: [resin?.name, options?.rotation?.length] };
    });
  await expect.poll(async () => (await shown()).made).toEqual([resin.name, 4]);
  // The formula of docs/price.md by hand: two copies, no discount, more than the minimum.
  const { print_time_s, resin_ml } = await shown();
  const { setup = 0, machine_per_h = 0, resin_per_ml = 0 } = pricesOf(printer, resin);
  const amounts = [setup, (machine_per_h * 2 * print_time_s) / 3600, resin_per_ml * 2 * resin_ml].map(Math.round);
  const total_cents = amounts.reduce((sum, amount) => sum + amount, 0);
  await expect.poll(() => price.innerText()).toBe(`€${(total_cents / 100).toFixed(2)}`);
  expect(await totals(page, "#parts")).toEqual(amounts);
  await expect.poll(() => page.locator("#verdict p").innerText()).toMatch(/^Printable/);
  // The element shows the same time in its own format.
  await expect.poll(() => page.locator("cusp-quality .head").innerText()).toContain(`, ${await page.locator("#time").innerText()}, `);

  await expect.poll(() => page.locator("#order").isEnabled()).toBe(true);
  await press(page);
  const id = await page.locator(".placed li").getAttribute("data-order");
  expect(await totals(page, ".placed li .lines")).toEqual(amounts);
  // In this pose it has findings.
  expect(await page.locator(".placed li").innerText()).toContain("waiting for a person to look at it");
  expect(await orders(open)).toEqual([id]);
  await expectNoLeftovers(open);
  const folder = join(open.folder, FOLDERS.review, id ?? "");
  const order = JSON.parse(await readFile(join(folder, "order.json"), "utf8")) as Order;
  expect(order).toMatchObject({ id, model_name: "small.stl", printer: printer.name, resin: resin.name, copies: 2, price_cents: total_cents });
  expect(order.verified.print_is_same).toBe(true);
  expect(order.verified.printability.verdict).toBe("review");

  // The native program has made the same print file of the same model.
  expect(await readFile(join(folder, "model.stl"))).toEqual(Buffer.from(ball));
  expect(complaints).toEqual([]);
}, 120_000);

withCusp("what was changed on the way is refused with the reason beside the button; the honest order is one, however often it is sent", async (cusp) => {
  const open = await start(cusp);
  const page = await visit(open.address);
  await opened(page, small);
  await cheat(page, async (form) => {
    if (document.body.dataset["honest"] !== undefined) return;
    const bytes = new Uint8Array(await (form.get("print") as Blob).arrayBuffer());
    const middle = bytes.length >> 1;
    bytes[middle] = (bytes[middle] ?? 0) ^ 1;
    form.set("print", new Blob([bytes], { type: "application/octet-stream" }));
  });
  await press(page);
  await expect.poll(() => alert(page)).toBe("The print file was refused: it is not the print file that this plan gives.");
  expect(await orders(open)).toEqual([]);
  await page.evaluate(() => void (document.body.dataset["honest"] = ""));
  await page.route("**/orders", async (route) => {
    await route.fetch();
    await route.abort();
  }, { times: 1 });
  await press(page);
  expect(await alert(page)).toBe("The shop does not answer. Please try again: this will be one order and not two.");
  const taken = await orders(open);
  expect(taken).toHaveLength(1);
  await press(page);
  await page.locator(".placed li").waitFor();
  expect(await page.locator(".placed li").getAttribute("data-order")).toBe(taken[0]);
  expect(await orders(open)).toEqual(taken);
  // Ordering the same again is another order, since the first is confirmed.
  await press(page);
  await expect.poll(() => page.locator(".placed li").count()).toBe(2);
  expect(await orders(open)).toHaveLength(2);
  await expectNoLeftovers(open);
});

/** Expects no accessibility faults and no overflow, in a wide light and a narrow dark page. */
async function fits(page: Page): Promise<void> {
  for (const [colorScheme, width] of [["dark", 390], ["light", 1280]] as const) {
    await page.emulateMedia({ colorScheme });
    await page.setViewportSize({ width, height: 844 });
    expect(await broken(page), colorScheme).toEqual([]);
    expect(await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth)).toBe(0);
  }
}

test("what cannot be ordered the page says before, and why: an upload or a model that is too large, a sealed hollow; it fits light and wide or dark and narrow", async () => {
  const open = await start("never called", { most_bytes: { plan: 1e6, model: 1e4, print: 1e7 } });
  const page = await visit(open.address, { reducedMotion: "reduce" });
  await fits(page);
  await opened(page, small);
  await fits(page);
  await press(page);
  expect(await alert(page)).toBe("The model is larger than the 0.01 MB that this shop takes.");
  expect(await orders(open)).toEqual([]);
  await expectNoLeftovers(open);
  await load(page, sealed(10, 2));
  await state(page, "done");
  await expect.poll(() => page.locator("#verdict p").innerText()).toBe("Not printable like this.");
  expect(await page.locator("#verdict [data-code=trap]").innerText()).toBe("Liquid resin would be locked in a hollow; it needs a hole.");
  expect(await page.locator("#order").isDisabled()).toBe(true);
  await load(page, prism(100, 2).bytes);
  await state(page, "error");
  const offers = page.locator("cusp-slicer .offers button");
  await offers.first().waitFor();
  expect(await offers.allInnerTexts()).toEqual([expect.stringMatching(/^Scale to /)]);
  expect(await page.locator("#price-note").innerText()).toBe("The price comes with your model.");
});

test("a check that fails is made again with the next choice, which no undo takes back", async () => {
  const open = await start("never called");
  const page = await visit(open.address);
  await page.evaluate(() => {
    const slicer = document.querySelector("cusp-slicer")?.slicer;
    if (slicer === undefined) throw new Error("no slicer");
    const { check } = slicer;
    document.body.dataset["fails"] = "";
    const value: typeof check = (limits) => document.body.dataset["fails"] === "" ? Promise.reject(new Error("out of memory")) : check.call(slicer, limits);
    Object.defineProperty(slicer, "check", { value });
  });
  await page.getByRole("button", { name: "Try our goblet" }).click();
  await expect.poll(() => page.evaluate(() => document.querySelector("cusp-slicer")?.model?.name)).toBe("goblet.stl");
  // A smaller model is quicker to plan.
  await load(page, small);
  const verdict = page.locator("#verdict p");
  await expect.poll(() => verdict.innerText()).toMatch(/^This could not be checked here\./);
  expect(await page.locator("#order").isDisabled()).toBe(true);
  await page.evaluate(() => delete document.body.dataset["fails"]);
  await page.getByText("Large", { exact: true }).click();
  await expect.poll(() => verdict.innerText()).toMatch(/^Printable/);
  await expect.poll(() => page.locator("#order").isEnabled()).toBe(true);
  // Undo does not revert choices made by the page's own buttons.
  await page.getByRole("slider", { name: "Quality" }).press("ArrowRight");
  await state(page, "done");
  await page.getByText(resin.name).click();
  await page.evaluate(() => document.querySelector("cusp-slicer")?.undo());
  await page.evaluate(() => document.querySelector("cusp-slicer")?.plan());
  const { printer, resin: poured } = await page.evaluate(() => {
    const { report } = document.querySelector("cusp-slicer")?.result ?? {};
    return { printer: report?.printer, resin: report?.resin.name };
  });
  expect([printer, poured]).toEqual(["saturn-3-ultra", resin.name]);
});

test("an order that is cancelled leaves nothing behind", async () => {
  const noted = join(await newFolder("noted"), "pid");
  const slow = await program(`require("node:fs").writeFileSync(${JSON.stringify(noted)}, String(process.pid)); setInterval(() => {}, 1000);`);
  const open = await start(slow);
  const page = await visit(open.address);
  await opened(page, small);
  await press(page);
  await expect.poll(() => readFile(noted, "utf8").catch(() => "")).toMatch(/^\d+$/);
  const pid = Number(await readFile(noted, "utf8"));
  expect(isRunning(pid)).toBe(true);
  await page.locator("#cancel").click();
  expect(await page.locator("#standing:not(:empty)").innerText()).toBe("Cancelled. Nothing was ordered.");
  await expect.poll(() => isRunning(pid)).toBe(false);
  await expectNoLeftovers(open);
  expect(await orders(open)).toEqual([]);
});
