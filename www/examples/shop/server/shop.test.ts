/** Orders that the server takes or refuses, without a browser or the native program. */
import { randomUUID } from "node:crypto";
import { once } from "node:events";
import { mkdir, open as openFile, readdir, readFile, readlink, rm, writeFile, type FileHandle } from "node:fs/promises";
import { request as connect } from "node:http";
import { connect as openSocket } from "node:net";
import { join, relative } from "node:path";
import { expect, test, vi } from "vitest";
import { expectNoLeftovers, incoming, orders, ordersIn, printer, resin, send, shops, type Answer, type OpenShop, type Sent } from "../../../e2e/shop-open.js";
import { ELEMENT_POLICY } from "../../../e2e/static.js";
import { languageOf } from "../../../src/texts/index.js";
import { FIXED, LIMITS, pricesOf } from "../catalogue.js";
import { time } from "../page/format.js";
import { main as review } from "../review.js";
import { clientOf } from "./client.js";

/** Replaces the built page. */
async function onePage(root: string): Promise<string> {
  const folder = join(root, "page");
  await mkdir(folder);
  await writeFile(join(folder, "index.html"), "<!doctype html><title>Shop</title>");
  return folder;
}

const { folder: newFolder, open: start, program } = shops(onePage);

const WARNINGS = [{ code: "black-layers", detail: { layers: 2, from_mm: 1 } }];
const VERDICT = {
  ...{ layers: 3, max_error: 0.05, tolerance: 0.06, print_time_s: 3600, resin_ml: 10, print_is_same: true },
  warnings: WARNINGS,
};
/** Answer of the stand-in. It computes a price from its arguments and the prices file in the folder, by a made-up formula. */
const answering = (verdict: string): string => `{
  const read = (flag) => JSON.parse(require("node:fs").readFileSync(process.argv[process.argv.indexOf(flag) + 1], "utf8"));
  const prices = read("--prices");
  const copies = Number(process.argv[process.argv.indexOf("--copies") + 1]);
  const lines = [
    { kind: "setup", amount: prices.setup },
    { kind: "machine", amount: prices.machine_per_h * copies },
    { kind: "resin", amount: prices.resin_per_ml * 10 * copies },
  ];
  const price = { currency: "EUR", digits: 2, copies, finish: null, lines, total: lines.reduce((sum, { amount }) => sum + amount, 0) };
  const findings = "${verdict}" === "ok" ? [] : [{ code: "trap", severity: "${verdict}" }];
  const models = [{ findings, counts: findings.map(({ code }) => ({ code, found: 1 })) }];
  const printability = { verdict: "${verdict}", models };
  const plate = { ...${JSON.stringify(VERDICT)}, printability, limits: read("--limits") };
  console.log(JSON.stringify({ plates: [plate], price }));
  if ("${verdict}" === "reject") process.exitCode = 1;
}`;
const HONEST = answering("ok");
/** For one copy: 450 for set-up, 320 for an hour, 380 for 10 ml. */
const ONE_CENTS = 1150;
const { note: _note, swatch: _swatch, ml_cents: _cents, ...cured } = resin;
const OPTIONS = { ...FIXED, printer: printer.name, resin: cured, tolerance: 0.06 };

interface Changed extends Partial<Sent> {
  options?: object;
  print?: Blob;
  fields?: Readonly<Record<string, string | Blob>>;
}

/** A stand-in for the native program that counts its calls in a file. */
async function counting(): Promise<{ cusp: string; count(): Promise<number> }> {
  const log = join(await newFolder("scratch"), "asked.log");
  const cusp = await program(`require("node:fs").appendFileSync(${JSON.stringify(log)}, ".");\n${HONEST}`);
  return { cusp, count: async () => (await readFile(log, "utf8").catch(() => "")).length };
}

/** Posts an order without a browser, honest unless `changed` says otherwise. */
function post({ address }: OpenShop, { options, print, fields, key = randomUUID(), ...sent }: Changed = {}): Promise<Answer> {
  const plan = new Blob([JSON.stringify({ ...VERDICT, options: { ...OPTIONS, ...options } })], { type: "application/json" });
  const file = new Blob(["solid"], { type: "model/stl" });
  const price_cents = String(ONE_CENTS);
  return send(address, { key, parts: { copies: "1", price_cents, plan, model: file, print: print ?? file, ...fields }, ...sent });
}

