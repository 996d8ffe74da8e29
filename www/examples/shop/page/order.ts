/** Sends an order and returns the server's answer. */
import type { Price } from "cusp-slicer";
import type { PartName } from "../catalogue.js";

export interface Placed {
  id: string;
  state: "accepted" | "review";
  copies: number;
  lines: Price["lines"];
  price_cents: number;
}

export interface Ordered {
  /** Identifies this order each time it is sent, so that the shop takes it only once. */
  key: string;
  copies: number;
  price_cents: number;
  model_name: string;
  parts: Readonly<Record<PartName, Blob>>;
}

/** Error with the reason for which an order was not taken. */
export class OrderError extends Error {
  readonly code: string;

  constructor(code: string, message: string) {
    super(message);
    this.name = "OrderError";
    this.code = code;
  }
}

export async function placeOrder({ key, copies, price_cents, model_name, parts }: Ordered, signal: AbortSignal): Promise<Placed> {
  const form = new FormData();
  form.set("copies", String(copies));
  form.set("price_cents", String(price_cents));
  for (const [name, blob] of Object.entries(parts)) {
    form.set(name, new Blob([blob], { type: "application/octet-stream" }), name === "model" ? model_name : name);
  }
  try {
    const response = await fetch("orders", { method: "POST", body: form, headers: { "idempotency-key": key }, signal });
    if (response.ok) return (await response.json()) as Placed;
    const answer = (await response.json().catch(() => ({}))) as Partial<OrderError>;
    throw new OrderError(answer.code ?? "failed", answer.message ?? `The shop could not take the order (HTTP ${response.status}).`);
  } catch (error) {
    if (signal.aborted || error instanceof OrderError) throw error;
    // The shop may or may not have taken the order; sent again, it is the same order.
    throw new OrderError("unreachable", "The shop does not answer. Please try again: this will be one order and not two.");
  }
}
