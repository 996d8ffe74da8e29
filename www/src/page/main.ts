/** The page around the element: its header, opening files anywhere, the example, the address, working offline. */
import "../element/register.js";
import { render } from "lit";
import type { CuspSlicer } from "../element/index.js";
import { languageOf } from "../texts/index.js";
import { ADDRESS_KEYS, addressOf, settingsOf } from "./address.js";
import { binaryStl, exampleTriangles, EXAMPLE_NAME } from "./example.js";
import { frame } from "./frame.js";
import { openAnywhere } from "./open-anywhere.js";
import { workOffline } from "./offline.js";

function found<E extends Element>(selector: string): E {
  const element = document.querySelector<E>(selector);
  if (element === null) throw new Error(`the page has no ${selector}`);
  return element;
}

const place = found<HTMLElement>("#page");
const asked = new URLSearchParams(location.search);
const own = new URLSearchParams([...asked].filter(([key]) => ADDRESS_KEYS.includes(key)));

function draw(): void {
  const language = languageOf(...[own.get("locale"), ...navigator.languages].filter((locale) => locale !== null));
  document.documentElement.lang = language.locale;
  document.title = language.texts.page.title;
  render(frame(language, { example, speak }), place);
}

function speak(locale: string): void {
  own.set("locale", locale);
  draw();
  keep();
}

function example(): void {
  slicer.willOrphan();
  slicer.load(new Blob([binaryStl(exampleTriangles())]), EXAMPLE_NAME).catch(() => undefined);
}

/** Keeps settings in the address, so that a link shows the same plan. */
function keep(): void {
  history.replaceState(null, "", addressOf(slicer.query, own) || location.pathname);
}

draw();
const slicer = found<CuspSlicer>("cusp-slicer");
slicer.query = settingsOf(asked);
const backend = own.get("backend");
if (backend === "cpu" || backend === "gpu") slicer.backend = backend;
const method = own.get("gpu-method");
if (method === "fill" || method === "peel") slicer.gpuMethod = method;
slicer.addEventListener("cusp-change", keep);
openAnywhere(slicer, (isDragging) => place.classList.toggle("dragging", isDragging));
workOffline();
