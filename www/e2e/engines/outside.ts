/**
 * Stands for all other hosts: a proxy that refuses every request and records its host. Requested directly, it serves a page that loads a
 * picture from `another.test`.
 */
import { createServer, type Server } from "node:http";
import { once } from "node:events";
import type { AddressInfo } from "node:net";

export class Outside {
  readonly #server: Server;
  #hosts: string[] = [];

  private constructor(server: Server) {
    this.#server = server;
    server.on("clientError", (_, socket) => socket.destroy());
    server.on("request", ({ url = "" }, response) => {
      if (url.startsWith("/")) {
        response.writeHead(200, { "content-type": "text/html" }).end(`<!doctype html><img src="http://another.test/picture.png">`);
        return;
      }
      this.#hosts.push(new URL(url).hostname);
      response.writeHead(403, { "content-type": "text/html" }).end("<!doctype html><title>refused</title>");
    });
    // A CONNECT request names host and port.
    server.on("connect", ({ url = "" }, socket) => {
      // A browser may hang up without waiting.
      socket.on("error", () => undefined);
      this.#hosts.push(url.replace(/:\d+$/, ""));
      socket.end("HTTP/1.1 403 Forbidden\r\n\r\n");
    });
  }

  static async open(): Promise<Outside> {
    const server = createServer().listen(0, "127.0.0.1");
    await once(server, "listening");
    return new Outside(server);
  }

  get port(): number {
    return (this.#server.address() as AddressInfo).port;
  }

  /** Hosts requested since the last call. */
  hosts(): string[] {
    const hosts = this.#hosts;
    this.#hosts = [];
    return hosts;
  }

  close(): void {
    this.#server.closeAllConnections();
    this.#server.close();
  }
}
