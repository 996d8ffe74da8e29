/** The order-site example's server: what it takes and refuses, without a browser and without the native program. */
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { expect, test } from "vitest";
import { FIXED } from "../examples/shop/catalogue.js";
import { priceOf } from "../examples/shop/price.js";
import { expectNoLeftovers, incoming, orders, printer, resin, shops, type OpenShop } from "./shop-open.js";
import { ELEMENT_POLICY } from "./static.js";

const { folder: newFolder, open: start, program } = shops();

const VERDICT = { layers: 3, max_error: 0.05, tolerance: 0.06, print_time_s: 3600, resin_ml: 10, print_is_same: true };
const HONEST = `console.log(${JSON.stringify(JSON.stringify(VERDICT))});`;
const { note: _note, swatch: _swatch, ml_cents: _cents, ...cured } = resin;
const OPTIONS = { ...FIXED, printer: printer.name, resin: cured, tolerance: 0.06 };

interface Sent {
  options?: object;
  print?: Blob;
  fields?: Readonly<Record<string, string | Blob>>;
  headers?: Readonly<Record<string, string>>;
  signal?: AbortSignal;
}

/** An order without a browser, honest where nothing else is said. */
async function post({ address }: OpenShop, sent: Sent = {}): Promise<{ status: number; code?: string; message?: string }> {
  const form = new FormData();
  const plan = new Blob([JSON.stringify({ ...VERDICT, options: { ...OPTIONS, ...sent.options } })], { type: "application/json" });
  const file = new Blob(["solid"], { type: "model/stl" });
  const price_cents = String(priceOf(VERDICT, printer, resin, 1).total_cents);
  const parts = { copies: "1", price_cents, plan, model: file, print: sent.print ?? file, ...sent.fields };
  for (const [name, part] of Object.entries(parts)) form.set(name, part);
  const { headers = {}, signal = null } = sent;
  const response = await fetch(`${address}orders`, { method: "POST", body: form, headers, signal });
  return { status: response.status, ...((await response.json()) as object) };
}

test("every answer comes under the policy that the guide names", async () => {
  const { address } = await start("never called");
  const guide = await readFile(new URL("../../docs/embed.md", import.meta.url), "utf8");
  expect(guide).toContain(ELEMENT_POLICY);
  for (const path of ["", "goblet.stl", "nowhere", "..%2fserver%2fshop.ts"]) {
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
  const body = (type: string, text: string): Promise<Response> =>
    fetch(`${open.address}orders`, { method: "POST", body: text, headers: { "content-type": type } });
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

test("one verification runs at a time, a few wait, and more are asked to come back", async () => {
  const scratch = await newFolder("scratch");
  const log = join(scratch, "turns.log");
  // Holds its turn until the test lets go of it.
  const gate = join(scratch, "gate");
  const script = `const fs = require("node:fs");
fs.appendFileSync(${JSON.stringify(log)}, "in ");
const wait = setInterval(() => {
  if (!fs.existsSync(${JSON.stringify(gate)})) return;
  clearInterval(wait);
  fs.appendFileSync(${JSON.stringify(log)}, "out ");
  ${HONEST}
}, 10);`;
  const open = await start(await program(script), { places: 2 });
  const taken = [post(open), post(open)];
  await expect.poll(async () => (await incoming(open)).length).toBe(2);
  expect(await post(open)).toMatchObject({ status: 503, code: "busy" });
  await writeFile(gate, "");
  expect((await Promise.all(taken)).map(({ status }) => status)).toEqual([201, 201]);
  expect(await readFile(log, "utf8")).toBe("in out in out ");
  expect(await post(open)).toMatchObject({ status: 201 });
  await expectNoLeftovers(open);
});

test("whoever announces more than all files together may have is not listened to", async () => {
  const open = await start("never called", { most_bytes: { plan: 1e6, model: 1e6, print: 1e6 } });
  expect(await post(open, { print: new Blob([new Uint8Array(4e6)]) })).toMatchObject({ status: 413, code: "too-large" });
  await expectNoLeftovers(open);
});
