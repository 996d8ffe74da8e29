/** Identifies clients, so that none can take all places. */
import type { IncomingMessage } from "node:http";
import { isIPv6 } from "node:net";

/**
 * Address of a client, as appended to X-Forwarded-For by the web server in front; earlier entries are the client's own claim. For IPv6 it
 * is the /64 network, within which a client can use any address.
 */
export function clientOf({ headers, socket }: Pick<IncomingMessage, "headers" | "socket">): string {
  const forwarded = String(headers["x-forwarded-for"] ?? "").split(",").at(-1)?.trim();
  const address = (forwarded || socket.remoteAddress || "").replace(/^::ffff:(?=\d+\.)/i, "");
  if (!isIPv6(address)) return address;
  const [head = [], tail = []] = address.toLowerCase().split("::").map((part) => (part === "" ? [] : part.split(":")));
  const zeros = Array.from({ length: Math.max(0, 8 - head.length - tail.length) }, () => "0");
  return [...head, ...zeros, ...tail].slice(0, 4).join(":");
}
