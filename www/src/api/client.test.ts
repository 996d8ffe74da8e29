import { beforeEach, expect, test } from "vitest";
import type { Watch, WorkerHandle } from "./calls.js";
import { Client, type Loaded, type Models } from "./client.js";
import { SlicerError } from "./error.js";
import { fakeWorker } from "./fake-worker.js";
import type { CuspError, OnProgress, Opened, Options, ProfiledPlates, SlicerWorker } from "./wire.js";

/** The calls to the fake workers, in order: `worker number: call`. */
let log: string[];
let workers: FakeWorker[];

/** Fake worker that can hang, as in a long computation, or fail. */
class FakeWorker implements WorkerHandle {
  readonly number = workers.push(this);
  terminated = false;
  hang = false;
  failure: unknown = null;
  memory_bytes = 1 << 24;
  broken: (message: string) => void = () => undefined;

  readonly remote: SlicerWorker = {
    ...fakeWorker((what) => this.#work(what)),
    boot: async (module) => {
      log.push(`${this.number}: ${typeof module === "string" ? "boot, compiling" : "boot"}`);
      return {};
    },
    memory: () => this.memory_bytes,
  };

  terminate(): void {
    this.terminated = true;
  }

  onBroken(callback: (message: string) => void): void {
    this.broken = callback;
  }

  async #work(what: string): Promise<void> {
    log.push(`${this.number}: ${what}`);
    if (this.hang) await new Promise(() => undefined);
    if (this.failure !== null) throw this.failure;
  }
}

/** Uses a client as `createSlicer()` does: each call concerns the model opened last. */
class Caller {
  readonly client: Client;
  models: Models = Promise.resolve([]);
  #opened = 0;

  constructor(spawn: () => WorkerHandle) {
    this.client = new Client(spawn, { module: null, address: "" });
  }

  open(file: Blob | Promise<Blob>, watch: Watch): Promise<Opened> {
    const id = ++this.#opened;
    const arriving = Promise.resolve(file);
    const opened = this.client.add(null, id, arriving, {}, watch);
    const before = this.models;
    this.models = Promise.all([arriving, opened]).then(
      ([file, { info }]): Loaded[] => [{ id, name: "", file, reading: {}, search_bytes: info.search_bytes, weights: null }],
      () => before,
    );
    return opened;
  }

  plan(options: Options, watch: Watch): Promise<ProfiledPlates> {
    return this.client.plan(this.models.then((models) => ({ models, options: { options } })), watch);
  }
}

let caller: Caller;

beforeEach(() => {
  log = [];
  workers = [];
  caller = new Caller(() => new FakeWorker());
});

function watch(signal = new AbortController().signal, onProgress: OnProgress = () => undefined): Watch {
  return { signal, onProgress };
}

const worker = (number: number): FakeWorker => {
  const found = workers[number - 1];
  if (found === undefined) throw new Error(`there is no worker ${number}`);
  return found;
};

async function hung(call: (watch: Watch) => Promise<unknown>): Promise<void> {
  const abort = new AbortController();
  const running = call(watch(abort.signal));
  const outcome = expect(running).rejects.toMatchObject({ name: "AbortError" });
  await new Promise((resolve) => setTimeout(resolve));
  abort.abort();
  await outcome;
}

test("warm() starts the worker that later calls use, and only that one", async () => {
  caller.client.warm();
  await caller.open(new Blob(["a"]), watch());
  await caller.plan({ tolerance: 1 }, watch());
  await caller.client.mask(0, 3);
  expect(log).toEqual(["1: boot, compiling", "1: add a", "1: plan 1 of a", "1: mask 3 of plate 0, 1"]);
});

test("a warm worker rehearses a plan once it is idle, unless it has been asked for something by then", async () => {
  caller.client.warm();
  void caller.client.printers();
  await expect.poll(() => log).toEqual(["1: boot, compiling", "1: warmUp"]);
  const busy = new Caller(() => new FakeWorker());
  busy.client.warm();
  await busy.open(new Blob(["a"]), watch());
  await busy.plan({ tolerance: 1 }, watch());
  await new Promise((resolve) => setTimeout(resolve, 10));
  expect(log.slice(2)).toEqual(["2: boot, compiling", "2: add a", "2: plan 1 of a"]);
});

test("progress is reported", async () => {
  const stages: string[] = [];
  await caller.open(new Blob(["a"]), watch());
  await caller.plan({}, watch(undefined, (stage, fraction, done) => stages.push(`${stage} ${fraction} ${done}`)));
  expect(stages).toEqual(["ldi 0.5 0.4"]);
});

