/** Has the native `cusp` verify that model and options yield the plan, and the plan the print file. */
import { execFile } from "node:child_process";
import { writeFile } from "node:fs/promises";
import { join } from "node:path";
import type { Limits, Price, Prices, Printability, Warning } from "cusp-slicer";
import { Refusal, type RefusalCode } from "./refusal.js";
import { FILES } from "./upload.js";

/** What `cusp verify --json` prints for a valid plan. */
export interface Verified {
  layers: number;
  /** In the metric's unit, like the tolerance. */
  max_error: number;
  tolerance: number;
  print_time_s: number;
  resin_ml: number;
  print_is_same: boolean;
  /** What the operator of the printer should know, such as parts that hang in the air. */
  warnings: readonly Warning[];
  printability: Printability;
  price: Price;
}

export interface Verifier {
  /** The program. */
  cusp: string;
  /** How long it may take, ms. */
  limit_ms: number;
}

/** Room for what it prints: up to a hundred findings of each kind, and the area of every layer. */
const MOST_ANSWER_BYTES = 16e6;

/** The file that a message is about, by the name that it begins with. */
const BLAME: readonly (readonly [file: string, code: RefusalCode, subject: string])[] = [
  [FILES.plan, "plan-refused", "The plan was refused"],
  [FILES.model, "model-refused", "The model was refused"],
  [FILES.print, "print-refused", "The print file was refused"],
];

/** What the shop accepts, and what it asks. */
export interface Terms {
  limits: Limits;
  prices: Prices;
  copies: number;
}

/** The files of the terms, beside those of the order: with them, `cusp verify` can be called again. */
const TERMS = { limits: "limits.json", prices: "prices.json" };

/** @param folder where the three files are */
export async function verify(folder: string, terms: Terms, { cusp, limit_ms }: Verifier, signal: AbortSignal): Promise<Verified> {
  for (const name of ["limits", "prices"] as const) await writeFile(join(folder, TERMS[name]), `${JSON.stringify(terms[name], null, 2)}\n`);
  const call = ["verify", FILES.plan, FILES.model, "--print", FILES.print, "--json"];
  call.push("--limits", TERMS.limits, "--prices", TERMS.prices, "--copies", String(terms.copies));
  const verified = await new Promise<Verified>((resolve, reject) => {
    execFile(cusp, call, { cwd: folder, maxBuffer: MOST_ANSWER_BYTES, timeout: limit_ms, killSignal: "SIGKILL", signal }, (error, stdout, stderr) => {
      if (error === null) resolve(JSON.parse(stdout) as Verified);
      else if (signal.aborted) reject(error);
      else if (error.killed === true) reject(new Refusal("took-too-long", "Checking this model takes longer than we can wait."));
      else if (error.code === 1) reject(stdout === "" ? refused(stderr) : rejected(JSON.parse(stdout) as Verified));
      else reject(error);
    });
  });
  if (!verified.print_is_same) throw new Refusal("print-refused", "The print file was refused.");
  if (verified.printability.verdict === "reject") throw rejected(verified);
  return verified;
}

/** A correct plan of a model that the shop does not print. */
function rejected({ printability }: Verified): Refusal {
  const codes = new Set(printability.findings.filter(({ severity }) => severity === "reject").map(({ code }) => code));
  return new Refusal("not-printable", `The model cannot be printed like this: ${[...codes].join(", ")}.`);
}

/** The program's own message. It names its file without a path, because the program runs in the folder. */
function refused(stderr: string): Refusal {
  const said = stderr.split("\n").findLast((line) => line.startsWith("cusp: "))?.slice("cusp: ".length) ?? "";
  for (const [file, code, subject] of BLAME) {
    if (said.startsWith(`${file}: `)) return new Refusal(code, `${subject}: ${said.slice(file.length + 2)}.`);
  }
  return new Refusal("plan-refused", `The order was refused: ${said}.`);
}
