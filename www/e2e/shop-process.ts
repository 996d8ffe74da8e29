/** The example shop's server in its own process, to be killed and restarted. */
import { fork, type ChildProcess } from "node:child_process";
import { once } from "node:events";
import { readdir, readFile } from "node:fs/promises";
import { setTimeout as wait } from "node:timers/promises";
import { fileURLToPath } from "node:url";

const WWW = fileURLToPath(new URL("..", import.meta.url));

/** After a restart, it listens on the same port. */
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

  /** Sends a signal and returns the exit code; null if the signal killed the process. */
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

  /** Resources in use while idle. */
  async usage(): Promise<Usage> {
    const child = this.#started();
    child.send("usage");
    const [{ heapUsed, external, rss }] = (await once(child, "message")) as [NodeJS.MemoryUsage];
    return { heap: heapUsed + external, rss, files: (await readdir(`/proc/${child.pid}/fd`)).length };
  }

  /** Output of the process. */
  get said(): string {
    return this.#said;
  }

  #started(): ChildProcess {
    if (this.#child === null) throw new Error("the shop was not started");
    return this.#child;
  }
}

export interface Usage {
  /** Memory of objects and buffers, bytes. */
  heap: number;
  rss: number;
  /** Number of open files and connections. */
  files: number;
}

/** Returns true if the process existed: it may have ended since its id was read. */
function isKilled(pid: number, signal: NodeJS.Signals): boolean {
  try {
    return process.kill(pid, signal);
  } catch {
    return false;
  }
}
