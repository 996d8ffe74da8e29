/** WebKitGTK through classic WebDriver, in the mini browser that comes with the library. */
import { mkdir, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { setTimeout as wait } from "node:timers/promises";
import { Builder, Capabilities, type WebElement } from "selenium-webdriver";
import { Command, Name } from "selenium-webdriver/lib/command.js";
import { program } from "../program.js";
import { freePort } from "../serve.js";
import { xvfb } from "./programs.js";
import { awaited, sourceOf, type Engine } from "./session.js";

declare global {
  interface Window {
    complaints?: string[];
  }
}

const driver = (): string | null => program(["WebKitWebDriver"], "WEBKIT_DRIVER");

export const WEBKIT: Engine = {
  name: "WebKitGTK",

  lacks() {
    if (driver() === null) return "no WebKitWebDriver on PATH, and none named by WEBKIT_DRIVER";
    return xvfb() === null ? "no Xvfb on PATH" : null;
  },

  asks: () => false,

  async start(folder, programs, proxy) {
    const [config, downloads] = [join(folder, ".config"), join(folder, "downloads")];
    for (const it of [config, downloads]) await mkdir(it);
    await writeFile(join(config, "user-dirs.dirs"), `XDG_DOWNLOAD_DIR="${downloads}"\n`);
    const env = {
      HOME: folder,
      XDG_CONFIG_HOME: config,
      DISPLAY: await programs.screen(),
      WAYLAND_DISPLAY: undefined,
      // The browser's language is then "C", which is not a valid language tag.
      LANG: "C",
      LC_ALL: undefined,
    };
    const port = await freePort();
    const child = programs.start(driver() ?? "WebKitWebDriver", ["--host=127.0.0.1", `--port=${port}`], env);
    const address = `http://127.0.0.1:${port}`;
    while (!(await fetch(`${address}/status`).then(({ ok }) => ok, () => false))) {
      if (child.exitCode !== null) throw new Error(`WebKitWebDriver ended with ${child.exitCode}`);
      await wait(50);
    }
    const outside = `127.0.0.1:${proxy}`;
    const capabilities = new Capabilities({
      browserName: "MiniBrowser",
      proxy: { proxyType: "manual", httpProxy: outside, sslProxy: outside, noProxy: ["127.0.0.1"] },
    });
    const tab = await new Builder().usingServer(address).withCapabilities(capabilities).build();
    await tab.manage().window().setRect({ x: 0, y: 0, width: 1280, height: 940 });
    const complaints: string[] = [];
    const collect = async (): Promise<void> => {
      const heard = await tab.executeScript<string[] | null>("return window.complaints?.splice(0)");
      complaints.push(...(heard ?? []));
    };
    return {
      downloads,
      async complaints() {
        await collect();
        return complaints.splice(0);
      },
      async open(url) {
        await collect();
        await tab.get(url);
        // WebKit's driver does not report errors, so the page records its own from here on.
        await tab.executeScript(`(${String(listen)})()`);
      },
      async call(body, ...args) {
        const result = await tab.executeScript<string>(`return (${sourceOf(body)})(arguments[0])`, JSON.stringify(args));
        return JSON.parse(result)[0];
      },
      act: (source) => tab.execute(new Command(Name.ACTIONS).setParameter("actions", [source])),
      async give(find, file) {
        const input = await tab.executeScript<WebElement | null>(`return (${awaited(find)})()`);
        if (input === null) throw new Error("there is no such input");
        await input.sendKeys(file);
      },
    };
  },
};

/** Runs in the page. */
function listen(): void {
  const heard: string[] = [];
  window.complaints = heard;
  addEventListener("error", ({ message }) => heard.push(message));
  addEventListener("unhandledrejection", ({ reason }) => heard.push(String(reason)));
  addEventListener("securitypolicyviolation", ({ blockedURI }) => heard.push(`refused: ${blockedURI}`));
  const { error } = console;
  console.error = (...words) => {
    heard.push(words.map(String).join(" "));
    error(...words);
  };
}
