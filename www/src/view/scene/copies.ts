/** The copies on a plate except the selected one, which is drawn as the model. They share its layer colours. */
import { BufferAttribute, BufferGeometry, DoubleSide, GLSL3, Group, Matrix4, Mesh, MeshBasicMaterial, Quaternion, RawShaderMaterial, Raycaster, Sphere, Vector3, type IUniform, type Ray } from "three";
import type { Rgb } from "../legend/palette.js";
import { define } from "./model.js";
import { extentOf, sizeOf, standing, type Rotation, type Triple } from "./pose.js";
import { MODEL_FRAGMENT, MODEL_VERTEX } from "./shaders.js";

/** A model in the pose and scale of its copies. */
export interface Shape {
  /** Nine numbers per facet, mm, in the file's pose. */
  readonly positions: Float32Array;
  readonly rotation: Rotation;
  readonly scale: number;
}

/** A copy on the plate. */
export interface Copy {
  /** Identifies the copy while it is moved. */
  readonly place: number;
  /** Copies of one model share this object. */
  readonly shape: Shape;
  readonly x_mm: number;
  readonly y_mm: number;
  /** Counter-clockwise as seen from above. */
  readonly turn_deg: number;
  /** True if the copy overlaps another or extends beyond the plate. */
  readonly isColliding: boolean;
  /** Nine numbers per facet, mm, for an unrotated copy in the middle, z from the plate; shared by copies of one model. */
  readonly supports: Float32Array | null;
}

interface Posed {
  readonly geometry: BufferGeometry;
  /** Transforms the file's points to the middle of the plate. */
  readonly matrix: Matrix4;
  readonly size_mm: Triple;
}

const UP = new Vector3(0, 0, 1);

/** For rays alone. */
const BOTH_SIDES = new MeshBasicMaterial({ side: DoubleSide });

/** Turn about z and position of a copy, as a matrix. */
export function matrixOf({ x_mm, y_mm, turn_deg }: Pick<Copy, "x_mm" | "y_mm" | "turn_deg">): Matrix4 {
  return new Matrix4().makeRotationAxis(UP, (turn_deg * Math.PI) / 180).setPosition(x_mm, y_mm, 0);
}

export class Copies {
  readonly group = new Group();
  /** Bodies of the copies, which are lifted, and their supports, which are not. */
  readonly #bodies = new Group();
  readonly #supports = new Group();
  readonly #plain: RawShaderMaterial;
  readonly #colliding: RawShaderMaterial;
  readonly #ofSupports: RawShaderMaterial;
  readonly #posed = new Map<Shape, Posed>();
  readonly #supported = new Map<Float32Array, BufferGeometry>();
  #isCut = false;
  #isMarked = false;

