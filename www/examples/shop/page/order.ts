/** Sends an order and says what became of it. */
import type { PartName } from "../catalogue.js";
import type { Line } from "../price.js";

export interface Placed {
  id: string;
  copies: number;
  lines: readonly Line[];
  price_cents: number;
}

/** What the server answered instead of taking an order. */
export class OrderError extends Error {
  readonly code: string;

  constructor(code: string, message: string) {
    super(message);
    this.name = "OrderError";
    this.code = code;
  }
}

export async function placeOrder(
  { copies, price_cents, parts }: { copies: number; price_cents: number; parts: Readonly<Record<PartName, Blob>> },
  signal: AbortSignal,
): Promise<Placed> {
  const form = new FormData();
  form.set("copies", String(copies));
  form.set("price_cents", String(price_cents));
  for (const [name, blob] of Object.entries(parts)) form.set(name, new Blob([blob], { type: "application/octet-stream" }));
  const response = await fetch("orders", { method: "POST", body: form, signal }).catch((error: unknown) => {
    if (signal.aborted) throw error;
    throw new OrderError("unreachable", "The shop does not answer. Your order was not taken.");
  });
  const answer = (await response.json().catch(() => ({}))) as Partial<Placed & OrderError>;
  if (response.ok) return answer as Placed;
  throw new OrderError(answer.code ?? "failed", answer.message ?? `The shop could not take the order (HTTP ${response.status}).`);
}
