/** Runs the native `cusp` to verify that model and options yield the plan, and the plan the print file. */
import { execFile } from "node:child_process";
import { writeFile } from "node:fs/promises";
import { join } from "node:path";
import type { Limits, PlatePrintability, Price, Prices, Warning } from "cusp-slicer";
import { Refusal, type RefusalCode } from "./refusal.js";
import { FILES } from "./upload.js";

/** JSON of `cusp verify --json` for the plate of a valid plan, with its price. */
export interface Verified {
  layers: number;
  /** In the metric's unit, like the tolerance. */
  max_error: number;
  tolerance: number;
  print_time_s: number;
  resin_ml: number;
  print_is_same: boolean;
  /** Warnings for the operator of the printer, such as parts that hang in the air. */
  warnings: readonly Warning[];
  printability: PlatePrintability;
  price: Price;
}

export interface Verifier {
  /** Path of the program. */
  cusp: string;
  /** Time limit, ms. */
  limit_ms: number;
}

/** Maximum size of the output: up to a hundred findings of each kind, and the area of every layer. */
const MOST_ANSWER_BYTES = 16e6;

/** JSON of `cusp verify --json` for a valid plan. */
export interface Answer {
  plates: readonly Omit<Verified, "price">[];
  price: Price;
}

/** JSON of `cusp verify --json` on a failure. */
interface Failed {
  error: { code: string; message: string; detail?: unknown; file?: string };
}

/** Refusal by the file named in a failure. The program runs in the folder, so file names have no path. */
const BLAME: Readonly<Record<string, readonly [code: RefusalCode, subject: string]>> = {
  [FILES.plan]: ["plan-refused", "The plan was refused"],
  [FILES.model]: ["model-refused", "The model was refused"],
  [FILES.print]: ["print-refused", "The print file was refused"],
};

/** Resource limits of one verification, since a plan may cost more than any order is worth. */
const BOUNDS = ["--max-memory", "2GB", "--max-cpu-time", "120"];

/** The shop's limits and prices for an order. */
export interface Terms {
  limits: Limits;
  prices: Prices;
  copies: number;
}

/** Files of the terms, stored with the order so that `cusp verify` can be repeated. */
const TERMS = { limits: "limits.json", prices: "prices.json" };

/** @param folder contains the three files */
export async function verify(folder: string, terms: Terms, { cusp, limit_ms }: Verifier, signal: AbortSignal): Promise<Verified> {
  for (const name of ["limits", "prices"] as const) await writeFile(join(folder, TERMS[name]), `${JSON.stringify(terms[name], null, 2)}\n`);
  const call = ["verify", FILES.plan, FILES.model, "--print", FILES.print, "--json"];
  call.push("--limits", TERMS.limits, "--prices", TERMS.prices, "--copies", String(terms.copies), ...BOUNDS);
  const output = await new Promise<string>((resolve, reject) => {
    execFile(cusp, call, { cwd: folder, maxBuffer: MOST_ANSWER_BYTES, timeout: limit_ms, killSignal: "SIGKILL", signal }, (error, stdout) => {
      if (error === null) resolve(stdout);
      else if (signal.aborted) reject(error);
      else if (error.killed === true) reject(new Refusal("took-too-long", "Checking this model takes longer than we can wait."));
      else reject((error.code === 1 ? answered(stdout) : null) ?? error);
    });
  });
  const verified = verifiedOf(JSON.parse(output) as Answer);
  if (!verified.print_is_same) throw new Refusal("print-refused", "The print file was refused.");
  if (verified.printability.verdict === "reject") throw rejected(verified);
  return verified;
}

/** The single plate of an order. */
export function verifiedOf({ plates, price }: Answer): Verified {
  const [plate, ...others] = plates;
  if (plate === undefined || others.length > 0) throw new Refusal("plan-refused", "The plan is not of one plate.");
  return { ...plate, price };
}

/** Refusal of a valid plan for a model that the shop does not print. */
function rejected({ printability }: Verified): Refusal {
  const findings = printability.models.flatMap((model) => model.findings);
  const codes = new Set(findings.filter(({ severity }) => severity === "reject").map(({ code }) => code));
  return new Refusal("not-printable", `The model cannot be printed like this: ${[...codes].join(", ")}.`);
}

/**
 * Refusal in the program's output: a failure, or a rejection by the findings. Null without an answer, for which the order is not to blame.
 */
function answered(output: string): Refusal | null {
  const answer = parsed(output);
  if (answer === null) return null;
  if (!("error" in answer)) return rejected(verifiedOf(answer));
  const { code, message, file } = answer.error;
  if (code === "time-bound" || code === "memory-bound") return new Refusal("took-too-long", "Checking this model takes more than we can spend.");
  const [refusal, subject] = BLAME[file ?? ""] ?? ["plan-refused", "The order was refused"];
  return new Refusal(refusal, `${subject}: ${message}.`);
}

function parsed(output: string): Answer | Failed | null {
  try {
    return JSON.parse(output) as Answer | Failed;
  } catch {
    return null;
  }
}