const from = (client: string): NonNullable<Sent["headers"]> => ({ "x-forwarded-for": client });

/** Starts an upload and stalls until the server ends it. Returns the status of the answer; null if there is none. */
function slowly({ address }: OpenShop, client: string): Promise<number | null> {
  const headers = { "content-type": "multipart/form-data; boundary=x", "content-length": 1000, "idempotency-key": randomUUID(), ...from(client) };
  const request = connect(`${address}orders`, { method: "POST", headers });
  request.write("--x\r\n");
  return new Promise((resolve) => {
    request.once("response", ({ statusCode }) => resolve(statusCode ?? null)).once("error", () => resolve(null));
  });
}

test("every answer comes under the policy that the guide names", async () => {
  const { address } = await start("never called");
  const guide = await readFile(new URL("../../../../docs/embed.md", import.meta.url), "utf8");
  expect(guide).toContain(ELEMENT_POLICY);
  for (const path of ["", "nowhere", "..%2fserver%2fshop.ts"]) {
    const { headers } = await fetch(address + path);
    expect(headers.get("content-security-policy")).toMatch(new RegExp(`^${ELEMENT_POLICY.replaceAll(/[.*+?^${}()|[\]\\]/g, "\\$&")};`));
    expect(headers.get("x-content-type-options")).toBe("nosniff");
  }
  expect((await fetch(`${address}..%2fserver%2fshop.ts`)).status).toBe(404);
});

test("options that the shop does not offer are refused before anything is run", async () => {
  const open = await start("never called");
  const refused = { status: 422, code: "option-refused" };
  for (const options of [
    { rays: 8192 },
    { antialias: 8 },
    { bin_mm: 0.0001 },
    { pixels: [60000, 60000], pitch_mm: 0.001 },
    { printer: "somebody-elses" },
    { printer: null },
    { printer: { name: printer.name, pixels: [100, 100], pitch_um: [500, 500], volume_mm: [50, 50, 50] } },
    { resin: { ...cured, exposure_s: 0.1 } },
    { resin: { ...cured, exposures: [[0.05, 0.1]] } },
    { resin: null },
    { tolerance: 5 },
    { tolerance: "0.06" },
    { height_mm: 1e6 },
    { rotation: [0, 0, 0] },
    { layer_max_mm: 0.2 },
    { planner: { kind: "uniform", layer_mm: 0.15 } },
    { format: "png" },
    { backend: "gpu" },
    { ranges: [{ from_mm: 0, to_mm: 1, layer_min_mm: 0.2, layer_max_mm: 0.2 }] },
    { no_such_option: 1 },
  ]) {
    const answer = await post(open, { options });
    expect(answer, JSON.stringify(options)).toMatchObject(refused);
    expect(answer.message).toContain(Object.keys(options).at(0));
  }
  for (const plan of ["no JSON", "[]", "{}", `{"options": []}`]) {
    expect(await post(open, { fields: { plan: new Blob([plan], { type: "application/json" }) } })).toMatchObject({ status: 422, code: "not-a-plan" });
  }
  await expectNoLeftovers(open);
});

test("what is no order is refused", async () => {
  const open = await start(await program(HONEST));
  expect(await post(open)).toMatchObject({ status: 201 });
  const file = new Blob(["x"], { type: "model/stl" });
  const fields: readonly Readonly<Record<string, string | Blob>>[] = [
    { copies: "0" },
    { copies: "1.5" },
    { copies: "1e9" },
    { price_cents: "-1" },
    { "../../evil": file },
    { model: "text" },
  ];
  for (const field of fields) expect(await post(open, { fields: field }), JSON.stringify(field)).toMatchObject({ status: 400, code: "bad-order" });
  for (const key of ["", "1", `${randomUUID()}/../..`]) {
    expect(await post(open, { key }), key).toMatchObject({ status: 400, code: "bad-order", message: expect.stringContaining("UUID") });
  }
  const body = (type: string, text: string): Promise<Response> =>
    fetch(`${open.address}orders`, { method: "POST", body: text, headers: { "content-type": type, "idempotency-key": randomUUID() } });
  for (const [type, text] of [
    ["application/json", "{}"],
    ["multipart/form-data", ""],
    ["multipart/form-data; boundary=x", "--x\r\ncontent-disposition: form-data; name=model; filename=a\r\n\r\nbytes"],
  ] as const) {
    const answer = await body(type, text);
    expect([answer.status, ((await answer.json()) as { code: string }).code]).toEqual([400, "not-a-form"]);
  }
  expect((await fetch(`${open.address}orders`)).status).toBe(405);
  expect(await post(open, { headers: { "sec-fetch-site": "cross-site" } })).toMatchObject({ status: 403, code: "foreign-page" });
  expect(await orders(open)).toHaveLength(1);
  await expectNoLeftovers(open);
});

