/** Writes `pkg/facts.json`: facts of the core that forms show before a worker has started. */
import { readFileSync, writeFileSync } from "node:fs";
import { facts, initSync } from "./pkg/cusp_slicer.js";

const pkg = new URL("pkg/", import.meta.url);
initSync({ module: readFileSync(new URL("cusp_slicer_bg.wasm", pkg)) });
writeFileSync(new URL("facts.json", pkg), JSON.stringify(facts()));
