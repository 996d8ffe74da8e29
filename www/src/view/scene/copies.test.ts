import { Matrix4, Mesh, RawShaderMaterial, Ray, Vector3 } from "three";
import { expect, test } from "vitest";
import { Copies, matrixOf, sizeOfAll, type Copy, type Shape } from "./copies.js";
import { hitBy } from "./moving.js";
import type { Triple } from "./pose.js";

const shape: Shape = { positions: new Float32Array(0), rotation: [0, 0, 0, 1], scale: 1 };
const size: Triple = [10, 4, 6];
const sizeOf = (): Triple => size;

const copy = (place: number, x_mm: number, y_mm: number, turn_deg = 0): Copy => ({ place, shape, x_mm, y_mm, turn_deg, isColliding: false, supports: null });

test("a copy is turned counter-clockwise about its own middle, then moved", () => {
  const corner = new Vector3(5, 2, 0).applyMatrix4(matrixOf(copy(0, 100, 50, 90)));
  expect(corner.toArray().map((mm) => Math.round(1e6 * mm) / 1e6)).toEqual([98, 55, 0]);
});

test("the box of all copies is about the middle of the plate", () => {
  expect(sizeOfAll([copy(0, -20, 3)], sizeOf)).toEqual([50, 10, 6]);
  const [x, y] = sizeOfAll([copy(0, -20, 3, 90)], sizeOf);
  expect([x, y].map(Math.round)).toEqual([44, 16]);
});

test("copies are lifted with the model, and are as high with what is below them", () => {
  const copies = new Copies({}, new RawShaderMaterial());
  copies.lift_mm = 5;
  const facet: Shape = { ...shape, positions: Float32Array.of(0, 0, 2, 10, 0, 2, 0, 4, 8) };
  copies.set([copy(0, 0, 0), { ...copy(1, 20, 0), shape: facet }], 0);
  copies.group.updateMatrixWorld();
  const [other] = meshesOf(copies);
  expect(new Vector3(10, 0, 2).applyMatrix4(other?.matrixWorld ?? new Matrix4()).toArray()).toEqual([25, -2, 5]);
  expect(copies.sizeOf(facet)).toEqual([10, 4, 11]);
  copies.dispose();
});

/** Meshes drawn. */
function meshesOf({ group }: Copies): Mesh[] {
  const meshes: Mesh[] = [];
  group.traverse((it) => it instanceof Mesh && meshes.push(it));
  return meshes;
}

test("copies are moved and turned with their supports, which have their heights already and share facets; they are let go with the last copy", () => {
  const material = new RawShaderMaterial();
  const copies = new Copies({}, material);
  copies.lift_mm = 5;
  const supports = Float32Array.of(0, 0, 0, 4, 0, 0, 0, 0, 5);
  const other = Float32Array.of(0, 0, 0, 1, 0, 0, 0, 0, 5);
  const all = [{ ...copy(0, 0, 0), supports }, { ...copy(1, 20, 0, 90), supports }, { ...copy(2, -20, 0), supports: other }, { ...copy(3, 0, 9), supports }];
  copies.set(all, 0);
  copies.group.updateMatrixWorld();
  const supported = meshesOf(copies).filter((mesh) => mesh.material === material);
  const points = supported.map((mesh) => new Vector3(4, 0, 5).applyMatrix4(mesh.matrixWorld).toArray().map(Math.round));
  // Without the selected copy, which is drawn as the model.
  expect(points).toEqual([[20, 4, 5], [-16, 0, 5], [4, 9, 5]]);
  expect(supported[0]?.geometry).toBe(supported[2]?.geometry);
  const gone: string[] = [];
  supported[0]?.geometry.addEventListener("dispose", () => gone.push("shared"));
  supported[1]?.geometry.addEventListener("dispose", () => gone.push("other"));
  copies.set(all.slice(0, 2), 0);
  expect(gone).toEqual(["other"]);
  copies.dispose();
  expect(gone).toEqual(["other", "shared"]);
});

test("a ray meets the nearest copy, also a turned one", () => {
  const down = (x: number, y: number): Ray => new Ray(new Vector3(x, y, 100), new Vector3(0, 0, -1));
  const copies = [copy(0, 0, 0), copy(1, 20, 0, 90)];
  const hit = (x: number, y: number): number | undefined => hitBy(down(x, y), copies, sizeOf)?.copy.place;
  expect(hit(4.9, 0)).toBe(0);
  expect(hit(20, 4.9)).toBe(1);
  expect(hit(24.9, 0)).toBeUndefined();
  expect(hitBy(new Ray(new Vector3(-50, 0, 3), new Vector3(1, 0, 0)), copies, sizeOf)?.point.x).toBeCloseTo(-5, 9);
});
