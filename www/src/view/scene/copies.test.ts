import { Matrix4, Mesh, RawShaderMaterial, Ray, Vector3 } from "three";
import { expect, test } from "vitest";
import { Copies, matrixOf, sizeOfAll, type Copy, type Shape } from "./copies.js";
import { box, cone } from "../fixtures.js";
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

test("a ray meets the nearest copy, also a turned one; where boxes are behind one another, the surface decides", () => {
  const all = new Copies({}, new RawShaderMaterial());
  all.lift_mm = 3;
  const down = (x: number, y: number): Ray => new Ray(new Vector3(x, y, 100), new Vector3(0, 0, -1));
  const block: Shape = { ...shape, positions: box([0, 0, 0], [10, 4, 6]) };
  const copies = [copy(0, 0, 0), copy(1, 20, 0, 90)].map((it) => ({ ...it, shape: block }));
  const hit = (x: number, y: number): number | undefined => hitBy(down(x, y), copies, all)?.copy.place;
  expect(hit(4.9, 0)).toBe(0);
  expect(hit(20, 4.9)).toBe(1);
  expect(hit(24.9, 0)).toBeUndefined();
  const across = (z: number, of: readonly Copy[]): Vector3 | undefined => hitBy(new Ray(new Vector3(-50, 0, z), new Vector3(1, 0, 0)), of, all)?.point;
  expect(across(3, copies.slice(0, 1))?.x).toBeCloseTo(-5, 9);
  // Beside the tip of a cone is the block behind it; through the cone, the cone; below both, what their boxes say.
  const pointed: Shape = { ...shape, positions: cone(5, 12, 64) };
  const behind = [{ ...copy(0, 0, 0), shape: pointed }, { ...copy(1, 20, 0), shape: { ...block, scale: 3 } }];
  expect(across(6, behind)?.x).toBeCloseTo(-3.75, 1);
  const past = hitBy(new Ray(new Vector3(-50, 4, 14), new Vector3(1, 0, 0)), behind, all);
  expect([past?.copy.place, past?.point.x]).toEqual([1, expect.closeTo(5, 9)]);
  expect(across(1, behind)?.x).toBeCloseTo(-5, 1);
  all.dispose();
});
