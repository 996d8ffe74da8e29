import { expect, test } from "vitest";
import { acceptCompatible } from "./adapters.js";

/** Mock GPU whose adapters have the given feature levels. */
function fake(...levels: string[]): { asked: unknown[]; gpu: Parameters<typeof acceptCompatible>[0] } {
  const asked: unknown[] = [];
  const requestAdapter = async (options: { featureLevel?: string } = {}): Promise<GPUAdapter | null> => {
    asked.push(options);
    const level = options.featureLevel ?? "core";
    return levels.includes(level) ? ({ label: level } as unknown as GPUAdapter) : null;
  };
  return { asked, gpu: { requestAdapter } };
}

test.each([
  ["core", ["core", "compatibility"], [{ powerPreference: "low-power" }]],
  ["compatibility", ["compatibility"], [{ powerPreference: "low-power" }, { powerPreference: "low-power", featureLevel: "compatibility" }]],
])("an adapter of level %s is the best of %s", async (best, levels, expected) => {
  const { asked, gpu } = fake(...levels);
  acceptCompatible(gpu);
  expect(await gpu.requestAdapter({ powerPreference: "low-power" })).toMatchObject({ label: best });
  expect(asked).toEqual(expected);
});

test("without adapters there is none", async () => {
  const { gpu } = fake();
  acceptCompatible(gpu);
  expect(await gpu.requestAdapter()).toBeNull();
});
