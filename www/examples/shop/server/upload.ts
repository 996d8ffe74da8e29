/** Reads an order's form: two numbers, and three files, which are written to a folder under fixed names. */
import { createWriteStream } from "node:fs";
import type { IncomingMessage } from "node:http";
import { join } from "node:path";
import type { Readable } from "node:stream";
import { pipeline } from "node:stream/promises";
import { Busboy, type BusboyFileStream, type BusboyHeaders } from "@fastify/busboy";
import { MOST_COPIES, type PartName } from "../catalogue.js";
import { Refusal } from "./refusal.js";

/** File names in an order's folder; all printers of the shop take the same format. */
export const FILES: Readonly<Record<PartName, string>> = { plan: "plan.json", model: "model.stl", print: "print.goo" };

const PARTS = Object.keys(FILES) as PartName[];

export interface Form {
  copies: number;
  /** The price that the customer agreed to. */
  price_cents: number;
  /** The customer's name of the model file, safe to show. */
  model_name: string;
}

/** Allowance for the two numbers and the boundaries between the parts. */
const FRAME_BYTES = 10_000;

/** @param most maximum file sizes, in bytes */
export async function receive(
  request: IncomingMessage,
  folder: string,
  most: Readonly<Record<PartName, number>>,
  signal: AbortSignal,
): Promise<Form> {
  const whole = PARTS.reduce((sum, name) => sum + most[name], FRAME_BYTES);
  if (Number(request.headers["content-length"] ?? 0) > whole) throw tooLarge(whole);
  const fields = new Map<string, string>();
  const files = new Map<PartName, Promise<void>>();
  let model_name = "";
  const streams: Readable[] = [];
  const form = parser(request, Math.max(...PARTS.map((name) => most[name])));
  form.on("field", (name, value) => void fields.set(name, value));
  try {
    // Not a pipeline, which would close the connection at the first fault without an answer to the client.
    await new Promise<void>((resolve, reject) => {
      const tooMany = (): void => reject(new Refusal("bad-order", "There is more in the order than belongs there."));
      form.on("file", (name, stream, filename) => {
        const part = PARTS.find((part) => part === name);
        if (part === undefined || files.has(part)) {
          stream.resume();
          return tooMany();
        }
        if (part === "model") model_name = shownName(filename);
        const written = write(stream, join(folder, FILES[part]), part, most[part], signal);
        written.catch(reject);
        files.set(part, written);
        streams.push(stream);
      });
      form.once("filesLimit", tooMany).once("fieldsLimit", tooMany);
      form.once("finish", resolve);
      form.once("error", reject);
      request.once("error", reject);
      signal.addEventListener("abort", () => reject(signal.reason as Error), { once: true });
      request.pipe(form);
    });
    await Promise.all(files.values());
  } catch (error) {
    request.unpipe(form);
    for (const stream of streams) stream.destroy();
    await Promise.allSettled(files.values());
    if (error instanceof Refusal || signal.aborted) throw error;
    throw new Refusal("not-a-form", "The order arrived incomplete.");
  }
  const missing = PARTS.find((name) => !files.has(name));
  if (missing !== undefined) throw new Refusal("bad-order", `The ${missing} is missing.`);
  return {
    copies: wholeNumber(fields.get("copies"), 1, MOST_COPIES, "number of copies"),
    price_cents: wholeNumber(fields.get("price_cents"), 0, Number.MAX_SAFE_INTEGER, "price"),
    model_name,
  };
}

function write(stream: BusboyFileStream, path: string, part: PartName, most_bytes: number, signal: AbortSignal): Promise<void> {
  const capped = async function* (chunks: AsyncIterable<Buffer>): AsyncGenerator<Buffer> {
    let bytes = 0;
    for await (const chunk of chunks) {
      bytes += chunk.length;
      if (bytes > most_bytes) throw tooLarge(most_bytes, part);
      yield chunk;
    }
  };
  return pipeline(stream, capped, createWriteStream(path, { flags: "wx" }), { signal });
}

function parser(request: IncomingMessage, fileSize: number): InstanceType<typeof Busboy> {
  try {
    return new Busboy({
      headers: request.headers as BusboyHeaders,
      limits: { fieldNameSize: 32, fieldSize: 32, fields: 2, files: PARTS.length, fileSize: fileSize + 1, headerPairs: 10 },
      isPartAFile: (_name, type) => type !== undefined && type !== "text/plain",
    });
  } catch {
    throw new Refusal("not-a-form", "An order is a form with files.");
  }
}

function wholeNumber(text: string | undefined, least: number, most: number, name: string): number {
  const value = /^\d{1,15}$/.test(text ?? "") ? Number(text) : Number.NaN;
  if (value >= least && value <= most) return value;
  throw new Refusal("bad-order", `The ${name} is no whole number from ${least} to ${most}.`);
}

const MOST_NAME_CHARACTERS = 100;

/**
 * A file name safe to show, also in a terminal: without characters that are control codes, change the direction of text or are invisible.
 */
function shownName(name = ""): string {
  return name.slice(0, MOST_NAME_CHARACTERS).replaceAll(/[\p{C}\p{Zl}\p{Zp}]/gu, "").trim();
}

function tooLarge(bytes: number, part?: PartName): Refusal {
  const what = part === undefined ? "The order" : part === "print" ? "The print file" : `The ${part}`;
  return new Refusal("too-large", `${what} is larger than the ${(bytes / 1e6).toLocaleString("en")} MB that this shop takes.`);
}