test("a verification that takes too long is ended", async () => {
  const open = await start(await program("setInterval(() => {}, 1000);"), { verify_ms: 200 });
  expect(await post(open)).toMatchObject({ status: 503, code: "took-too-long" });
  await expectNoLeftovers(open);
});

test("one verification runs at a time, a few wait, fewer of one client, and more are asked to come back", async () => {
  const scratch = await newFolder("scratch");
  const log = join(scratch, "turns.log");
  // Blocks until the test opens the gate.
  const gate = join(scratch, "gate");
  const script = `const fs = require("node:fs");
fs.appendFileSync(${JSON.stringify(log)}, "in ");
const wait = setInterval(() => {
  if (!fs.existsSync(${JSON.stringify(gate)})) return;
  clearInterval(wait);
  fs.appendFileSync(${JSON.stringify(log)}, "out ");
  ${HONEST}
}, 10);`;
  const open = await start(await program(script), { places: 2, places_per_client: 1 });
  const send = (client: string): Promise<Answer> => post(open, { headers: from(client) });
  const ofOne = [send("192.0.2.1"), send("192.0.2.1")];
  expect(await Promise.race(ofOne)).toMatchObject({ status: 429, code: "too-many-orders" });
  const ofOthers = [send("192.0.2.2"), send("192.0.2.3")];
  expect(await Promise.race(ofOthers)).toMatchObject({ status: 503, code: "busy" });
  await writeFile(gate, "");
  const answers = await Promise.all([...ofOne, ...ofOthers]);
  expect(answers.filter(({ status }) => status === 201)).toHaveLength(2);
  expect(await readFile(log, "utf8")).toBe("in out in out ");
  expect(await send("192.0.2.1")).toMatchObject({ status: 201 });
  await expectNoLeftovers(open);
});

test("slow uploads cost nobody a place, and their client has few of them", async () => {
  const open = await start(await program(HONEST), { places: 1, uploads_per_client: 2 });
  const slow = "192.0.2.1";
  for (let i = 0; i < 2; i++) void slowly(open, slow);
  await expect.poll(async () => (await incoming(open)).length).toBe(2);
  expect(await slowly(open, slow)).toBe(429);
  expect(await post(open, { headers: from("192.0.2.2") })).toMatchObject({ status: 201 });
});

test("an upload that takes too long is ended, and its client may send another", async () => {
  const open = await start(await program(HONEST), { uploads_per_client: 1, upload_ms: 300 });
  expect(await slowly(open, "127.0.0.1")).toBe(408);
  await expectNoLeftovers(open);
  expect(await post(open)).toMatchObject({ status: 201 });
});

test("clients are known by the address that the web server appends, and by the network of IPv6", () => {
  const client = (forwarded?: string, remoteAddress = "127.0.0.1"): string =>
    clientOf({ headers: { "x-forwarded-for": forwarded }, socket: { remoteAddress } } as unknown as Parameters<typeof clientOf>[0]);
  expect(client()).toBe("127.0.0.1");
  expect(client("203.0.113.9, 192.0.2.1")).toBe("192.0.2.1");
  expect(client("::ffff:192.0.2.1")).toBe("192.0.2.1");
  for (const address of ["2001:db8::1", "2001:DB8:0:0:1:2:3:4", "2001:db8::5:6:7:8"]) expect(client(address), address).toBe("2001:db8:0:0");
  expect(client("2001:db8:0:1::")).toBe("2001:db8:0:1");
  expect(client("::1")).toBe("0:0:0:0");
});

test("a connection that was opened in advance does not keep the shop open", async () => {
  const { address, close } = await start("never called");
  const socket = openSocket(Number(new URL(address).port));
  await once(socket, "connect");
  await close();
});