test("cancelling a plan terminates the worker; the next one gets the module, the file and the last good plan", async () => {
  await caller.open(new Blob(["a"]), watch());
  await caller.plan({ tolerance: 1 }, watch());
  worker(1).hang = true;
  await hung((watch) => caller.plan({ tolerance: 2 }, watch));
  expect(worker(1).terminated).toBe(true);
  log = [];
  await caller.client.mask(0, 0);
  expect(log).toEqual(["2: boot", "2: add a", "2: plan 1 of a", "2: mask 0 of plate 0, 1"]);
});

test("checks are of the last good plan", async () => {
  await expect(caller.client.inspect(0, {}, watch())).rejects.toMatchObject({ code: "no-plan" });
  await caller.open(new Blob(["a"]), watch());
  await caller.plan({ tolerance: 1 }, watch());
  worker(1).hang = true;
  await hung((watch) => caller.plan({ tolerance: 2 }, watch));
  log = [];
  await caller.client.inspect(0, { wall_mm: 0.5 }, watch());
  expect(log).toEqual(["2: boot", "2: add a", "2: plan 1 of a", "2: inspect 0.5 of plate 0, 1"]);
});

test("plugs are for the holes of the last good plan", async () => {
  await expect(caller.client.plugs(Promise.resolve(1), {})).rejects.toMatchObject({ code: "no-plan" });
  await caller.open(new Blob(["a"]), watch());
  await caller.plan({ tolerance: 1 }, watch());
  worker(1).failure = { code: "too-many-facets", message: "no", detail: null };
  await expect(caller.plan({ tolerance: 2 }, watch())).rejects.toBeInstanceOf(SlicerError);
  worker(1).failure = null;
  log = [];
  expect(await caller.client.plugs(Promise.resolve(1), {})).toHaveLength(84);
  expect(log).toEqual(["1: plan 1 of a", "1: plugs of a, 1"]);
});

test("cancelling while a file is read keeps the previous model", async () => {
  await caller.open(new Blob(["a"]), watch());
  worker(1).hang = true;
  await hung((watch) => caller.open(new Blob(["b"]), watch));
  log = [];
  await caller.plan({ tolerance: 1 }, watch());
  expect(log).toEqual(["2: boot", "2: add a", "2: plan 1 of a"]);
});

test("a queued call can be cancelled without terminating the worker", async () => {
  await caller.open(new Blob(["a"]), watch());
  const abort = new AbortController();
  const first = caller.plan({ tolerance: 1 }, watch());
  const second = caller.plan({ tolerance: 2 }, watch(abort.signal));
  abort.abort();
  await expect(second).rejects.toMatchObject({ name: "AbortError" });
  await first;
  expect(worker(1).terminated).toBe(false);
  expect(log.at(-1)).toBe("1: plan 1 of a");
});

test("an error from the core keeps its code, its details and the worker; masks come from the last good plan", async () => {
  await caller.open(new Blob(["a"]), watch());
  await caller.plan({ tolerance: 1 }, watch());
  const failure: CuspError = { code: "too-many-facets", message: "no", detail: { facets: 2, most: 1 } };
  worker(1).failure = failure;
  const running = caller.plan({ tolerance: 2 }, watch());
  await expect(running).rejects.toBeInstanceOf(SlicerError);
  await expect(running).rejects.toMatchObject(failure);
  worker(1).failure = null;
  log = [];
  await caller.client.mask(0, 0);
  expect(log).toEqual(["1: plan 1 of a", "1: mask 0 of plate 0, 1"]);
});

test("a core that crashes is replaced", async () => {
  await caller.open(new Blob(["a"]), watch());
  worker(1).failure = new WebAssembly.RuntimeError("unreachable");
  await expect(caller.plan({}, watch())).rejects.toMatchObject({ code: "crash", message: "unreachable" });
  expect(worker(1).terminated).toBe(true);
  log = [];
  await caller.plan({ tolerance: 1 }, watch());
  expect(log).toEqual(["2: boot", "2: add a", "2: plan 1 of a"]);
});

test("a core that does not start rejects with start-failed, and the next call tries again", async () => {
  const starts: WorkerHandle[] = [];
  const failing = new Caller(() => {
    const handle = new FakeWorker();
    if (starts.push(handle) === 1) handle.remote.boot = () => Promise.reject(new Error("HTTP 404"));
    return handle;
  });
  failing.client.warm();
  await expect(failing.open(new Blob(["a"]), watch())).rejects.toMatchObject({ code: "start-failed", message: "HTTP 404" });
  await failing.open(new Blob(["a"]), watch());
  expect(log).toEqual(["2: boot, compiling", "2: add a"]);
});

