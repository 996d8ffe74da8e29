/** Writes `pkg/facts.json`: facts of the core that forms show before a worker has started. */
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { facts, initSync } from "./pkg/cusp_slicer.js";

const pkg = new URL("pkg/", import.meta.url);
const file = new URL("facts.json", pkg);
initSync({ module: readFileSync(new URL("cusp_slicer_bg.wasm", pkg)) });
const text = JSON.stringify(facts());
// An unchanged file is left alone: a check may be reading it.
if (!existsSync(file) || readFileSync(file, "utf8") !== text) writeFileSync(file, text);
