import { expect, test } from "vitest";
import { binaryStl } from "./example.js";
import { isModel } from "./is-model.js";

const text = (words: string): Blob => new Blob([words]);
/** A zip lists its files at its end. */
const zip = (name: string): Blob => new Blob(["PK\u0003\u0004\0\0", "data ".repeat(50_000), "PK\u0001\u0002\0", name, "PK\u0005\u0006\0"]);

test.each([
  ["a binary STL", new Blob([binaryStl(new Float32Array(90))]), true],
  ["a text STL", text("solid part\n"), true],
  ["an OBJ", text("# by hand\nv 0 0 0\n"), true],
  ["a 3MF", zip("3D/3dmodel.model"), true],
  ["a zip of masks", zip("manifest.json"), false],
  ["a page about a model", text("<!doctype html>"), true],
  ["a print file", new Blob([Uint8Array.of(0x19, 0, 0xfd, 0x12, ...new Uint8Array(200))]), false],
  ["nothing", text(""), true],
])("%s", async (_, file, is) => {
  expect(await isModel(file)).toBe(is);
});
