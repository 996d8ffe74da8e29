/** The lines of an order, each with its total. */
import type { Line } from "../price.js";
import { money, number } from "./format.js";

const NAMES: Readonly<Record<Line["name"], string>> = { setup: "Set-up", time: "Machine time", resin: "Resin" };

/** Fills a description list. */
export function fillLines(list: HTMLElement, lines: readonly Line[]): void {
  list.replaceChildren(...lines.map(row));
}

function row({ name, each_cents, count, total_cents }: Line): HTMLElement {
  const [term, times, total] = [element("dt", NAMES[name]), element("dd", `${number(count)} × ${money(each_cents)}`), element("dd", money(total_cents))];
  times.className = "times";
  const made = document.createElement("div");
  made.dataset["line"] = name;
  made.append(term, times, total);
  return made;
}

function element(tag: "dt" | "dd", text: string): HTMLElement {
  const made = document.createElement(tag);
  made.textContent = text;
  return made;
}
