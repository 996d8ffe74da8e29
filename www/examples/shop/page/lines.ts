/** The lines of a price, each with its total. */
import type { Price, PriceKind } from "cusp-slicer";
import { money } from "./format.js";

const NAMES: Readonly<Record<PriceKind, string>> = {
  setup: "Set-up",
  machine: "Machine time",
  resin: "Resin",
  supports: "Supports",
  finish: "Finish",
  discount: "Discount",
  minimum: "Up to our minimum",
};

/** Fills a description list. */
export function fillLines(list: HTMLElement, lines: Price["lines"]): void {
  list.replaceChildren(...lines.map(row));
}

function row({ kind, amount }: Price["lines"][number]): HTMLElement {
  const made = document.createElement("div");
  made.dataset["line"] = kind;
  made.append(element("dt", NAMES[kind]), element("dd", money(amount)));
  return made;
}

function element(tag: "dt" | "dd", text: string): HTMLElement {
  const made = document.createElement(tag);
  made.textContent = text;
  return made;
}
