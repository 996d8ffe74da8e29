import { defineConfig } from "vitest/config";

export default defineConfig({
  test: {
    projects: [
      { test: { name: "unit", include: ["src/**/*.test.ts"], setupFiles: ["src/texts/all.ts"], environment: "node" } },
      {
        test: {
          name: "e2e",
          include: ["e2e/**/*.test.ts"],
          environment: "node",
          globalSetup: "e2e/serve.ts",
          // Two browsers at a time: one leaves a quarter of two cores idle, since each test waits for the page and the page for it.
          maxWorkers: 2,
          // Two cores are shared with browsers that draw in software: now and then one misses a moment that it is to be seen in.
          retry: 2,
          expect: { poll: { timeout: 20_000 } },
          testTimeout: 60_000,
          hookTimeout: 60_000,
        },
      },
    ],
  },
});
