// Runs one of the tools beside it, which are written in TypeScript: `node e2e/run.mjs measure FILE.stl`.
import { fileURLToPath } from "node:url";
import { runnerImport } from "vite";

const [, , tool, ...rest] = process.argv;
const { module } = await runnerImport(fileURLToPath(new URL(`./${tool}.ts`, import.meta.url)));
await module.main(rest);
