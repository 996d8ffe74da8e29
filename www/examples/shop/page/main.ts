/** The shop's page: the element, the shop's own choices, a price that follows both, and an order button. */
import "cusp-slicer/element";
import { isAbort, type Check, type Price } from "cusp-slicer";
import type { CuspSlicer } from "cusp-slicer/element-class";
import { MOST_BYTES, MOST_COPIES, PRINTERS, RESINS, type PartName } from "../catalogue.js";
import { Assessment, type Result } from "./assess.js";
import { choices } from "./choices.js";
import { millilitres, money, number, time } from "./format.js";
import { fillLines } from "./lines.js";
import { placeOrder, type Placed } from "./order.js";
import { fillVerdict } from "./verdict.js";

const find = <E extends Element = HTMLElement>(selector: string): E => {
  const element = document.querySelector<E>(selector);
  if (element === null) throw new Error(`there is no ${selector}`);
  return element;
};

const slicer = find<CuspSlicer>("cusp-slicer");
const copies = find<HTMLInputElement>("#copies");
const button = find<HTMLButtonElement>("#order");
const cancel = find<HTMLButtonElement>("#cancel");
const standing = find("#standing");
const problem = find("#problem");

/** State of an order in words for the customer. */
const STATES: Readonly<Record<Placed["state"], string>> = {
  accepted: "taken",
  review: "waiting for a person to look at it",
};

/** The order that pressing the button would place. */
interface Offer {
  result: Result;
  copies: number;
  price: Price;
  check: Check;
}

/** The order being placed; null if there is none. */
let ordering: AbortController | null = null;
/** The last order sent, until an answer confirms it. */
let unanswered: { what: string; key: string } | null = null;
const placed: Placed[] = [];

const assessment = new Assessment(slicer, draw);

/** The current offer; null without a plan, a valid number of copies, a price or a check. */
function offer(): Offer | null {
  const { result } = slicer;
  if (result === null || !copies.checkValidity()) return null;
  const count = copies.valueAsNumber;
  const [price, check] = [assessment.price(result, count), assessment.check(result)];
  return price === null || check === null ? null : { result, copies: count, price, check };
}

/** Shows known results, and requests the rest. */
function follow(): void {
  draw();
  // A call made now would wait for the next plan, and apply to that.
  if (copies.checkValidity() && slicer.state !== "busy") void assessment.follow(copies.valueAsNumber);
}

function draw(): void {
  const { result } = slicer;
  const price = result !== null && copies.checkValidity() ? assessment.price(result, copies.valueAsNumber) : null;
  find("#figures").hidden = find("#parts").hidden = price === null;
  if (result !== null && price !== null) fill(result, price);
  find("#price").textContent = price === null ? "" : money(price.total);
  const missing = copies.validity.valid ? "The price comes with your model." : `From 1 to ${MOST_COPIES} copies, please.`;
  find("#price-note").textContent = price === null ? missing : "incl. VAT";
  const verdict = find("#verdict");
  verdict.hidden = result === null;
  if (result !== null) fillVerdict(verdict, assessment.check(result), assessment.hasFailed(result));
  const isPlanning = slicer.state === "busy" && ordering === null;
  find(".choices").classList.toggle("replanning", isPlanning && price !== null);
  const now = offer();
  button.disabled = now === null || now.check.verdict === "reject" || isPlanning || ordering !== null;
  cancel.hidden = ordering === null;
}

function fill({ report }: Result, price: Price): void {
  find("#time").textContent = time(report.print_time_s);
  find("#resin").textContent = millilitres(report.resin_ml);
  fillLines(find("#parts"), price.lines);
}

function say(text: string, fault = ""): void {
  standing.textContent = text;
  problem.textContent = fault;
}

