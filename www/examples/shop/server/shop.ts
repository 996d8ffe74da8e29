/** The shop's server: its page, and one URL for orders. */
import { readFile } from "node:fs/promises";
import { createServer, type IncomingMessage, type Server, type ServerResponse } from "node:http";
import type { Socket } from "node:net";
import { join } from "node:path";
import { LIMITS as PRINTABLE, MOST_BYTES, pricesOf, type PartName } from "../catalogue.js";
import { clientOf } from "./client.js";
import { readPages, type PageFile } from "./pages.js";
import { Places } from "./places.js";
import { wantedBy, type Wanted } from "./plan.js";
import { Queue } from "./queue.js";
import { Refusal, STATUS } from "./refusal.js";
import { Store, type Order } from "./store.js";
import { FILES, receive, type Form } from "./upload.js";
import { verify, type Verifier } from "./verify.js";

/** Sources required by the element according to docs/embed.md, then by this page's own style sheet and forms. */
const POLICY = [
  "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'",
  "style-src 'self'; img-src 'self'; form-action 'none'; base-uri 'none'; frame-ancestors 'none'",
].join("; ");

const SECURITY = {
  "content-security-policy": POLICY,
  "cross-origin-opener-policy": "same-origin",
  "cross-origin-resource-policy": "same-origin",
  "referrer-policy": "no-referrer",
  "x-content-type-options": "nosniff",
};

/** Other machines connect through a web server with TLS. */
const HOST = "127.0.0.1";

const CLOSING = new Refusal("closing", "The shop closes just now. Please try again in a minute.");

export interface Setup extends Partial<Limits> {
  /** Folder of the orders. */
  folder: string;
  /** The built page. */
  pages: string;
  /** The native program for verification. */
  cusp: string;
}

export interface Limits {
  /** Maximum file sizes, in bytes. */
  most_bytes: Readonly<Record<PartName, number>>;
  /** Maximum number of uploaded orders in progress; one of them is verified, the others wait. */
  places: number;
  places_per_client: number;
  /** Maximum number of uploads in progress per client, until they are answered. */
  uploads_per_client: number;
  /** Time limit of a verification, ms. */
  verify_ms: number;
  /** Time limit of an upload, ms. */
  upload_ms: number;
}

const LIMITS: Limits = {
  most_bytes: MOST_BYTES,
  places: 8,
  places_per_client: 2,
  uploads_per_client: 4,
  verify_ms: 120_000,
  upload_ms: 300_000,
};

export interface Shop {
  /**
   * Starts to listen and returns the URL.
   *
   * @param port 0 for any free port
   */
  listen(port: number): Promise<string>;
  /** Refuses orders in progress and removes their files. */
  close(): Promise<void>;
}

