/** The example shop's server in a process of its own, to be killed and started again. */
import { fork, type ChildProcess } from "node:child_process";
import { once } from "node:events";
import { readdir, readFile } from "node:fs/promises";
import { setTimeout as wait } from "node:timers/promises";
import { fileURLToPath } from "node:url";

const WWW = fileURLToPath(new URL("..", import.meta.url));

/** Started again, it listens on the same port. */
export class ShopProcess {
  readonly address: string;
  readonly #call: readonly string[];
  readonly #env: NodeJS.ProcessEnv;
  #child: ChildProcess | null = null;
  #said = "";

  constructor(cusp: string, port: number, folders: Readonly<Record<"shop" | "pages" | "temporary", string>>) {
    this.address = `http://127.0.0.1:${port}/`;
    this.#call = ["shop-child", folders.shop, folders.pages, cusp, String(port)];
    this.#env = { ...process.env, TMPDIR: folders.temporary };
  }

  async start(): Promise<void> {
    const options = { cwd: WWW, env: this.#env, execArgv: ["--expose-gc"], silent: true };
    this.#child = fork("e2e/run.mjs", this.#call, options);
    for (const stream of [this.#child.stdout, this.#child.stderr]) stream?.on("data", (chunk) => (this.#said += String(chunk)));
    await once(this.#child, "message");
  }

  /** Returns the exit code; null if the process could not end by itself. */
  async end(signal: NodeJS.Signals): Promise<number | null> {
    const child = this.#started();
    child.kill(signal);
    if (child.exitCode === null && child.signalCode === null) await once(child, "exit");
    return child.exitCode;
  }

  /** Kills the program that verifies an order as soon as there is one. */
  async endCusp(signal: NodeJS.Signals): Promise<void> {
    const pid = this.#started().pid ?? 0;
    for (;;) {
      const [cusp] = (await readFile(`/proc/${pid}/task/${pid}/children`, "utf8")).split(" ");
      if (cusp !== undefined && cusp !== "" && isKilled(Number(cusp), signal)) return;
      await wait(1);
    }
  }

  /** What is in use while nothing is under way. */
  async usage(): Promise<Usage> {
    const child = this.#started();
    child.send("usage");
    const [{ heapUsed, external, rss }] = (await once(child, "message")) as [NodeJS.MemoryUsage];
    return { heap: heapUsed + external, rss, files: (await readdir(`/proc/${child.pid}/fd`)).length };
  }

  /** What the process printed. */
  get said(): string {
    return this.#said;
  }

  #started(): ChildProcess {
    if (this.#child === null) throw new Error("the shop was not started");
    return this.#child;
  }
}

export interface Usage {
  /** Of objects and buffers, bytes. */
  heap: number;
  rss: number;
  /** Open files and connections. */
  files: number;
}

/** Returns true if there was such a process: it may have ended since its number was read. */
function isKilled(pid: number, signal: NodeJS.Signals): boolean {
  try {
    return process.kill(pid, signal);
  } catch {
    return false;
  }
}
