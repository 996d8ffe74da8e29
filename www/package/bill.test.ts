import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { expect, test } from "vitest";
import { npmParts, packageOf } from "./bill.js";

const www = fileURLToPath(new URL("..", import.meta.url));

test("a tool is not bundled unnoticed", async () => {
  const bundled = [{ fileName: "index.js", moduleIds: [join(www, "node_modules/axe-core/axe.js")] }];
  await expect(npmParts(www, bundled)).rejects.toThrow("axe-core is bundled, but is a development dependency");
});

test("the package of a file is the innermost", () => {
  expect(packageOf("/a/node_modules/@lit/reactive-element/x.js")).toBe("@lit/reactive-element");
  expect(packageOf("C:\\a\\node_modules\\one\\node_modules\\two\\x.js")).toBe("two");
  expect(packageOf("/a/src/api/index.ts")).toBeUndefined();
});
