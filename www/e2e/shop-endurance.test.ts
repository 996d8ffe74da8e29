/**
 * Ten customers order at once while the server and its verifier are killed repeatedly: no order is lost, taken twice or taken unverified.
 * Runs until each kind of kill has happened, or for five minutes with `npm run endurance`.
 */
import { mkdir, mkdtemp, readdir, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { setTimeout as wait } from "node:timers/promises";
import { afterEach, beforeEach, expect, test } from "vitest";
import { findCusp } from "../examples/shop/cusp.js";
import { FOLDERS } from "../examples/shop/server/store.js";
import { FILES } from "../examples/shop/server/upload.js";
import { freePort } from "./serve.js";
import { Customers } from "./shop-customers.js";
import { goodOf, type Good } from "./shop-goods.js";
import { expectNoLeftovers, orders } from "./shop-open.js";
import { ShopProcess, type Usage } from "./shop-process.js";
import { cup, prism, sealed, sphere } from "./solids.js";
import { megabytes } from "./usage.js";

const SECONDS = process.env["ENDURANCE"] === undefined ? 0 : 300;
/** Number of orders taken before each kill. */
const BEFORE_KILL = SECONDS === 0 ? 2 : 5;
/** After this many orders, everything made only once exists. */
const WARM_ORDERS = 25;

interface Kill {
  what: "cusp" | "shop";
  signal: "SIGKILL" | "SIGTERM";
}

/** Kinds of kills, in turn. */
const KILLS: readonly [Kill, ...Kill[]] = [
  { what: "cusp", signal: "SIGKILL" },
  { what: "cusp", signal: "SIGTERM" },
  { what: "shop", signal: "SIGTERM" },
  { what: "shop", signal: "SIGKILL" },
];

/** Kills in turn and restarts the server, until the time is over and each kind has happened. Returns the number of kills. */
async function kill(kills: readonly Kill[], shop: ShopProcess, customers: Customers, isOver: () => boolean): Promise<number> {
  let turn = 0;
  for (; turn < kills.length || !isOver(); turn++) {
    const { what, signal } = kills[turn % kills.length] ?? KILLS[0];
    const before = customers.taken.size;
    while (customers.taken.size < before + BEFORE_KILL) await wait(5);
    if (what === "cusp") await shop.endCusp(signal);
    else {
      // On SIGTERM the server ends by itself, whatever customers do.
      expect(await shop.end(signal)).toBe(signal === "SIGTERM" ? 0 : null);
      await shop.start();
    }
  }
  return turn;
}

/** Runs customers and kills for a while. Returns the number of kills. */
async function load(seconds: number, kills: readonly Kill[], shop: ShopProcess, customers: Customers): Promise<number> {
  const end = performance.now() + 1000 * seconds;
  let isDone = false;
  const killing = kill(kills, shop, customers, () => performance.now() > end).finally(() => (isDone = true));
  const [killed] = await Promise.all([killing, customers.order(() => isDone)]);
  return killed;
}

let root: string;
let shop: ShopProcess | null = null;

beforeEach(async () => {
  root = await mkdtemp(join(tmpdir(), "cusp-shop-endurance-"));
});

afterEach(async () => {
  await shop?.end("SIGKILL");
  shop = null;
  await rm(root, { recursive: true });
});

async function newFolder(name: string): Promise<string> {
  await mkdir(join(root, name));
  return join(root, name);
}

function show(orders: number, { heap, rss, files }: Usage): void {
  console.log(`${orders} orders: heap ${megabytes(heap)} MB, process ${megabytes(rss)} MB, ${files} open files`);
}

test("orders of ten customers survive kills of the shop and of what it runs", async (context) => {
  const cusp = findCusp();
  if (process.platform !== "linux" || cusp === null) return context.skip("needs Linux and a native cusp: name it in the variable CUSP, or build it in ../target");
  const models = [sphere(3, 24).bytes, prism(6, 5).bytes, cup(8, 6, 2), prism(4, 9).bytes, sphere(6, 96).bytes];
  const goods = await Promise.all(models.map((model, i) => goodOf(cusp, join(root, `good-${i}`), model, i + 1)));
  const unprintable = await goodOf(cusp, join(root, "unprintable"), sealed(8, 2), 1);
  const isRejected = ({ verified }: Good): boolean => verified.printability.verdict === "reject";
  expect([...goods, unprintable].map(isRejected)).toEqual([...goods.map(() => false), true]);

  const folder = await newFolder("shop");
  const temporary = await newFolder("temporary");
  shop = new ShopProcess(cusp, await freePort(), { shop: folder, pages: await newFolder("pages"), temporary });
  await shop.start();
  const customers = new Customers(shop.address, goods, unprintable);
  const both = await load(SECONDS / 2, KILLS, shop, customers);
  // A long-lived server, whose verifier is killed as before.
  await shop.end("SIGTERM");
  await shop.start();
  const enough = customers.taken.size + WARM_ORDERS;
  await customers.order(() => customers.taken.size > enough);
  const early = await shop.usage();
  show(customers.taken.size, early);
  const ofCusp = await load(SECONDS / 2, KILLS.filter(({ what }) => what === "cusp"), shop, customers);
  const late = await shop.usage();
  show(customers.taken.size, late);
  console.log(`${both} kills, of the shop and of cusp, then ${ofCusp} of cusp; answers ${JSON.stringify(customers.answers)}`);

  // Each order taken is stored once, as sent, with the native program's result.
  const taken = [...customers.taken.values()].map(({ order }) => order.id ?? "");
  expect((await orders({ folder })).sort()).toEqual(taken.sort());
  for (const { good, order } of customers.taken.values()) {
    const { status: _status, state = "accepted", ...kept } = order;
    const read = (name: string): Promise<Buffer> => readFile(join(folder, FOLDERS[state], order.id ?? "", name));
    expect(state).toBe(good.verified.printability.verdict === "review" ? "review" : "accepted");
    expect(JSON.parse((await read("order.json")).toString())).toEqual(kept);
    expect(order.verified).toEqual(good.verified);
    for (const [part, name] of Object.entries(FILES)) {
      expect((await read(name)).equals(good.files[part as keyof typeof FILES]), `${order.id}: ${name}`).toBe(true);
    }
  }
  await expectNoLeftovers({ folder });
  expect(await readdir(temporary)).toEqual([]);
  // Some orders failed by a kill, some met no server, and some were refused.
  for (const answer of ["failed", "none", "plan-refused", "print-refused", "price-differs", "not-printable"]) {
    expect(customers.answers[answer], answer).toBeGreaterThan(0);
  }
  // A kill fails one order; nothing else fails any.
  expect(customers.answers["failed"]).toBeLessThanOrEqual(both + ofCusp);
  expect(late.heap).toBeLessThan(1.1 * early.heap);
  expect(late.files).toBeLessThanOrEqual(early.files + 10);
  expect(await shop.end("SIGTERM")).toBe(0);
  expect(shop.said).not.toContain("Warning");
}, (SECONDS + 120) * 1000);