export async function createShop({ folder, pages: built, cusp, ...given }: Setup): Promise<Shop> {
  const limits = { ...LIMITS, ...given };
  const [pages, store] = await Promise.all([readPages(built), Store.open(folder)]);
  const uploads = new Places(Infinity, limits.uploads_per_client);
  const places = new Places(limits.places, limits.places_per_client);
  const queue = new Queue();
  const closing = new AbortController();
  const verifier: Verifier = { cusp, limit_ms: limits.verify_ms };

  /** Checks an uploaded order, and takes it. */
  const take = async (folder: string, key: string, wanted: Form & Wanted, signal: AbortSignal): Promise<Order> => {
    // Of two orders that arrive with one key at the same time, the second gets the result of the first.
    const before = await store.find(key);
    if (before !== null) return before;
    const { model_name, printer, resin, copies, price_cents } = wanted;
    const terms = { limits: PRINTABLE, prices: pricesOf(printer, resin), copies };
    const verified = await verify(folder, terms, verifier, signal);
    const { lines, total } = verified.price;
    if (total !== price_cents) throw new Refusal("price-differs", "The price is another by now. Please load this page anew.");
    const state = verified.printability.verdict === "review" ? "review" : "accepted";
    return store.keep(folder, key, { state, model_name, printer: printer.name, resin: resin.name, copies, lines, price_cents: total, verified });
  };

  const order = async (request: IncomingMessage, key: string, signal: AbortSignal): Promise<Order> =>
    (await store.find(key)) ??
    store.withFolder(async (folder) => {
      const form = await receive(request, folder, limits.most_bytes, signal);
      const wanted = wantedBy(await readFile(join(folder, FILES.plan), "utf8"));
      const leave = places.take(clientOf(request));
      return queue.inTurn(() => take(folder, key, { ...form, ...wanted }, signal)).finally(leave);
    });

  /**
   * Waits until the client can read an answer: a browser reads none before its upload is complete, so the rest is received and discarded,
   * up to twice the maximum of an honest order. Returns true if the client is still connected.
   */
  const isHeard = async (request: IncomingMessage, response: ServerResponse): Promise<boolean> => {
    const most = 2 * Object.values(limits.most_bytes).reduce((sum, bytes) => sum + bytes, 0);
    if (!(await drain(request, most, closing.signal))) response.setHeader("connection", "close");
    return !response.destroyed;
  };

  const answer = async (request: IncomingMessage, response: ServerResponse): Promise<void> => {
    const { method, url: address = "/" } = request;
    if (method !== "GET" && method !== "HEAD") response.once("close", uploads.take(clientOf(request)));
    const base = `http://${HOST}`;
    if (!URL.canParse(address, base)) throw new Refusal("bad-address", "This is no address of a page.");
    const { pathname } = new URL(address, base);
    if (pathname !== "/orders") return sendPage(pages.get(pathname), request, response);
    if (method !== "POST") throw new Refusal("method-not-allowed", "Orders are posted.");
    const from = request.headers["sec-fetch-site"];
    if (from !== undefined && from !== "same-origin") throw new Refusal("foreign-page", "Orders come from the shop's own page.");
    const gone = new AbortController();
    response.once("close", () => gone.abort());
    const placed = await order(request, keyOf(request), AbortSignal.any([gone.signal, closing.signal]));
    if (await isHeard(request, response)) sendJson(response, 201, placed);
  };

  const refuse = async (error: unknown, request: IncomingMessage, response: ServerResponse): Promise<void> => {
    // Receiving what exceeds the limit would defeat it.
    if (error instanceof Refusal && error.code === "too-many-orders") response.setHeader("connection", "close");
    else if (!(await isHeard(request, response))) return;
    const { code, message } = closing.signal.aborted ? CLOSING : asRefusal(error);
    sendJson(response, STATUS[code], { code, message });
  };

  // Node checks for late uploads at intervals.
  const late = { requestTimeout: limits.upload_ms, connectionsCheckingInterval: limits.upload_ms / 100 };
  const server = createServer(late, (request, response) => {
    answer(request, response).catch((error: unknown) => {
      if (response.headersSent || response.destroyed) response.destroy();
      else void refuse(error, request, response);
    });
  });

  // Browsers open connections in advance, which Node counts as busy.
  const unused = new Set<Socket>();
  server.on("connection", (socket) => {
    unused.add(socket);
    socket.once("close", () => unused.delete(socket));
  });
  server.on("request", ({ socket }) => unused.delete(socket));

  return {
    listen: (port) => listen(server, port),
    close() {
      closing.abort();
      for (const socket of unused) socket.destroy();
      return new Promise((resolve) => void server.close(() => resolve()));
    },
  };
}

const UUID = /^[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}$/i;

/** Key of an order; sent again, it means the same order. */
function keyOf({ headers }: IncomingMessage): string {
  const key = headers["idempotency-key"];
  if (typeof key === "string" && UUID.test(key)) return key.toLowerCase();
  throw new Refusal("bad-order", "An order needs an Idempotency-Key that is a UUID.");
}

function listen(server: Server, port: number): Promise<string> {
  return new Promise((resolve, reject) => {
    server.once("error", reject);
    server.listen(port, HOST, () => {
      const address = server.address();
      if (address === null || typeof address !== "object") reject(new Error("the server has no port"));
      else resolve(`http://${HOST}:${address.port}/`);
    });
  });
}

function sendPage(file: PageFile | undefined, { method }: IncomingMessage, response: ServerResponse): void {
  if (file === undefined) throw new Refusal("no-such-page", "There is no such page.");
  if (method !== "GET" && method !== "HEAD") throw new Refusal("method-not-allowed", "Pages are only to be read.");
  response.writeHead(200, {
    ...SECURITY,
    "content-type": file.type,
    "content-length": file.bytes.length,
    "cache-control": file.isHashed ? "public, max-age=31536000, immutable" : "no-cache",
  });
  response.end(method === "HEAD" ? undefined : file.bytes);
}

function sendJson(response: ServerResponse, status: number, value: unknown): void {
  response.writeHead(status, { ...SECURITY, "content-type": "application/json", "cache-control": "no-store" });
  response.end(JSON.stringify(value));
}

/** Discards the rest of a request; returns true if the request was complete. */
function drain(request: IncomingMessage, most_bytes: number, signal: AbortSignal): Promise<boolean> {
  if (request.complete || request.destroyed || signal.aborted) return Promise.resolve(request.complete);
  return new Promise((resolve) => {
    let bytes = 0;
    const done = (): void => {
      // The signal lives as long as the server, so remove the listener.
      signal.removeEventListener("abort", done);
      resolve(request.complete);
    };
    request.once("end", done).once("close", done).once("error", done);
    signal.addEventListener("abort", done);
    request.on("data", (chunk: Buffer) => {
      bytes += chunk.length;
      if (bytes <= most_bytes) return;
      request.pause();
      done();
    });
    request.resume();
  });
}

function asRefusal(error: unknown): Refusal {
  if (error instanceof Refusal) return error;
  // For the shop's operator; customers see no internals.
  console.error(error);
  return new Refusal("failed", "Something went wrong on our side. Your order was not taken.");
}
