import { expect, test } from "vitest";
import { resolve, type Source } from "./source.js";
import { stlOf } from "./stl.js";

const text = async (source: Source, signal?: AbortSignal): Promise<string> => (await resolve(source, signal)).file.text();
const bytes = async (source: Source): Promise<Uint8Array> => new Uint8Array(await (await resolve(source)).file.arrayBuffer());
const stream = (...chunks: string[]): ReadableStream<Uint8Array> =>
  new ReadableStream({
    start(controller) {
      for (const chunk of chunks) controller.enqueue(new TextEncoder().encode(chunk));
      controller.close();
    },
  });

/** Two facets of a tetrahedron. */
const VERTICES = [0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3];
const INDICES = [0, 2, 1, 3, 0, 1];
const CORNERS = Float32Array.of(0, 0, 0, 0, 2, 0, 1, 0, 0, 0, 0, 3, 0, 0, 0, 1, 0, 0);

test("files keep their name, bytes get a default one, URLs are fetched", async () => {
  const solid = new TextEncoder().encode("solid");
  expect(await resolve(new File([solid], "a.stl"))).toMatchObject({ name: "a.stl" });
  expect((await resolve(solid)).name).toBe("model.stl");
  for (const source of [new Blob([solid]), solid.buffer, solid, new DataView(solid.buffer), "data:,solid", new URL("data:,solid")]) {
    expect(await text(source)).toBe("solid");
  }
});

test("a response has the name of its address, and a stream is read to its end", async () => {
  const response = Object.defineProperty(new Response("solid"), "url", { value: "https://shop.test/my%20cup.stl?v=2" });
  expect((await resolve(response)).name).toBe("my cup.stl");
  expect(await text(new Response("solid"), new AbortController().signal)).toBe("solid");
  expect(await text(stream("so", "lid"))).toBe("solid");
  expect((await resolve(stream("solid"), new AbortController().signal)).name).toBe("model.stl");
});

test("positions are an STL of their facets, with indices too", async () => {
  const stl = stlOf(CORNERS);
  expect(await bytes(CORNERS)).toEqual(stl);
  expect(await bytes({ positions: Float32Array.from(VERTICES), indices: Uint16Array.from(INDICES) })).toEqual(stl);
  expect(await bytes({ positions: VERTICES, indices: INDICES })).toEqual(stl);
  // Later changes of the caller's array have no effect.
  const corners = CORNERS.slice();
  const resolved = bytes(corners);
  corners.fill(7);
  expect(await resolved).toEqual(stl);
});

test("what does not arrive rejects with fetch-failed, on an abort with its reason, and a stream is given up then", async () => {
  await expect(resolve("nonsense:x")).rejects.toMatchObject({ code: "fetch-failed" });
  await expect(resolve(new Response("no", { status: 404 }))).rejects.toMatchObject({ code: "fetch-failed", detail: { status: 404 } });
  await expect(resolve(new ReadableStream({ start: (it) => it.error(new Error("gone")) }))).rejects.toMatchObject({ code: "fetch-failed", detail: { system: "gone" } });
  const read = stream("solid");
  read.getReader();
  await expect(resolve(read)).rejects.toMatchObject({ code: "fetch-failed" });
  await expect(resolve("data:,x", AbortSignal.abort())).rejects.toMatchObject({ name: "AbortError" });
  let given: unknown;
  const endless = new ReadableStream<Uint8Array>({ cancel: (reason) => void (given = reason) });
  const abort = new AbortController();
  const outcome = expect(resolve(endless, abort.signal)).rejects.toBe("enough");
  abort.abort("enough");
  await outcome;
  expect(given).toBe("enough");
});

test.each([
  [5, "Number"],
  [null, "Null"],
  [undefined, "Undefined"],
  [{}, "Object"],
  [[0, 0, 0], "Array"],
  [Promise.resolve("a.stl"), "Promise"],
  [new Float64Array(9), "Float64Array"],
  [new Uint8Array(new SharedArrayBuffer(9)), "SharedArrayBuffer"],
  [{ positions: VERTICES }, "Object"],
])("%o is no source, and named", async (source, given) => {
  await expect(resolve(source as Source)).rejects.toMatchObject({ code: "bad-source", detail: { given } });
});

test("lists of no whole number of facets are refused, and so are indices of no vertex", async () => {
  const uneven = { code: "bad-facets", detail: { list: "positions", numbers: 10, multiple_of: 9 } };
  await expect(resolve(new Float32Array(10))).rejects.toMatchObject(uneven);
  const of = (positions: number[], indices: number[]): Promise<unknown> => resolve({ positions, indices });
  await expect(of([0, 0], [])).rejects.toMatchObject({ code: "bad-facets", detail: { list: "positions", numbers: 2, multiple_of: 3 } });
  await expect(of(VERTICES, [0, 1])).rejects.toMatchObject({ code: "bad-facets", detail: { list: "indices", numbers: 2, multiple_of: 3 } });
  for (const index of [4, -1, 1.5, NaN]) {
    await expect(of(VERTICES, [0, 1, index])).rejects.toMatchObject({ code: "bad-index", detail: { place: 2, index, vertices: 4 } });
  }
});