async function order(): Promise<void> {
  const seen = offer();
  const { model } = slicer;
  if (seen === null || model === null) return;
  const { signal } = (ordering = new AbortController());
  say("Making the print file…");
  draw();
  try {
    // The current plan may not include the latest choice yet.
    await slicer.plan();
    await assessment.follow(copies.valueAsNumber);
    const now = offer();
    if (now === null || now.check.verdict === "reject" || now.price.total !== seen.price.total) {
      say("", "The price has just changed with your last choice. Please look at it and order again.");
      return;
    }
    const { blob: print } = await slicer.export();
    const parts = { plan: new Blob([JSON.stringify(now.result.report)]), model: model.file, print };
    const fault = tooLarge(parts);
    if (fault !== null) return say("", fault);
    signal.throwIfAborted();
    say("Sending and checking your order…");
    const answer = await placeOrder({ key: keyOf(now), copies: now.copies, price_cents: now.price.total, model_name: model.name, parts }, signal);
    unanswered = null;
    say(`Checked and ${STATES[answer.state]}: order ${shortly(answer)}.`);
    show(answer, model.name);
  } catch (error) {
    if (signal.aborted || isAbort(error)) say("Cancelled. Nothing was ordered.");
    else say("", error instanceof Error ? error.message : String(error));
  } finally {
    ordering = null;
    draw();
  }
}

/** Key of an order: stays the same for the same order until an answer confirms it. */
function keyOf({ result, copies, price }: Offer): string {
  const { models, options } = result.report;
  const which = models.map(({ file, weights_crc32 }) => [file, weights_crc32]);
  const what = JSON.stringify([which, options, copies, price.total]);
  if (unanswered?.what !== what) unanswered = { what, key: crypto.randomUUID() };
  return unanswered.key;
}

function tooLarge(parts: Readonly<Record<PartName, Blob>>): string | null {
  const names: Readonly<Record<PartName, string>> = { plan: "plan", model: "model", print: "print file" };
  for (const [part, most] of Object.entries(MOST_BYTES) as [PartName, number][]) {
    if (parts[part].size > most) return `The ${names[part]} is larger than the ${number(most / 1e6)} MB that we take.`;
  }
  return null;
}

function show(answer: Placed, name: string): void {
  placed.push(answer);
  const item = document.createElement("li");
  const words = (tag: string, text: string, kind = ""): void => {
    const element = document.createElement(tag);
    element.textContent = text;
    element.className = kind;
    item.append(element);
  };
  words("span", `${answer.copies} × ${name}`);
  words("span", money(answer.price_cents));
  words("span", `Order ${shortly(answer)}, ${STATES[answer.state]}`, "quiet");
  const lines = document.createElement("dl");
  lines.className = "lines";
  fillLines(lines, answer.lines);
  item.append(lines);
  item.dataset["order"] = answer.id;
  find(".placed ul").append(item);
  find(".placed output").textContent = money(placed.reduce((sum, { price_cents }) => sum + price_cents, 0));
  find(".placed").hidden = false;
}

/** The beginning of an order's number, for display. */
const shortly = ({ id }: Placed): string => id.slice(0, 8);

slicer.resins = RESINS.map(({ note: _note, swatch: _swatch, ml_cents: _cents, ...resin }) => resin);
choices(find("#resins"), RESINS, (resin) => ({ ...resin, title: resin.name, price: `${money(resin.ml_cents)}/ml` }), ({ name }) => void (slicer.resin = name));
choices(
  find("#printers"),
  PRINTERS,
  (printer) => ({ ...printer, price: `${money(printer.hour_cents)}/h` }),
  ({ name }) => void (slicer.printer = name),
);
copies.max = String(MOST_COPIES);
copies.addEventListener("input", follow);
button.addEventListener("click", () => void order());
cancel.addEventListener("click", () => {
  ordering?.abort();
  slicer.cancel();
});
find("#sample").addEventListener("click", () => {
  // The element shows the outcome itself.
  slicer.load("goblet.stl").catch(() => undefined);
});
for (const name of ["cusp-change", "cusp-load"] as const) {
  // Messages about the last order do not apply to this one.
  slicer.addEventListener(name, () => ordering ?? say(""));
}
new MutationObserver(follow).observe(slicer, { attributeFilter: ["state"] });
slicer.addEventListener("cusp-plan", follow);
draw();