test("a worker that is refused, or whose script cannot be loaded, rejects with worker-failed, and the next call tries again", async () => {
  let starts = 0;
  const failing = new Caller(() => {
    starts += 1;
    if (starts < 3) throw new SlicerError("worker-failed", "SecurityError", { system: "SecurityError" });
    const handle = new FakeWorker();
    if (starts === 3) handle.remote.boot = () => new Promise(() => undefined);
    return handle;
  });
  failing.client.warm();
  await expect(failing.open(new Blob(["a"]), watch())).rejects.toMatchObject({ code: "worker-failed", message: "SecurityError" });
  const opened = failing.open(new Blob(["a"]), watch());
  await expect.poll(() => workers).toHaveLength(1);
  worker(1).broken("no script");
  await expect(opened).rejects.toMatchObject({ code: "worker-failed", message: "no script" });
  await failing.open(new Blob(["a"]), watch());
  expect(log).toEqual(["2: boot, compiling", "2: add a"]);
});

test("workers that start together compile once; where the first of them is ended, the next one does", async () => {
  const compiled = { module: null, address: "" };
  const [first, second] = [0, 1].map(() => new Client(() => new FakeWorker(), compiled));
  await Promise.all([first?.printers(), second?.printers()]);
  expect(log).toEqual(["1: boot, compiling", "2: boot"]);

  const anew = { module: null, address: "" };
  const stuck = new FakeWorker();
  stuck.remote.boot = () => new Promise(() => undefined);
  const ended = new Client(() => stuck, anew);
  const [next, last] = [0, 1].map(() => new Client(() => new FakeWorker(), anew));
  const failed = expect(ended.printers()).rejects.toMatchObject({ name: "AbortError" });
  const waiting = [next?.printers(), last?.printers()];
  await new Promise((resolve) => setTimeout(resolve));
  ended.rest();
  await Promise.all([failed, ...waiting]);
  expect(log.slice(2)).toEqual(["4: boot, compiling", "5: boot"]);
});

test("an error event from the worker fails the pending call", async () => {
  await caller.open(new Blob(["a"]), watch());
  worker(1).hang = true;
  const running = caller.plan({}, watch());
  await new Promise((resolve) => setTimeout(resolve));
  worker(1).broken("no script");
  await expect(running).rejects.toMatchObject({ code: "crash", message: "no script" });
});

test("a queued call is cancelled at once, not when its turn comes", async () => {
  await caller.open(new Blob(["a"]), watch());
  worker(1).hang = true;
  const first = caller.plan({}, watch());
  first.catch(() => undefined);
  const abort = new AbortController();
  const second = caller.plan({}, watch(abort.signal));
  abort.abort();
  await expect(second).rejects.toMatchObject({ name: "AbortError" });
  expect(worker(1).terminated).toBe(false);
});

test("a trade-off leaves the core's plan in place, with the same rays or others", async () => {
  await caller.open(new Blob(["a"]), watch());
  await caller.plan({ tolerance: 1, rays: 512 }, watch());
  log = [];
  const curve = (rays: number): Promise<unknown> => caller.client.asks(caller.models, watch(), (remote, _, progress) => remote.tradeoff(0, { options: { rays } }, 9, progress));
  await curve(512);
  await caller.client.mask(0, 0);
  await curve(1024);
  await caller.client.mask(0, 0);
  expect(log).toEqual([
    "1: tradeoff 9 of plate 0, 512 rays",
    "1: mask 0 of plate 0, 1",
    "1: tradeoff 9 of plate 0, 1024 rays",
    "1: mask 0 of plate 0, 1",
  ]);
});

test("a print file arrives whole, or chunk by chunk in order", async () => {
  await caller.open(new Blob(["a"]), watch());
  await caller.plan({}, watch());
  expect(await (await caller.client.archive(0, null, watch())).blob.text()).toBe("zip");
  const chunks: string[] = [];
  await caller.client.archiveTo(0, null, (chunk) => chunks.push(new TextDecoder().decode(chunk)), watch());
  expect(chunks).toEqual(["z", "ip"]);
});

test("a call made too early says what is missing; calls after dispose() reject", async () => {
  await caller.open(new Blob(["a"]), watch());
  await expect(caller.client.mask(0, 0)).rejects.toMatchObject({ code: "no-plan" });
  caller.client.dispose();
  await expect(caller.client.mask(0, 0)).rejects.toMatchObject({ name: "AbortError" });
  expect(workers).toHaveLength(1);
});

