/** Refusal of an order, with the sentence that the page shows at its button. */

/** Every error code of an answer, with its HTTP status. */
export const STATUS = {
  "bad-address": 400,
  "no-such-page": 404,
  "method-not-allowed": 405,
  "foreign-page": 403,
  "not-a-form": 400,
  "too-large": 413,
  "bad-order": 400,
  "not-a-plan": 422,
  "option-refused": 422,
  "plan-refused": 422,
  "model-refused": 422,
  "print-refused": 422,
  "not-printable": 422,
  "price-differs": 409,
  "too-many-orders": 429,
  busy: 503,
  "took-too-long": 503,
  closing: 503,
  failed: 500,
} as const;

export type RefusalCode = keyof typeof STATUS;

export class Refusal extends Error {
  readonly code: RefusalCode;

  /** @param message one sentence for the customer */
  constructor(code: RefusalCode, message: string) {
    super(message);
    this.name = "Refusal";
    this.code = code;
  }
}
