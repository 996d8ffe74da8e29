import { defineConfig } from "vitest/config";

/** Tests in real browsers. */
const browsers = {
  environment: "node",
  globalSetup: "e2e/serve.ts",
  // Two browsers at a time: one leaves a quarter of two cores idle, since test and page wait for each other.
  maxWorkers: 2,
  // Two cores are shared with browsers that draw in software, so a brief state may be missed occasionally.
  retry: 2,
  expect: { poll: { timeout: 20_000 } },
  testTimeout: 60_000,
  hookTimeout: 60_000,
} as const;

export default defineConfig({
  test: {
    // All cores; by default vitest leaves one free.
    maxWorkers: "100%",
    projects: [
      { test: { name: "unit", include: ["{src,package,examples}/**/*.test.ts"], setupFiles: ["src/texts/all.ts"], environment: "node", testTimeout: 60_000 } },
      // One browser serves all files of a worker: a tab that has compiled the page opens it in half the time.
      { test: { ...browsers, name: "e2e", include: ["e2e/*.test.ts"], isolate: false } },
      { test: { ...browsers, name: "engines", include: ["e2e/engines/*.test.ts"] } },
    ],
  },
});