  /**
   * @param uniforms those of the model, for the same layer and resin colours
   * @param ofSupports the material of the model's supports
   */
  constructor(uniforms: Record<string, IUniform>, ofSupports: RawShaderMaterial) {
    const material = (own: Record<string, IUniform>): RawShaderMaterial =>
      new RawShaderMaterial({
        glslVersion: GLSL3,
        vertexShader: MODEL_VERTEX,
        fragmentShader: MODEL_FRAGMENT,
        side: DoubleSide,
        uniforms: { ...uniforms, ...own },
      });
    this.#plain = material({});
    this.#colliding = material({ byThickness: { value: false }, resin: { value: new Vector3(0.8, 0.2, 0.2) } });
    this.#ofSupports = ofSupports;
    this.group.add(this.#bodies, this.#supports);
  }

  /** Lift of all models above the plate by supports, mm. */
  get lift_mm(): number {
    return this.#bodies.position.z;
  }

  set lift_mm(mm: number) {
    this.#bodies.position.z = mm;
  }

  /** True if the model's cut applies. */
  set isCut(isCut: boolean) {
    this.#isCut = isCut;
    this.#define();
  }

  /** True if the model's marks are painted. */
  set isMarked(isMarked: boolean) {
    this.#isMarked = isMarked;
    this.#define();
  }

  setBad([r, g, b]: Rgb): void {
    const resin = this.#colliding.uniforms["resin"];
    if (resin !== undefined) resin.value = new Vector3(r, g, b).divideScalar(255);
  }

  /** Material of copies with faulty placements. */
  get colliding(): RawShaderMaterial {
    return this.#colliding;
  }

  /** Shows these copies with their supports, except the one at `selected`. */
  set(copies: readonly Copy[], selected: number | null): void {
    this.#bodies.clear();
    this.#supports.clear();
    for (const copy of copies) {
      if (copy.place === selected) continue;
      const { geometry, matrix } = this.#of(copy.shape);
      const stand = matrixOf(copy);
      this.#bodies.add(fixed(new Mesh(geometry, copy.isColliding ? this.#colliding : this.#plain), stand.clone().multiply(matrix)));
      if (copy.supports !== null) this.#supports.add(fixed(new Mesh(this.#geometryOf(copy.supports), this.#ofSupports), stand));
    }
    const used = new Set<Shape | Float32Array | null>(copies.flatMap(({ shape, supports }) => [shape, supports]));
    for (const [shape, { geometry }] of this.#posed) {
      if (used.has(shape)) continue;
      geometry.dispose();
      this.#posed.delete(shape);
    }
    for (const [supports, geometry] of this.#supported) {
      if (used.has(supports)) continue;
      geometry.dispose();
      this.#supported.delete(supports);
    }
  }

  /** Size of a copy including the lift below it. */
  sizeOf(shape: Shape): Triple {
    const [x, y, z] = this.#of(shape).size_mm;
    return [x, y, z + this.lift_mm];
  }

  /** First point of a copy's surface along a ray; null if the ray misses it. Cost: linear in its facets. */
  pointOn(copy: Copy, ray: Ray): Vector3 | null {
    const { geometry, matrix } = this.#of(copy.shape);
    const lift = new Matrix4().makeTranslation(0, 0, this.lift_mm);
    const mesh = fixed(new Mesh(geometry, BOTH_SIDES), lift.multiply(matrixOf(copy)).multiply(matrix));
    mesh.updateMatrixWorld(true);
    return new Raycaster(ray.origin, ray.direction).intersectObject(mesh)[0]?.point ?? null;
  }

  dispose(): void {
    this.set([], null);
    this.#plain.dispose();
    this.#colliding.dispose();
  }

  #define(): void {
    const names = [...(this.#isCut ? ["CUT"] : []), ...(this.#isMarked ? ["MARKED"] : [])];
    for (const material of [this.#plain, this.#colliding]) define(material, names);
  }

  #of(shape: Shape): Posed {
    let posed = this.#posed.get(shape);
    if (posed !== undefined) return posed;
    const { positions, rotation, scale } = shape;
    const extent = extentOf(positions, rotation, scale);
    const geometry = geometryOf(positions);
    const matrix = new Matrix4().compose(new Vector3(...standing(extent)), new Quaternion(...rotation), new Vector3(scale, scale, scale));
    this.#posed.set(shape, (posed = { geometry, matrix, size_mm: sizeOf(extent) }));
    return posed;
  }

  #geometryOf(supports: Float32Array): BufferGeometry {
    let geometry = this.#supported.get(supports);
    if (geometry === undefined) this.#supported.set(supports, (geometry = geometryOf(supports)));
    return geometry;
  }
}

/** Geometry with infinite bounds, which saves three.js a pass over all points. */
function geometryOf(positions: Float32Array): BufferGeometry {
  const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(positions, 3));
  geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
  return geometry;
}

function fixed(mesh: Mesh, matrix: Matrix4): Mesh {
  mesh.matrixAutoUpdate = false;
  mesh.matrix.copy(matrix);
  return mesh;
}

/** Width and depth of a copy's bounding box. */
function boxOf({ shape, turn_deg }: Copy, sizeOf: (shape: Shape) => Triple): readonly [number, number] {
  const [width, depth] = sizeOf(shape);
  const [across, along] = [Math.abs(Math.cos((turn_deg * Math.PI) / 180)), Math.abs(Math.sin((turn_deg * Math.PI) / 180))];
  return [across * width + along * depth, along * width + across * depth];
}

/** Size of the smallest box around the middle of the plate that contains all copies. */
export function sizeOfAll(copies: readonly Copy[], sizeOf: (shape: Shape) => Triple): Triple {
  let [x, y, z] = [0, 0, 0];
  for (const copy of copies) {
    const [width, depth] = boxOf(copy, sizeOf);
    x = Math.max(x, 2 * Math.abs(copy.x_mm) + width);
    y = Math.max(y, 2 * Math.abs(copy.y_mm) + depth);
    z = Math.max(z, sizeOf(copy.shape)[2]);
  }
  return [x, y, z];
}
