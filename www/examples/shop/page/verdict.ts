/** Verdict on a model before it is ordered. */
import type { Check, Code, ModelPrintability } from "cusp-slicer";
import { number } from "./format.js";

type Severity = "review" | "reject";

/** Explanation of each kind of finding for customers. */
const SENTENCES: Readonly<Record<Code, string>> = {
  island: "Parts begin in the air and need supports.",
  "loose-body": "A part touches nothing, and would fall off.",
  "separate-body": "Parts of the model do not touch each other.",
  speck: "Some details are so small that they touch nothing.",
  overhang: "Flat undersides need supports.",
  cup: "A hollow sucks while it is printed; it needs a hole near the plate.",
  trap: "Liquid resin would be locked in a hollow; it needs a hole.",
  "narrow-drain": "Resin leaves a hollow only through narrow openings.",
  "thin-wall": "Some walls are thin and may break.",
  "thin-floor": "Some floors or roofs are thin and may break.",
  "narrow-gap": "Some gaps are narrow and may close.",
  "small-hole": "Some holes are small and may close.",
  "low-gap": "Some gaps are low and may close.",
  "thin-roof": "Some roofs are too thin to print at their height.",
  "closed-gap": "Some gaps will close.",
  "peel-area": "A layer is very large.",
  "peel-jump": "A layer is much larger than the one below.",
  "small-contact": "Little of the model touches the plate.",
};

const WORDS: Readonly<Record<Check["verdict"], string>> = {
  ok: "Printable as it is.",
  review: "Printable. A person will look at it first.",
  reject: "Not printable like this.",
};

const FAILED = "This could not be checked here. Please change a choice, or load this page anew.";

/** One sentence for each kind of finding that is more than a note, with refused kinds first. */
export function reasons({ counts, findings }: Pick<ModelPrintability, "counts" | "findings">): { code: Code; severity: Severity; text: string }[] {
  const said = counts.flatMap(({ code, found }) => {
    // The findings of a kind come from the most severe down.
    const severity = findings.find((it) => it.code === code)?.severity;
    if (severity !== "review" && severity !== "reject") return [];
    return [{ code, severity, text: found === 1 ? SENTENCES[code] : `${SENTENCES[code]} (${number(found)} places)` }];
  });
  return said.toSorted((a, b) => Number(b.severity === "reject") - Number(a.severity === "reject"));
}

/** Fills the section; `check` is null while it is running, or if it has failed. */
export function fillVerdict(section: HTMLElement, check: Check | null, hasFailed: boolean): void {
  const [words, list] = [section.querySelector("p"), section.querySelector("ul")];
  if (words === null || list === null) throw new Error("the verdict has no place");
  const unknown = hasFailed ? FAILED : "Checking whether it can be printed…";
  const text = check === null ? unknown : WORDS[check.verdict];
  // Written only on changes, so that it is announced once.
  if (words.textContent !== text) words.textContent = text;
  section.dataset["verdict"] = check?.verdict ?? "";
  const items = check === null ? [] : check.models.flatMap(reasons).map(({ code, severity, text }) => item(code, severity, text));
  list.replaceChildren(...items);
}

function item(code: Code, severity: Severity, text: string): HTMLElement {
  const made = document.createElement("li");
  made.dataset["code"] = code;
  made.className = severity;
  made.textContent = text;
  return made;
}
