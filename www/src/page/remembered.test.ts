import { afterEach, expect, test, vi } from "vitest";
import type { KnownPrinter } from "../api/wire.js";
import type { SlicerElement } from "../element/slicer-element.js";
import { fromAddress, toAddress } from "../element/state/settings.js";
import { recalled, remember, rememberedOf } from "./remembered.js";
import { readKept } from "./storage.js";

afterEach(() => vi.unstubAllGlobals());

/** A printer whose description is too long for a URL. */
const wordy = { name: "own", pixels: [100, 100], pitch_um: [50, 50], volume_mm: [5, 5, 5], note: "x".repeat(2000) };

/** Fake storage: as in browsers, or full or disabled. */
function store(isBroken = false): Map<string, string> {
  const texts = new Map<string, string>();
  const guard = <T>(value: T): T => {
    if (isBroken) throw new DOMException("no", "QuotaExceededError");
    return value;
  };
  vi.stubGlobal("localStorage", {
    getItem: (key: string) => guard(texts.get(key) ?? null),
    setItem: (key: string, text: string) => void guard(texts.set(key, text)),
    removeItem: (key: string) => void guard(texts.delete(key)),
  });
  return texts;
}

/** An element with settings only. */
class Element extends EventTarget {
  recentPrinters: readonly string[] = [];
  printer = fromAddress("").printer;
  model: SlicerElement["model"] = null;
  result: SlicerElement["result"] = null;
  #query = "";
  readonly slicer: { printers(): Promise<KnownPrinter[]> };

  constructor(...names: string[]) {
    super();
    this.slicer = { printers: () => Promise.resolve(names.map((name) => ({ name }) as KnownPrinter)) };
  }
  get query(): string {
    return this.#query;
  }
  set query(query: string) {
    const settings = fromAddress(query);
    this.printer = settings.printer;
    this.#query = toAddress(settings);
    this.dispatchEvent(new Event("cusp-change"));
  }
  /** Plans with the current printer. */
  plan(): void {
    this.result = { options: { printer: this.printer } } as NonNullable<Element["result"]>;
    this.dispatchEvent(new Event("cusp-plan"));
  }
  fail(code: string): void {
    this.dispatchEvent(new CustomEvent("cusp-error", { detail: { code } }));
  }
}

/** A visit to the page with this query. */
function visit(asked: string, ...printers: string[]): Element {
  const element = new Element(...printers);
  remember(element, asked);
  return element;
}

test("the printer, the resin and what belongs to them are remembered, and nothing else", () => {
  expect(rememberedOf("printer=mars&height=60&exposure=2%2C5&tolerance=0.03&rotation=1,0,0,0&step=0.01&metric=area")).toBe(
    "step=0.01&exposure=2.5&printer=mars",
  );
  expect(rememberedOf("height=60")).toBe("");
  expect(rememberedOf("<junk>&&%%%=&printer={")).toBe("");
});

test("a field that is out of range is not remembered", () => {
  expect(rememberedOf("printer=mars&exposure=9999&bottomLayers=2.5&step=x&planner=uniform")).toBe("printer=mars");
});

test("what the address asks for wins, printer and exposures as a whole", () => {
  const kept = "printer=mars&exposure=3";
  expect(recalled("height=60", kept)).toBe("height=60&exposure=3&printer=mars");
  for (const asked of ["printer=saturn", "exposure=2", "step=0.01&height=60"]) expect(recalled(asked, kept)).toBe(asked);
  expect(recalled("height=60", "")).toBe("height=60");
});

test("a printer too long for an address is remembered, also where the address has the rest", () => {
  const kept = rememberedOf("exposure=3", wordy as unknown as ReturnType<typeof fromAddress>["printer"]);
  expect(fromAddress(recalled("exposure=3&height=60", kept)).printer).toEqual(wordy);
  expect(fromAddress(recalled("exposure=2", kept)).printer).toBe("");
});

test("a printer that a person chooses is there at the next visit; one that a link asks for is not", () => {
  store();
  const first = visit("printer=saturn", "saturn", "mars");
  first.query = "printer=saturn&height=60";
  expect(readKept("printer")).toBeNull();
  first.query = "printer=mars&exposure=3&height=60";
  expect(visit("metric=area", "saturn", "mars").query).toBe("metric=area&exposure=3&printer=mars");
  expect(visit("printer=saturn", "saturn", "mars").query).toBe("printer=saturn");
});

test("the last printers chosen are offered first at the next visit", () => {
  store();
  const first = visit("", "saturn", "mars");
  first.query = "printer=mars";
  first.query = "printer=saturn";
  first.query = "printer=mars&exposure=3";
  expect(visit("", "saturn", "mars").recentPrinters).toEqual(["mars", "saturn"]);
});

test("a printer of one's own is remembered once a plan was made with it, so never one that the core refuses", () => {
  store();
  const own = `printer=${JSON.stringify({ name: "own", pixels: [0, 0] })}`;
  const first = visit("");
  first.query = "printer=mars";
  first.plan();
  first.query = own;
  first.fail("bad-printer");
  // The plan of the previous settings, which was still running.
  first.dispatchEvent(new Event("cusp-plan"));
  expect(readKept("printer")).toBe("printer=mars");
  first.plan();
  expect(fromAddress(readKept("printer") ?? "").printer).toMatchObject({ name: "own" });
});

test("a kept printer that the core refuses is forgotten, with what belongs to it; one of a link is left to its reader", () => {
  const texts = store();
  const own = `printer=${encodeURIComponent(JSON.stringify({ name: "own" }))}`;
  texts.set("cusp.printer", `${own}&exposure=3`);
  const element = visit("height=60");
  element.fail("bad-options");
  expect(element.printer).toEqual({ name: "own" });
  element.model = {} as Element["model"];
  element.fail("bad-options");
  expect([element.query, readKept("printer")]).toEqual(["height=60", ""]);
  const linked = visit(`height=60&${own}`);
  linked.model = element.model;
  linked.fail("bad-printer");
  expect(linked.printer).toEqual({ name: "own" });
});

test("a printer that no longer exists is dropped in silence, with what belongs to it", async () => {
  const texts = store();
  texts.set("cusp.printer", "printer=gone&exposure=3");
  const element = visit("height=60", "mars");
  expect(element.query).toBe("height=60&exposure=3&printer=gone");
  await vi.waitFor(() => expect(element.query).toBe("height=60"));
  expect(readKept("printer")).toBe("");
});

test("a storage that is full or switched off changes nothing else", () => {
  store(true);
  const element = visit("height=60", "mars");
  element.query = "printer=mars";
  expect(element.query).toBe("printer=mars");
});
