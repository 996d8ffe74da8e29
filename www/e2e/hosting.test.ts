/** The page behind the web servers of docs/hosting.md, with the configurations given there, below a path. */
import { execFileSync, spawn, type ChildProcess } from "node:child_process";
import { cp, mkdir, mkdtemp, readdir, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { afterEach, expect, test } from "vitest";
import { drop, layers, state, USUAL, visit } from "./browser.js";
import { www } from "./package-apps.js";
import { program } from "./program.js";
import { freePort } from "./serve.js";
import { sphere } from "./solids.js";
import { tabs } from "./tabs.js";

const guide = await readFile(join(www, "../docs/hosting.md"), "utf8");

interface Server {
  encoding: string;
  /** Cache lifetime of assets. */
  kept: string;
  /** Writes the server's base configuration around the guide's, and returns the command to start it. */
  start(written: string, port: number, folder: string): Promise<readonly string[]>;
}

const SERVERS: Readonly<Record<string, Server>> = {
  nginx: {
    encoding: "gzip",
    kept: "public, max-age=31536000, immutable",
    async start(written, port, folder) {
      for (const command of written.matchAll(/^find .*$/gm)) execFileSync("sh", ["-c", command[0].replaceAll("/srv/www", folder)]);
      const own = block("nginx").replaceAll("/srv/www", folder).replace("listen 80;", `listen 127.0.0.1:${port};`);
      const temporary = ["client_body", "proxy", "fastcgi", "uwsgi", "scgi"].map((name) => `${name}_temp_path ${folder}/${name};`);
      const around = `daemon off; master_process off; pid ${folder}/nginx.pid; error_log stderr; events {}
http { include /etc/nginx/mime.types; access_log off; ${temporary.join(" ")}
${own} }`;
      await writeFile(join(folder, "nginx.conf"), around);
      return ["-e", "stderr", "-c", join(folder, "nginx.conf")];
    },
  },
  lighttpd: {
    encoding: "br",
    kept: "max-age=31536000",
    async start(_written, port, folder) {
      const own = block("lighttpd").replace("/var/cache/lighttpd/compress", join(folder, "cache"));
      const around = `server.bind = "127.0.0.1"
server.port = ${port}
server.document-root = "${folder}"
index-file.names = ("index.html")
include_shell "/usr/share/lighttpd/create-mime.conf.pl"
${own}`;
      await mkdir(join(folder, "cache"));
      await writeFile(join(folder, "lighttpd.conf"), around);
      return ["-D", "-f", join(folder, "lighttpd.conf")];
    },
  },
};

const closing: (() => Promise<void>)[] = [];
afterEach(async () => {
  for (const close of closing.splice(0).reverse()) await close();
});

/** The guide's configuration for a server. */
function block(server: string): string {
  const found = new RegExp(`^\`\`\`${server}\\n(.*?)^\`\`\``, "ms").exec(guide)?.[1];
  if (found === undefined) throw new Error(`docs/hosting.md has no configuration for ${server}`);
  return found;
}

/** Starts a server with the page in `cusp/`, and returns the page's address. */
async function serve(path: string, { start }: Server): Promise<string> {
  const folder = await mkdtemp(join(tmpdir(), "cusp-hosting-"));
  closing.push(() => rm(folder, { recursive: true, force: true }));
  await cp(join(www, "dist"), join(folder, "cusp"), { recursive: true });
  const port = await freePort();
  const child = spawn(path, [...(await start(guide, port, folder))], { stdio: ["ignore", "ignore", "pipe"] });
  closing.push(() => stop(child));
  let said = "";
  child.stderr.on("data", (chunk) => (said += String(chunk)));
  const address = `http://127.0.0.1:${port}/cusp/`;
  const answers = (): Promise<boolean> => fetch(address).then(({ ok }) => ok, () => false);
  while (!(await answers())) {
    if (child.exitCode !== null) throw new Error(`the server has ended: ${said}`);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  return address;
}

function stop(child: ChildProcess): Promise<void> {
  if (child.exitCode !== null) return Promise.resolve();
  return new Promise((resolve) => {
    child.once("exit", () => resolve());
    child.kill();
  });
}

/** The policy of the built page, as the browser reads it. */
async function builtPolicy(): Promise<string> {
  const page = await readFile(join(www, "dist/index.html"), "utf8");
  return /Content-Security-Policy" content="([^"]*)"/.exec(page)?.[1]?.replaceAll("&#39;", "'") ?? "";
}

for (const [name, server] of Object.entries(SERVERS)) {
  test(`${name}, as the guide has it, serves the page below a path`, async (context) => {
    const path = program([name]);
    if (path === null) {
      const reason = `no ${name} on this machine`;
      Object.assign(context.task.meta, { reason });
      return context.skip(reason);
    }
    const address = await serve(path, server);
    const get = (file: string, headers: Readonly<Record<string, string>> = {}): Promise<Response> => fetch(address + file, { headers, redirect: "manual" });

    const policy = `${await builtPolicy()}; frame-ancestors 'none'`;
    const assets = (await readdir(join(www, "dist/assets"))).map((asset) => `assets/${asset}`);
    const one = (end: string): string => assets.find((asset) => asset.endsWith(end)) ?? `assets/none${end}`;
    const expected: readonly (readonly [string, RegExp, string])[] = [
      ["", /^text\/html/, "no-cache"],
      ["service-worker.js", /^(text|application)\/javascript/, "no-cache"],
      [one(".js"), /^(text|application)\/javascript/, server.kept],
      [one(".css"), /^text\/css/, server.kept],
      [one(".svg"), /^image\/svg\+xml/, server.kept],
      [one(".wasm"), /^application\/wasm$/, server.kept],
    ];
    for (const [file, type, cached] of expected) {
      const { status, headers } = await get(file, { "accept-encoding": server.encoding });
      const header = (name: string): string | null => headers.get(name);
      expect.soft([status, header("cache-control"), header("content-encoding")], file).toEqual([200, cached, server.encoding]);
      expect.soft(header("content-type"), file).toMatch(type);
      expect.soft(header("vary"), file).toMatch(/accept-encoding/i);
      expect.soft(header("content-security-policy"), file).toBe(policy);
      expect.soft(header("x-content-type-options"), file).toBe("nosniff");
      expect.soft(header("referrer-policy"), file).toBe("no-referrer");
      expect.soft(header("cross-origin-opener-policy"), file).toBe("same-origin");
      expect.soft(header("cross-origin-resource-policy"), file).toBe("same-origin");
    }
    // Compressed or not, each equals the built file.
    for (const asset of assets) {
      const built = await readFile(join(www, "dist", asset));
      for (const encoding of [server.encoding, "identity"]) {
        const sent = Buffer.from(await (await get(asset, { "accept-encoding": encoding })).arrayBuffer());
        expect(sent.equals(built), `${asset} ${encoding}`).toBe(true);
      }
    }
    const tag = (await get("", { "accept-encoding": "identity" })).headers.get("etag") ?? "";
    expect((await get("", { "accept-encoding": "identity", "if-none-match": tag })).status).toBe(304);
    const gone = await get("assets/of-another-version.js");
    expect(gone.status).toBe(404);
    expect(gone.headers.get("cache-control") ?? "").not.toContain("max-age");
    const bare = await fetch(address.slice(0, -1), { redirect: "manual" });
    expect([bare.status, new URL(bare.headers.get("location") ?? "", address).pathname]).toEqual([301, "/cusp/"]);

    const { page, strangers, complaints } = await visit(await tabs().take({ ...USUAL, serviceWorkers: "allow" }), address);
    closing.push(() => tabs().giveBack(false));
    await drop(page, { name: "ball.stl", bytes: sphere(5, 48).bytes });
    await state(page, "done");
    expect(await layers(page)).toBeGreaterThan(67);
    expect(await page.evaluate(async () => (await navigator.serviceWorker.ready).scope)).toBe(address);
    expect([strangers, complaints]).toEqual([[], []]);
  });
}
