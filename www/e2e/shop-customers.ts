/** Customers of the example shop, honest and dishonest, who send orders until each is taken or refused. */
import { randomInt, randomUUID } from "node:crypto";
import { setTimeout as wait } from "node:timers/promises";
import { expect } from "vitest";
import type { Good } from "./shop-goods.js";
import { send, type Answer, type Sent } from "./shop-open.js";

const CUSTOMERS = 10;
/** Connections are cut within this time after the order is sent; most verifications take longer. */
const CUT_MS = 100;
/** Delay before customers try again. */
const AGAIN_MS = 200;

/** An order to send, with the expected outcome. */
interface Wanted extends Sent {
  good: Good;
  /** Code of the expected refusal; null if it is taken. */
  refusal: string | null;
}

function wanted(good: Good, refusal: string | null = null, changed: Sent["parts"] = {}): Wanted {
  const { plan, model, print } = good.files;
  const files = { plan: file(plan), model: file(model), print: file(print) };
  const parts = { copies: String(good.copies), price_cents: String(good.verified.price.total), ...files, ...changed };
  // Each from its own network, since the shop limits orders per network.
  const [a, b] = [0, 0].map(() => randomInt(0x10000).toString(16));
  return { key: randomUUID(), headers: { "x-forwarded-for": `2001:db8:${a}:${b}::1` }, parts, good, refusal };
}

function file(content: Uint8Array | string): Blob {
  return new Blob([typeof content === "string" ? content : new Uint8Array(content)], { type: "application/octet-stream" });
}

/** Orders of dishonest customers, in turn. */
function forged(good: Good, other: Good, turn: number): Wanted {
  const { plan, print } = good.files;
  const altered = (by: object): Blob => file(JSON.stringify({ ...(JSON.parse(plan.toString()) as object), ...by }));
  const { model } = JSON.parse(other.files.plan.toString()) as { model: object };
  const flipped = Buffer.from(print);
  flipped.writeUInt8(flipped.readUInt8(flipped.length >> 1) ^ 1, flipped.length >> 1);
  const forgeries: readonly [refusal: string, parts: Sent["parts"]][] = [
    ["plan-refused", { model: file(other.files.model) }],
    ["plan-refused", { model: file(other.files.model), plan: altered({ model }) }],
    ["plan-refused", { plan: file(other.files.plan), print: file(other.files.print) }],
    ["plan-refused", { plan: altered({ print_time_s: 1 }) }],
    ["print-refused", { print: file(flipped) }],
    ["print-refused", { print: file(other.files.print) }],
    ["price-differs", { price_cents: String(good.verified.price.total - 1) }],
  ];
  const [refusal, parts] = forgeries[turn % forgeries.length] ?? ["", {}];
  return wanted(good, refusal, parts);
}

/** The customers, and the outcomes of their orders. */
export class Customers {
  /** Order and answer by the order's key. */
  readonly taken = new Map<string, { good: Good; order: Answer }>();
  /** Number of times that each answer came. */
  readonly answers: Record<string, number> = {};
  readonly #address: string;
  readonly #goods: readonly Good[];
  readonly #unprintable: Good;
  #turns = 0;

  constructor(address: string, goods: readonly Good[], unprintable: Good) {
    this.#address = address;
    this.#goods = goods;
    this.#unprintable = unprintable;
  }

  /** Sends orders of several customers at once until `isOver`, and until the outcome of each last order is known. */
  async order(isOver: () => boolean): Promise<void> {
    const customer = async (): Promise<void> => {
      while (!isOver()) await this.#orderNext();
    };
    await Promise.all(Array.from({ length: CUSTOMERS }, customer));
  }

  async #orderNext(): Promise<void> {
    const turn = this.#turns++;
    const [good, other] = [0, 1].map((ahead) => this.#goods[(turn + ahead) % this.#goods.length]) as [Good, Good];
    switch (turn % 8) {
      // The connection breaks while the order is being sent, checked or answered; then it is sent again.
      case 0: {
        const one = wanted(good);
        await this.#send({ ...one, signal: AbortSignal.timeout(turn % CUT_MS) });
        return this.#settle(one);
      }
      // The button is pressed twice.
      case 1: {
        const one = wanted(good);
        await Promise.all([this.#settle(one), this.#settle(one)]);
        return;
      }
      // An old order is sent again.
      case 2: {
        const [key, before] = [...this.taken][turn % (this.taken.size + 1)] ?? [randomUUID(), { good }];
        return this.#settle({ ...wanted(before.good), key });
      }
      case 3:
      case 4:
        return this.#settle(forged(good, other, turn));
      case 5:
        return this.#settle(wanted(this.#unprintable, "not-printable"));
      default:
        return this.#settle(wanted(good));
    }
  }

  /** Sends an order until it is taken or refused, as a customer presses the button again. */
  async #settle(one: Wanted): Promise<void> {
    for (;;) {
      const answer = await this.#send(one);
      if (answer !== null && answer.status < 500) return;
      await wait(AGAIN_MS);
    }
  }

  /** Sends an order once, and records the answer; null if none came. */
  async #send(one: Wanted): Promise<Answer | null> {
    const answer = await send(this.#address, one).catch(() => null);
    const name = answer === null ? "none" : (answer.code ?? "taken");
    this.answers[name] = (this.answers[name] ?? 0) + 1;
    if (answer === null || answer.status >= 500) return answer;
    expect(answer.code ?? null).toBe(one.refusal);
    if (one.refusal !== null) return answer;
    // A repeated order has the same answer.
    expect(answer).toEqual(this.taken.get(one.key)?.order ?? answer);
    this.taken.set(one.key, { good: one.good, order: answer });
    return answer;
  }
}