test("calls run in the order they are made: a file still being fetched holds up later calls", async () => {
  await caller.open(new Blob(["a"]), watch());
  let arrive: (file: Blob) => void = () => undefined;
  void caller.open(new Promise<Blob>((resolve) => (arrive = resolve)), watch());
  const planned = caller.plan({ tolerance: 1 }, watch());
  await new Promise((resolve) => setTimeout(resolve));
  arrive(new Blob(["b"]));
  await planned;
  expect(log.slice(2)).toEqual(["1: add b", "1: remove a", "1: plan 1 of b"]);
});

test("cancelling a fetch does not terminate the worker", async () => {
  await caller.open(new Blob(["a"]), watch());
  const abort = new AbortController();
  const opened = caller.open(new Promise(() => undefined), watch(abort.signal));
  abort.abort();
  await expect(opened).rejects.toMatchObject({ name: "AbortError" });
  expect(worker(1).terminated).toBe(false);
});

test("a timeout is an abort, and so is a signal with a custom reason", async () => {
  await caller.open(new Blob(["a"]), watch());
  worker(1).hang = true;
  await expect(caller.plan({}, watch(AbortSignal.timeout(5)))).rejects.toMatchObject({ name: "TimeoutError" });
  const abort = new AbortController();
  const reason = new Error("enough");
  await caller.plan({}, watch());
  worker(2).hang = true;
  const running = caller.plan({}, watch(abort.signal));
  const outcome = expect(running).rejects.toBe(reason);
  await new Promise((resolve) => setTimeout(resolve));
  abort.abort(reason);
  await outcome;
});

const GIGABYTE = 1 << 30;

test("a worker that has grown far beyond what a model needs is replaced before it reads that", async () => {
  await caller.open(new Blob(["a"]), watch());
  await caller.plan({ tolerance: 1 }, watch());
  worker(1).memory_bytes = GIGABYTE;
  // Reloading the same model needs no more memory than before.
  await caller.plan({ tolerance: 2 }, watch());
  expect(worker(1).terminated).toBe(false);
  await caller.open(new Blob(["b"]), watch());
  expect(worker(1).terminated).toBe(true);
  await caller.plan({ tolerance: 1 }, watch());
  expect(log.slice(3)).toEqual(["1: plan 2 of a", "2: boot", "2: add b", "2: plan 1 of b"]);
});

test("a large model may have a large worker, and a modest one is worth no restart", async () => {
  const large = new Blob([new Uint8Array(GIGABYTE / 64)]);
  await caller.open(new Blob(["a"]), watch());
  worker(1).memory_bytes = GIGABYTE;
  await caller.open(large, watch());
  worker(1).memory_bytes = 1 << 28;
  await caller.open(new Blob(["b"]), watch());
  expect(workers).toHaveLength(1);
});

test("a file that a fresh worker cannot read leaves the model before", async () => {
  const refusing = new Caller(() => {
    const it = new FakeWorker();
    if (it.number === 2) it.failure = { code: "file-empty", message: "no", detail: null };
    return it;
  });
  await refusing.open(new Blob(["a"]), watch());
  await refusing.plan({ tolerance: 1 }, watch());
  worker(1).memory_bytes = GIGABYTE;
  await expect(refusing.open(new Blob(["b"]), watch())).rejects.toMatchObject({ code: "file-empty" });
  worker(2).failure = null;
  log = [];
  await refusing.client.mask(0, 0);
  expect(log).toEqual(["2: add a", "2: plan 1 of a", "2: mask 0 of plate 0, 1"]);
});

test("a price is that of the last good plan, also in a fresh worker", async () => {
  const { client } = caller;
  await expect(client.price({ currency: "EUR" }, {}, {})).rejects.toMatchObject({ code: "no-plan" });
  await caller.open(new Blob(["a"]), {});
  await caller.plan({ tolerance: 1 }, {});
  client.rest();
  log = [];
  expect(await client.price({ currency: "EUR" }, { copies: 3, finish: "sanded" }, {})).toMatchObject({ currency: "EUR" });
  // A price needs neither the model nor the plan.
  expect(log.slice(-1)).toEqual([`${workers.length}: price of [{"copies":3,"resin_ml":1.5,"print_time_s":15}], sanded`]);
  expect(log.filter((call) => /plan|add/.test(call))).toEqual([]);
});
