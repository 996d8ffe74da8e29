/** Processes of a browser and its helpers; all of them end with the tests. */
import { spawn, type ChildProcess } from "node:child_process";
import type { Readable } from "node:stream";
import { program } from "../program.js";

export const xvfb = (): string | null => program(["Xvfb"], "XVFB");

export class Programs {
  readonly #children: ChildProcess[] = [];

  constructor() {
    // If the tests are interrupted.
    process.once("exit", () => this.#kill());
  }

  /** Starts a program in its own process group, so that its child processes end with it. */
  start(path: string, args: readonly string[], env: Record<string, string | undefined> = {}): ChildProcess {
    const child = spawn(path, args, { env: { ...process.env, ...env }, stdio: ["ignore", "pipe", "pipe"], detached: true });
    // An unread pipe fills up and blocks its program.
    child.stdout.resume();
    child.stderr.resume();
    this.#children.push(child);
    return child;
  }

  /** Starts a virtual screen and returns its name: without one, WebKitGTK does not start, and Firefox has no WebGL. */
  async screen(): Promise<string> {
    const child = this.start(xvfb() ?? "Xvfb", ["-displayfd", "1", "-screen", "0", "1400x1000x24", "-nolisten", "tcp"]);
    return `:${await said(child, child.stdout, /^(\d+)\n/)}`;
  }

  async end(): Promise<void> {
    const ends = this.#children.filter(isAlive).map((child) => new Promise((resolve) => child.once("exit", resolve)));
    this.#kill();
    await Promise.all(ends);
  }

  #kill(): void {
    for (const { pid } of this.#children.filter(isAlive)) if (pid !== undefined) process.kill(-pid, "SIGKILL");
  }
}

const isAlive = ({ pid, exitCode, signalCode }: ChildProcess): boolean => pid !== undefined && exitCode === null && signalCode === null;

/** First group of a match in a program's output. */
export function said(child: ChildProcess, stream: Readable | null, wanted: RegExp): Promise<string> {
  return new Promise((resolve, reject) => {
    let text = "";
    stream?.on("data", (bytes: Buffer) => {
      text += bytes.toString();
      const found = wanted.exec(text)?.[1];
      if (found !== undefined) resolve(found);
    });
    child.once("error", reject);
    child.once("exit", (code) => reject(new Error(`${child.spawnfile} ended with ${code}: ${text}`)));
  });
}

/** Rejects if a program has not answered in time. */
export async function within<T>(ms: number, name: string, answer: Promise<T>): Promise<T> {
  let timer: NodeJS.Timeout | undefined;
  const late = new Promise<never>((_, reject) => {
    timer = setTimeout(() => reject(new Error(`${name} did not answer within ${ms / 1000} s`)), ms);
  });
  return Promise.race([answer, late]).finally(() => clearTimeout(timer));
}
