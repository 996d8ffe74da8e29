/** The npm package, installed from its tarball into third-party pages, built by their bundlers, and run. */
import { execFileSync, spawnSync } from "node:child_process";
import { cp, readFile, writeFile } from "node:fs/promises";
import { delimiter, join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { build, createServer, type InlineConfig } from "vite";
import { afterAll, beforeAll, expect, test } from "vitest";
import webpack from "webpack";
import { launch } from "./browser.js";
import { snippets, visit, workplace, write, www, type Ran, type Workplace } from "./package-apps.js";
import { freePort, type Served } from "./serve.js";
import { sphere } from "./solids.js";
import { ALLOW_ALL, policyFor, serveFolder } from "./static.js";

const compiler = join(www, "node_modules/typescript/bin/tsc");

let browser: Browser;
let work: Workplace;

beforeAll(async () => {
  work = await workplace();
  await cp(join(www, "e2e/consumer"), join(work.bare), { recursive: true });
  browser = await launch();
}, 120_000);

afterAll(async () => {
  await browser.close();
  await work.close();
});

/** A page that uses both element and headless API; `module` is the URL of its script for a bundler. */
async function consumer(name: string, module: string): Promise<string> {
  const read = (file: string): Promise<string> => readFile(join(www, "e2e/consumer", file), "utf8");
  return work.app(name, { "index.html": (await read("index.html")).replace("./main.js", module), "src/main.js": await read("main.js") });
}

/** @param others server of the page's scripts, instead of the page's own origin */
async function works(folder: string, ownGlobals: (name: string) => boolean = () => false, others?: Served): Promise<void> {
  await writeFile(join(folder, "ball.stl"), sphere(10, 96).bytes);
  const policy = others === undefined ? undefined : policyFor(new URL(others.address).origin);
  const look = async ({ page, globals }: Ran): Promise<void> => {
    const headless = await page.waitForSelector("body[data-headless]", { timeout: 30_000 });
    expect(await headless.getAttribute("data-headless")).toMatch(/^3 ball.stl \d{3} (cpu|gpu) true$/);
    expect(globals.filter((name) => !ownGlobals(name))).toEqual([]);
  };
  await visit(browser, await serveFolder(folder, policy), look, others === undefined ? [] : [others.address]);
}

/** Like `works`, but only the page comes from the folder, and everything else from another origin. */
async function worksApart(folder: string, others: Served, ownGlobals?: (name: string) => boolean): Promise<void> {
  const html = await readFile(join(folder, "index.html"), "utf8");
  const page = `${folder}-page`;
  await write(page, { "index.html": html.replace("./main.js", `${others.address}main.js`) });
  await works(page, ownGlobals, others);
  await others.close();
}

/** Builds an app in a folder of the workplace with its own configuration. Not minified, to save time. */
async function vite(root: string, config: InlineConfig = {}): Promise<string> {
  await build({ logLevel: "error", ...config, root, build: { target: "es2022", minify: false, ...config.build } });
  return join(root, config.build?.outDir ?? "dist");
}

const page = (body: string): string => `<!doctype html>
<html lang="en"><head><meta charset="utf-8" /><script type="module" src="/src/main.js"></script></head>
<body><div id="root">${body}</div></body></html>`;

/** An app with the guide's component for a framework and further files. */
async function component(framework: string, use: string, files: Readonly<Record<string, string>> = {}): Promise<string> {
  const [shared, own] = [await snippets("On your page"), await snippets(framework)];
  return work.app(`${framework}-${use}`, { ...shared.files, ...own.files, ...files });
}

/** Expects the price shown by the snippets. */
async function priced(served: Served, look: (page: Page) => Promise<void> = async () => undefined): Promise<void> {
  await visit(browser, served, async ({ page }) => {
    await expect.poll(() => page.locator("output").innerText()).toMatch(/^\d+\.\d\d €$/);
    await look(page);
  });
}

const SVELTE = {
  "vite.config.js": `
import { svelte } from "@sveltejs/vite-plugin-svelte";
export default { plugins: [svelte()] };`,
  "src/main.js": `
import { mount } from "svelte";
import Slicer from "./Slicer.svelte";
mount(Slicer, { target: document.querySelector("#root") });`,
};

/** Errors of a strict compiler, which also checks libraries, in some files; empty if there are none. */
function complaintsOf(cwd: string, files: readonly string[], options: readonly string[] = []): string {
  const strict = ["--ignoreConfig", "--noEmit", "--strict", "--exactOptionalPropertyTypes", "--skipLibCheck", "false"];
  const modern = ["--target", "es2022", "--module", "esnext", "--moduleResolution", "bundler", "--lib", "es2023,dom,dom.iterable"];
  const { stdout } = spawnSync(process.execPath, [compiler, ...strict, ...modern, "--types", "", ...options, ...files], {
    cwd,
    encoding: "utf8",
  });
  return stdout;
}

test("its types hold where nothing else is installed, in the markup of each framework, and in the guide's components", async () => {
  expect(complaintsOf(work.bare, ["types.ts"])).toBe("");
  const markup = join(work.folder, "markup");
  await cp(join(www, "e2e/consumer/markup"), markup, { recursive: true });
  const [react, next] = [join(await component("React", "typed"), "src/Slicer.jsx"), join(await component("Next", "typed"), "app/page.jsx")];
  for (const [files, ...options] of [
    [["react.tsx", react, next, "vue.ts", "svelte.ts"], "--allowJs", "--checkJs", "--jsx", "react-jsx"],
    [["preact.tsx"], "--jsx", "react-jsx", "--jsxImportSource", "preact"],
    [["solid.tsx"], "--jsx", "preserve", "--jsxImportSource", "solid-js"],
  ] as const) {
    expect(complaintsOf(markup, files, options), files.join()).toBe("");
  }
});

test("built by Vite, with a base on another origin", async () => {
  const root = await consumer("vite", "/src/main.js");
  const others = await serveFolder(join(root, "dist"), "", ALLOW_ALL);
  await worksApart(await vite(root, { base: others.address }), others);
});

/** A module that counts the element's events on the page, and re-renders at each. */
const COUNT = `
export function count(render) {
  const counts = document.body.dataset;
  for (const name of ["plan", "price", "check", "change", "error"]) {
    document.addEventListener("cusp-" + name, () => {
      counts[name] = String(Number(counts[name] ?? 0) + 1);
      render();
    });
  }
}`;

/** A framework's page that re-renders the guide's component at each of the element's events. */
interface Rendering {
  framework: string;
  /** Markup of a property whose object is new at each render. */
  property(name: string, literal: string): string;
  /** Imports of the component. */
  imports?: string;
  files: Readonly<Record<string, string>>;
}

const RENDERINGS: readonly Rendering[] = [
  {
    framework: "React",
    property: (name, literal) => `${name}={${literal}}`,
    files: {
      "src/main.js": `
import { createElement } from "react";
import { createRoot } from "react-dom/client";
import { count } from "./count.js";
import Slicer from "./Slicer.jsx";
const root = createRoot(document.querySelector("#root"));
const render = () => root.render(createElement(Slicer));
count(render);
render();`,
    },
  },
  {
    framework: "Vue",
    property: (name, literal) => `:${name}="(renders, ${literal})"`,
    imports: `import { renders } from "./renders.js";`,
    files: {
      "src/renders.js": `
import { ref } from "vue";
import { count } from "./count.js";
export const renders = ref(0);
count(() => renders.value++);`,
      "src/main.js": `
import { createApp } from "vue";
import Slicer from "./Slicer.vue";
createApp(Slicer).mount("#root");`,
    },
  },
  {
    framework: "Svelte",
    property: (name, literal) => `${name}={(own.renders, ${literal})}`,
    imports: `import { own } from "./own.svelte.js";`,
    files: {
      ...SVELTE,
      "src/own.svelte.js": `
import { count } from "./count.js";
export const own = $state({ renders: 0 });
count(() => own.renders++);`,
    },
  },
  {
    framework: "Solid",
    property: (name, literal) => `prop:${name}=\${() => (renders(), ${literal})}`,
    // The guide has no component for it, and its markup needs no compiler here.
    files: {
      "src/main.js": `
import { createSignal } from "solid-js";
import html from "solid-js/html";
import { render } from "solid-js/web";
import "cusp-slicer/solid";
import { count } from "./count.js";
import { quote } from "./quote.js";
const [price, setPrice] = createSignal("");
const [renders, setRenders] = createSignal(0);
count(() => setRenders(renders() + 1));
const priced = ({ detail }) => setPrice(quote(detail.report));
render(
  () => html\`<cusp-slicer printer="saturn-3-ultra" on:cusp-plan=\${priced}></cusp-slicer><output>\${price}</output>\`,
  document.querySelector("#root"),
);`,
    },
  },
];

/** Objects that are new at each render. */
const LITERALS = {
  printer: "{ pixels: [3840, 2400], pitch_um: [50, 50], volume_mm: [192, 120, 245] }",
  resins: "[{ name: 'Grey' }]",
  prices: "{ currency: 'EUR', setup: 4 }",
  limits: "{ wall_mm: 0.5 }",
};

const renderings = RENDERINGS.map((it) => [it.framework, it] as const);

test.each(renderings)("rendered by %s at each event, on Vite's development server, which bundles packages beforehand, there is one plan", async (framework, it) => {
  const { property, imports = "", files } = it;
  const properties = Object.entries(LITERALS).map(([name, literal]) => property(name, literal)).join(" ");
  const own = Object.entries({ ...(await snippets(framework)).files, ...files }).map(([path, text]) => {
    const code = text.replace("import { quote }", `${imports}\nimport { quote }`);
    return [path, code.replace('printer="saturn-3-ultra"', () => properties)];
  });
  // Prevents the browser from requesting an icon that this server does not have.
  const index = page("").replace("</head>", `<link rel="icon" href="data:," /></head>`);
  const root = await component(framework, "development", { ...Object.fromEntries(own), "src/count.js": COUNT, "index.html": index });
  const server = await createServer({ root, logLevel: "error", server: { host: "127.0.0.1", port: await freePort() } });
  await server.listen();
  const [address = ""] = server.resolvedUrls?.local ?? [];
  await priced({ address, close: () => server.close() }, async (page) => {
    await page.waitForSelector("body[data-check]");
    // Effects of the last render have ended by then.
    await page.waitForTimeout(500);
    expect(await page.evaluate(() => Object.fromEntries(Object.entries(document.body.dataset)))).toEqual({ plan: "1", price: "1", check: "1" });
  });
});

test("built by webpack, with its scripts on the page's origin and on another", async () => {
  const context = await consumer("webpack", "./main.js");
  const path = join(context, "dist");
  const compilation = webpack({
    mode: "production",
    context,
    entry: "./src/main.js",
    output: { path, filename: "main.js", module: true },
    experiments: { outputModule: true },
    optimization: { minimize: false },
    performance: { hints: false },
  });
  const stats = await new Promise<webpack.Stats | undefined>((resolve, reject) =>
    compilation?.run((error, stats) => (error ? reject(error) : resolve(stats))),
  );
  expect(stats?.toJson({ all: false, errors: true, warnings: true })).toMatchObject({ errors: [], warnings: [] });
  await cp(join(context, "index.html"), join(path, "index.html"));
  // webpack keeps track of its own chunks in one global.
  const isOwn = (name: string): boolean => name.startsWith("webpackChunk");
  await works(path, isOwn);
  await worksApart(path, await serveFolder(path, "", ALLOW_ALL), isOwn);
});

test("built by esbuild, with the commands of the guide", async () => {
  const folder = await consumer("esbuild", "./main.js");
  await cp(join(work.bare, "node_modules"), join(folder, "node_modules"), { recursive: true });
  const { commands } = await snippets("Bundlers");
  const PATH = [join(www, "node_modules/.bin"), process.env["PATH"]].join(delimiter);
  for (const command of commands) execFileSync("sh", ["-ec", command], { cwd: folder, env: { ...process.env, PATH }, stdio: "pipe" });
  await cp(join(folder, "index.html"), join(folder, "dist/index.html"));
  await works(join(folder, "dist"));
});

test("the guide's page of plain HTML, from a plain web server", async () => {
  const folder = await component("Plain HTML", "plain");
  await cp(join(work.bare, "node_modules/cusp-slicer"), join(folder, "cusp-slicer"), { recursive: true });
  await priced(await serveFolder(folder));
});

test("the guide's component for Svelte", async () => {
  await priced(await serveFolder(await vite(await component("Svelte", "client", { ...SVELTE, "index.html": page("") }))));
});

test("imported on a server it does nothing, and calls say that there is no browser", () => {
  const { stdout, stderr } = spawnSync(process.execPath, ["server.js"], { cwd: work.bare, encoding: "utf8" });
  expect(stderr).toBe("");
  const { class: name, codes, globals } = JSON.parse(stdout) as { class: string; codes: Record<string, string>; globals: string[] };
  expect(name).toBe("ShopSlicer");
  expect(Object.keys(codes)).toEqual(expect.arrayContaining(["load", "plan", "orient", "export", "exportStream", "exportAll", "printers"]));
  expect([...new Set(Object.values(codes))]).toEqual(["no-browser"]);
  expect(globals).toEqual([]);
});

const NEXT = {
  "src/server.js": `
import { createElement } from "react";
import { renderToString } from "react-dom/server";
import Page from "../app/page.jsx";
console.log(renderToString(createElement(Page)));`,
  "src/main.js": `
import { createElement } from "react";
import { hydrateRoot } from "react-dom/client";
import Page from "../app/page.jsx";
hydrateRoot(document.querySelector("#root"), createElement(Page));`,
};

const NUXT = {
  "src/server.js": `
import { createSSRApp } from "vue";
import { renderToString } from "vue/server-renderer";
import Slicer from "./Slicer.vue";
console.log(await renderToString(createSSRApp(Slicer)));`,
  "src/main.js": `
import { createSSRApp } from "vue";
import Slicer from "./Slicer.vue";
createSSRApp(Slicer).mount("#root");`,
};

// On the server, the first imports the package from where it is installed, the second from its bundle.
test.each([
  ["Next", NEXT, []],
  ["Vue", NUXT, ["cusp-slicer"]],
])("rendered on a server as by %s, it comes to life in the browser", async (framework, files, noExternal) => {
  const folder = await component(framework, "server", files);
  const built = await vite(folder, { ssr: { noExternal }, build: { ssr: "src/server.js", outDir: "server" } });
  const { stdout, stderr } = spawnSync(process.execPath, [join(built, "server.js")], { cwd: folder, encoding: "utf8" });
  expect(stderr).toBe("");
  expect(stdout).toContain(`<cusp-slicer printer="saturn-3-ultra"></cusp-slicer>`);
  await write(folder, { "index.html": page(stdout.trim()) });
  await priced(await serveFolder(await vite(folder)));
});
