/** Tells clients apart, so that none takes the places of all. */
import type { IncomingMessage } from "node:http";
import { isIPv6 } from "node:net";

/**
 * The address of a client as the web server in front appends it to X-Forwarded-For: what stands before that is the client's own
 * claim. Of IPv6 it is the network, /64, in which a client has any address.
 */
export function clientOf({ headers, socket }: Pick<IncomingMessage, "headers" | "socket">): string {
  const forwarded = String(headers["x-forwarded-for"] ?? "").split(",").at(-1)?.trim();
  const address = (forwarded || socket.remoteAddress || "").replace(/^::ffff:(?=\d+\.)/i, "");
  if (!isIPv6(address)) return address;
  const [head = [], tail = []] = address.toLowerCase().split("::").map((part) => (part === "" ? [] : part.split(":")));
  const zeros = Array.from({ length: Math.max(0, 8 - head.length - tail.length) }, () => "0");
  return [...head, ...zeros, ...tail].slice(0, 4).join(":");
}