test("an address that is none is refused, and no fault of the shop", async () => {
  const open = await start("never called");
  for (const path of ["//", "//[", "http://"]) {
    const request = connect(open.address, { path }).end();
    const [{ statusCode }] = (await once(request, "response")) as [{ statusCode?: number }];
    expect(statusCode, path).toBe(400);
  }
  expect((await fetch(open.address)).status).toBe(200);
});

test("whoever announces more than all files together may have is not listened to", async () => {
  const open = await start("never called", { most_bytes: { plan: 1e6, model: 1e6, print: 1e6 } });
  expect(await post(open, { print: new Blob([new Uint8Array(4e6)]) })).toMatchObject({ status: 413, code: "too-large" });
  await expectNoLeftovers(open);
});

test("an order that is sent again is the order that exists, also when the shop was closed meanwhile", async () => {
  const { cusp, count } = await counting();
  const open = await start(cusp);
  const key = randomUUID();
  const first = await post(open, { key });
  expect(first).toMatchObject({ status: 201, copies: 1 });
  expect(await post(open, { key: key.toUpperCase() })).toEqual(first);
  await open.close();
  const again = await start(cusp, {}, open.folder);
  // Larger than the read-ahead, so that the answer must wait for the upload.
  expect(await post(again, { key, print: new Blob([new Uint8Array(20e6)]) })).toEqual(first);
  expect(await count()).toBe(1);
  expect(await orders(again)).toEqual([first.id]);
  expect(first.id).not.toContain(key.slice(0, 8));
  expect(await post(again)).toMatchObject({ status: 201 });
  expect(await orders(again)).toHaveLength(2);
  await expectNoLeftovers(again);
});

test("of two that are sent at the same time with one key one is taken, and both are told of it", async () => {
  const { cusp, count } = await counting();
  const open = await start(cusp);
  const key = randomUUID();
  const answers = await Promise.all([post(open, { key }), post(open, { key })]);
  expect(answers.map(({ status }) => status)).toEqual([201, 201]);
  expect(new Set(answers.map(({ id }) => id)).size).toBe(1);
  expect(await orders(open)).toEqual([answers[0]?.id]);
  expect(await count()).toBe(1);
  await expectNoLeftovers(open);
});

test("a key whose order was refused is not spent, nor is that of a customer who went away", async () => {
  const { cusp } = await counting();
  const open = await start(cusp);
  const key = randomUUID();
  expect(await post(open, { key, fields: { price_cents: "1" } })).toMatchObject({ status: 409, code: "price-differs" });
  expect(await post(open, { key })).toMatchObject({ status: 201 });

  const gate = join(await newFolder("scratch"), "gate");
  const slow = await start(await program(`const wait = setInterval(() => {
    if (!require("node:fs").existsSync(${JSON.stringify(gate)})) return;
    clearInterval(wait);
    ${HONEST}
  }, 10);`));
  const gone = new AbortController();
  const first = post(slow, { key, signal: gone.signal }).catch(() => null);
  await expect.poll(async () => (await incoming(slow)).length).toBe(1);
  const second = post(slow, { key });
  await expect.poll(async () => (await incoming(slow)).length).toBe(2);
  gone.abort();
  await writeFile(gate, "");
  expect(await first).toBeNull();
  expect(await second).toMatchObject({ status: 201 });
  expect(await orders(slow)).toHaveLength(1);
  await expectNoLeftovers(slow);
});

test("a program that ends without an answer is not the order's fault, and does not end the shop", async () => {
  const scratch = await newFolder("scratch");
  const mended = join(scratch, "mended");
  const complaints = vi.spyOn(console, "error").mockImplementation(() => undefined);
  for (const ending of ["process.exit(1)", `process.kill(process.pid, "SIGKILL")`, `console.log("{"); process.exit(1)`, "process.exit(0)"]) {
    await rm(mended, { force: true });
    const open = await start(await program(`if (!require("node:fs").existsSync(${JSON.stringify(mended)})) { ${ending}; }\n${HONEST}`));
    const key = randomUUID();
    expect(await post(open, { key }), ending).toMatchObject({ status: 500, code: "failed" });
    await writeFile(mended, "");
    expect(await post(open, { key }), ending).toMatchObject({ status: 201 });
    await expectNoLeftovers(open);
  }
  // Each failure is reported to the operator.
  expect(complaints).toHaveBeenCalledTimes(4);
  complaints.mockRestore();
});

