/** Firefox through WebDriver BiDi, which it supports natively. */
import { mkdir, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { join } from "node:path";
import { BrowsingContext } from "selenium-webdriver/bidi/generated/browsing_context.js";
import { Input } from "selenium-webdriver/bidi/generated/input.js";
import { Log } from "selenium-webdriver/bidi/generated/log.js";
import { Script, type ScriptRemoteValue } from "selenium-webdriver/bidi/generated/script.js";
import { Session as Sessions } from "selenium-webdriver/bidi/generated/session.js";
import type { Index } from "selenium-webdriver/bidi/index.js";
import { program } from "../program.js";
import { said, xvfb } from "./programs.js";
import { awaited, sourceOf, type Engine } from "./session.js";

/** The module exports this class itself, unlike its types. */
const Connection = createRequire(import.meta.url)("selenium-webdriver/bidi/index.js") as typeof Index;

const firefox = (): string | null => program(["firefox-esr", "firefox"], "FIREFOX");

const preferences = (proxy: number, downloads: string) => ({
  "network.proxy.type": 1,
  "network.proxy.http": "127.0.0.1",
  "network.proxy.http_port": proxy,
  "network.proxy.ssl": "127.0.0.1",
  "network.proxy.ssl_port": proxy,
  "network.proxy.no_proxies_on": "127.0.0.1",
  // The protocol's own command is not in older long-term releases.
  "browser.download.folderList": 2,
  "browser.download.dir": downloads,
  // A minute after its start Firefox would look for decoders of protected video.
  "media.gmp-manager.updateEnabled": false,
  // Also in software.
  "webgl.force-enabled": true,
  "intl.accept_languages": "en-GB",
});

export const FIREFOX: Engine = {
  name: "Firefox",

  lacks() {
    if (firefox() === null) return "no Firefox on PATH, and none named by FIREFOX";
    return xvfb() === null ? "no Xvfb on PATH" : null;
  },

  // Requests for settings, blocked add-ons and the network state.
  asks: (host) => /(^|\.)(mozilla\.(com|net|org)|firefox\.com)$/.test(host),

  async start(folder, programs, proxy) {
    const [profile, downloads] = [join(folder, "profile"), join(folder, "downloads")];
    for (const it of [profile, downloads]) await mkdir(it);
    const lines = Object.entries(preferences(proxy, downloads)).map(([name, value]) => `user_pref("${name}", ${JSON.stringify(value)});\n`);
    await writeFile(join(profile, "user.js"), lines.join(""));
    const env = { HOME: folder, DISPLAY: await programs.screen(), WAYLAND_DISPLAY: undefined };
    const child = programs.start(firefox() ?? "firefox", ["--remote-debugging-port=0", "--profile", profile], env);
    const address = `${await said(child, child.stderr, /WebDriver BiDi listening on (\S+)/)}/session`;
    const connection = new Connection(address);
    // The protocol classes obtain their connection from a driver.
    const driver = { getCapabilities: () => new Map([["webSocketUrl", address]]), getBidi: () => connection };
    await (await Sessions.create(driver)).new({ capabilities: {} });
    const complaints: string[] = [];
    await (await Log.create(driver)).onEntryAdded(({ level, text }) => {
      if (level === "error") complaints.push(text ?? "");
    });
    const tabs = await BrowsingContext.create(driver);
    const { context } = await tabs.create({ type: "tab" });
    await tabs.setViewport({ context, viewport: { width: 1280, height: 900 } });
    const script = await Script.create(driver);
    const input = await Input.create(driver);
    const call = async (functionDeclaration: string, ...args: string[]): Promise<ScriptRemoteValue> => {
      const answer = await script.callFunction({
        functionDeclaration,
        arguments: args.map((value) => ({ type: "string", value })),
        awaitPromise: true,
        target: { context },
      });
      if (answer.type === "exception") throw new Error(answer.exceptionDetails.text);
      return answer.result;
    };
    return {
      downloads,
      complaints: async () => complaints.splice(0),
      open: async (url) => void (await tabs.navigate({ context, url, wait: "complete" })),
      async call(body, ...args) {
        const result = await call(sourceOf(body), JSON.stringify(args));
        if (result.type !== "string") throw new Error(`a ${result.type} in place of JSON`);
        return JSON.parse(result.value)[0];
      },
      act: (source) => input.performActions({ context, actions: [source] }),
      async give(find, file) {
        const found = await call(awaited(find));
        if (found.type !== "node" || found.sharedId === undefined) throw new Error("there is no such input");
        await input.setFiles({ context, element: { sharedId: found.sharedId }, files: [file] });
      },
    };
  },
};
