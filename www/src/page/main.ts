/** The page around the element: header, opening of files anywhere, the example, the URL, and offline use. */
import "../workbench/register.js";
import { render } from "lit";
import { fetchLanguage, fetchRest, languageOf } from "../texts/index.js";
import { ADDRESS_KEYS, addressOf, settingsOf } from "./address.js";
import { frame } from "./frame.js";
import { idle } from "../api/calls.js";
import type { Printer } from "../api/wire.js";
import { fetchView } from "../element/panels/model-view.js";
import { isNamedAsModel } from "../element/state/choice.js";
import type { Snapshot } from "../element/state/snapshot.js";
import { isModel } from "./is-model.js";
import { askBeforeLeaving } from "./leaving.js";
import type { Notice } from "./notice.js";
import { openAnywhere } from "./open-anywhere.js";
import type { CuspWorkbench } from "../workbench/cusp-workbench.js";
import { pageWords } from "./texts.js";
import { Visit } from "./visit.js";

function found<E extends Element>(selector: string): E {
  const element = document.querySelector<E>(selector);
  if (element === null) throw new Error(`the page has no ${selector}`);
  return element;
}

const place = found<HTMLElement>("#page");
const asked = new URLSearchParams(location.search);
const own = new URLSearchParams([...asked].filter(([key]) => ADDRESS_KEYS.includes(key)));

/** Print file shown, and the files opened with it. */
let shown: readonly File[] | null = null;
let notice: Notice | null = null;

const locales = (): string[] => [own.get("locale"), ...navigator.languages].filter((locale) => locale !== null);

function draw(): void {
  const language = languageOf(...locales());
  document.documentElement.lang = language.locale;
  document.title = pageWords(language).title;
  const files = shown;
  const [file] = files ?? [];
  const print = files === null || file === undefined ? null : { file, printers: slicer.knownPrinters(), use, close, unknown: () => load(files), missing: () => unread(files) };
  document.body.classList.toggle("reading", print !== null);
  const actions = { example: () => void example(), speak: (locale: string) => void speak(locale), open: (files: readonly File[]) => void open(files), saveProject: () => void slicer.saveProject(), dismiss: () => say(null) };
  render(frame(language, actions, { print, notice }, visit), place);
}

/** Shows a notice, whose words are fetched with the first one. */
function say(said: Notice | null): void {
  notice = said;
  void fetchRest().then(draw);
}

/**
 * Shows a print file, or adds models to the open ones, which they may replace. Files whose content is not a model go first to the reader,
 * which alone knows print files.
 */
async function open(files: readonly File[], isReplacing = false): Promise<void> {
  const [first] = files;
  if (first === undefined) return;
  notice = null;
  // The slicer reports a file that cannot be read.
  if (await isModel(first).catch(() => true)) return load(files, isReplacing);
  try {
    const [{ definePrint }] = await Promise.all([import("../print/cusp-print.js"), fetchRest()]);
    definePrint();
  } catch {
    return unread(files);
  }
  shown = files;
  draw();
}

/** Without the reader, only files named as models are opened: they may be damaged models. The slicer would report a print file as one. */
function unread(files: readonly File[]): void {
  const [{ name } = { name: "" }] = files;
  if (isNamedAsModel(name)) return load(files);
  close();
  say({ says: "reader", name });
}

function load(files: readonly File[], isReplacing = false): void {
  close();
  slicer.willOrphan();
  // The element shows any error.
  (isReplacing ? slicer.load(files) : slicer.take(files)).catch(() => undefined);
}

async function reopen(snapshot: Snapshot): Promise<boolean> {
  close();
  slicer.willOrphan();
  return (await slicer.reopen(snapshot)) !== null;
}

/** Chooses the printer of a print file for what is sliced from now on. */
function use(printer: string | Printer): void {
  slicer.printer = printer;
  close();
}

function close(): void {
  shown = null;
  draw();
}

async function speak(locale: string): Promise<void> {
  own.set("locale", locale);
  if ((await fetchLanguage(...locales())) === false) say({ says: "part" });
  draw();
  keep();
}

async function example(): Promise<void> {
  const code = await import("./example.js").catch(() => null);
  if (code === null) return say({ says: "part" });
  const { binaryStl, exampleTriangles, EXAMPLE_NAME } = code;
  close();
  slicer.willOrphan();
  slicer.load(new Blob([binaryStl(exampleTriangles())]), EXAMPLE_NAME).catch(() => undefined);
}

/** Keeps the settings in the URL, so that a link shows the same plan. */
function keep(): void {
  history.replaceState(null, "", addressOf(slicer.query, own) || location.pathname);
}

/** The first match of these selectors in the workbench. */
const within = (selectors: string) => (): HTMLElement | null => slicer.renderRoot.querySelector<HTMLElement>(selectors);

const visit = new Visit({
  element: () => slicer,
  link: () => new URL(addressOf(slicer.query, own) || location.pathname, location.href).href,
  open: (files) => void open(files),
  reopen,
  draw,
  say,
  targets: [within(".view"), within(".path"), within(".plan .download, .bar-result")],
  clearance: () => within(".bar")()?.offsetHeight ?? 0,
});

let slicer: CuspWorkbench;

/** A function, because a top-level await would split the page into many small files that wait for one another. */
async function start(): Promise<void> {
  await fetchLanguage(...locales());
  draw();
  slicer = found("cusp-workbench");
  visit.start(settingsOf(asked));
  const backend = own.get("backend");
  if (backend === "cpu" || backend === "gpu") slicer.backend = backend;
  const method = own.get("gpu-method");
  if (method === "fill" || method === "peel") slicer.gpuMethod = method;
  slicer.addEventListener("cusp-change", keep);
  askBeforeLeaving(slicer, settingsOf(asked), () => visit.isKept);
  openAnywhere({
    dragging: (isDragging) => place.classList.toggle("dragging", isDragging),
    open: (files, isReplacing) => void open(files, isReplacing),
    refuse(error, name) {
      close();
      slicer.refuse(error, name);
    },
    cancel: () => (shown === null ? slicer.cancel() : close()),
    undo: () => shown === null && slicer.undo(),
    redo: () => shown === null && slicer.redo(),
  });
  workOffline();
  fetchAhead();
}

/** Fetches the figure of the empty page, and the view before it is needed, when the page is idle, unless the user saves data. */
function fetchAhead(): void {
  if ((navigator as { connection?: { saveData?: boolean } }).connection?.saveData === true) return;
  idle().then(() => Promise.all([fetchView(), import("./figure.js")])).catch(() => undefined);
}

void start();

/** Makes the page work offline once loaded: see service-worker.ts. Does not apply to the element in other pages. */
function workOffline(): void {
  if (!import.meta.env.PROD || !("serviceWorker" in navigator)) return;
  // If the browser refuses, as in a private window, the page still works online.
  navigator.serviceWorker.register(new URL("./service-worker.js", document.baseURI)).catch(() => undefined);
}