test("an order is on the disk before the customer is told of it", async (context) => {
  if (process.platform !== "linux") return context.skip("only Linux tells the path of an open file");
  const open = await start(await program(HONEST));
  const some = await openFile(open.folder);
  const synced: string[] = [];
  const sync = vi.spyOn(Object.getPrototypeOf(some) as FileHandle, "sync").mockImplementation(async function (this: FileHandle) {
    synced.push(relative(open.folder, await readlink(`/proc/self/fd/${this.fd}`)));
  });
  await some.close();
  const { id = "" } = await post(open);
  sync.mockRestore();
  const files = await readdir(join(open.folder, "orders", id));
  expect(files).toContain("order.json");
  const names = synced.map((path) => path.replace(/^incoming\/order-[^/]+/, "order"));
  expect(names).toEqual([...files.map((file) => `order/${file}`), "order", "orders"]);
});

test("requests whose upload nobody needs leave nothing in the server's memory", async () => {
  const { cusp } = await counting();
  const open = await start(cusp);
  const key = randomUUID();
  const warnings: Error[] = [];
  const note = (warning: Error): void => void warnings.push(warning);
  process.on("warning", note);
  // More than the number at which node warns of a leak of listeners. The answer is known before the upload is complete.
  for (let i = 0; i < 15; i++) await post(open, { key, print: new Blob([new Uint8Array(1e6)]) });
  process.off("warning", note);
  expect(warnings).toEqual([]);
});

test("the lines of an order add up to its price, and are kept with it", async () => {
  const open = await start((await counting()).cusp);
  const lines = [
    { kind: "setup", amount: 450 },
    { kind: "machine", amount: 960 },
    { kind: "resin", amount: 1140 },
  ];
  const answer = await post(open, { fields: { copies: "3", price_cents: "2550" } });
  expect(answer).toMatchObject({ status: 201, lines, price_cents: 2550 });
  const kept = async (file: string): Promise<unknown> => JSON.parse(await readFile(join(open.folder, "orders", answer.id ?? "", file), "utf8"));
  // The program was given the shop's own limits and prices, and they are kept with the order.
  const verified = { warnings: WARNINGS, printability: { verdict: "ok" }, limits: LIMITS };
  expect(await kept("order.json")).toMatchObject({ lines, price_cents: 2550, verified });
  expect(await kept("limits.json")).toEqual(LIMITS);
  expect(await kept("prices.json")).toEqual(pricesOf(printer, resin));
});

test("what is not printable is refused, whatever it costs", async () => {
  const open = await start(await program(answering("reject")));
  expect(await post(open)).toMatchObject({ status: 422, code: "not-printable", message: expect.stringContaining("trap") });
  expect(await orders(open)).toEqual([]);
  await expectNoLeftovers(open);
});

test("what needs a look waits for a person, the customer is told, and the shop sees what it is", async () => {
  const open = await start(await program(answering("review")));
  const key = randomUUID();
  const model = new File(["solid"], "C:\\mine\\Königin\u202e\u001b[31m.stl", { type: "model/stl" });
  const answer = await post(open, { key, fields: { model } });
  expect(answer).toMatchObject({ status: 201, state: "review", model_name: "Königin[31m.stl" });
  expect([await ordersIn(open, "review"), await ordersIn(open, "accepted")]).toEqual([[answer.id], []]);
  expect(await post(open, { key })).toEqual(answer);
  const said = vi.spyOn(console, "log").mockImplementation(() => undefined);
  await review([open.folder]);
  expect(said.mock.calls).toEqual([[`${answer.id}  ${answer.placed_at}  1 × Königin[31m.stl  ${printer.name}, ${resin.name}  €11.50  trap`]]);
  said.mockClear();
  await review([open.folder, answer.id ?? ""]);
  expect(said).not.toHaveBeenCalled();
  said.mockRestore();
  expect([await ordersIn(open, "review"), await ordersIn(open, "accepted")]).toEqual([[], [answer.id]]);
  expect(await post(open, { key })).toEqual({ ...answer, state: "accepted" });
});

test("the page writes times as the element does", () => {
  const { format } = languageOf("en");
  for (const seconds of [0, 29, 30, 89, 90, 1769, 1770, 1771, 3569, 3570, 3599, 3600, 86_429, 86_430, 1e7]) {
    expect(time(seconds), String(seconds)).toBe(format.time(seconds));
  }
});
