/** Has the native `cusp` verify that model and options yield the plan, and the plan the print file. */
import { execFile } from "node:child_process";
import type { Warning } from "cusp-slicer";
import { Refusal, type RefusalCode } from "./refusal.js";
import { FILES } from "./upload.js";

/** What `cusp verify --json` prints for a valid plan. */
export interface Verdict {
  layers: number;
  /** In the metric's unit, like the tolerance. */
  max_error: number;
  tolerance: number;
  print_time_s: number;
  resin_ml: number;
  print_is_same: boolean;
  /** What the operator of the printer should know, such as parts that hang in the air. */
  warnings: readonly Warning[];
}

export interface Verifier {
  /** The program. */
  cusp: string;
  /** How long it may take, ms. */
  limit_ms: number;
}

/** The file that a message is about, by the name that it begins with. */
const BLAME: readonly (readonly [file: string, code: RefusalCode, subject: string])[] = [
  [FILES.plan, "plan-refused", "The plan was refused"],
  [FILES.model, "model-refused", "The model was refused"],
  [FILES.print, "print-refused", "The print file was refused"],
];

/** @param folder where the three files are */
export function verify(folder: string, { cusp, limit_ms }: Verifier, signal: AbortSignal): Promise<Verdict> {
  const call = ["verify", FILES.plan, FILES.model, "--print", FILES.print, "--json"];
  return new Promise<Verdict>((resolve, reject) => {
    execFile(cusp, call, { cwd: folder, timeout: limit_ms, killSignal: "SIGKILL", signal }, (error, stdout, stderr) => {
      if (error === null) resolve(JSON.parse(stdout) as Verdict);
      else if (signal.aborted) reject(error);
      else if (error.killed === true) reject(new Refusal("took-too-long", "Checking this model takes longer than we can wait."));
      else if (error.code === 1) reject(refused(stderr));
      else reject(error);
    });
  }).then((verdict) => {
    if (!verdict.print_is_same) throw new Refusal("print-refused", "The print file was refused.");
    return verdict;
  });
}

/** The program's own message. It names its file without a path, because the program runs in the folder. */
function refused(stderr: string): Refusal {
  const said = stderr.split("\n").findLast((line) => line.startsWith("cusp: "))?.slice("cusp: ".length) ?? "";
  for (const [file, code, subject] of BLAME) {
    if (said.startsWith(`${file}: `)) return new Refusal(code, `${subject}: ${said.slice(file.length + 2)}.`);
  }
  return new Refusal("plan-refused", `The order was refused: ${said}.`);
}
