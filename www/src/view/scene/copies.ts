/** The copies on a plate besides the selected one, whose facets the model has. They share its colours of layers. */
import { BufferAttribute, BufferGeometry, DoubleSide, GLSL3, Group, Matrix4, Mesh, Quaternion, RawShaderMaterial, Sphere, Vector3, type IUniform } from "three";
import type { Rgb } from "../legend/palette.js";
import { extentOf, sizeOf, standing, type Rotation, type Triple } from "./pose.js";
import { MODEL_FRAGMENT, MODEL_VERTEX } from "./shaders.js";

/** A model as its copies stand: turned and scaled. */
export interface Shape {
  /** Nine numbers a facet, mm, in the file's pose. */
  readonly positions: Float32Array;
  readonly rotation: Rotation;
  readonly scale: number;
}

/** A copy on the plate. */
export interface Copy {
  /** Tells it from the others while it is moved. */
  readonly place: number;
  /** Copies of one model share this object. */
  readonly shape: Shape;
  readonly x_mm: number;
  readonly y_mm: number;
  /** Counter-clockwise as seen from above. */
  readonly turn_deg: number;
  /** Whether it overlaps another, or extends beyond the plate. */
  readonly isCrowded: boolean;
}

interface Posed {
  readonly geometry: BufferGeometry;
  /** Puts the file's points on the middle of the plate. */
  readonly matrix: Matrix4;
  readonly size_mm: Triple;
}

const UP = new Vector3(0, 0, 1);

/** The turn about z and the place of a copy. */
export function matrixOf({ x_mm, y_mm, turn_deg }: Pick<Copy, "x_mm" | "y_mm" | "turn_deg">): Matrix4 {
  return new Matrix4().makeRotationAxis(UP, (turn_deg * Math.PI) / 180).setPosition(x_mm, y_mm, 0);
}

export class Copies {
  readonly group = new Group();
  readonly #plain: RawShaderMaterial;
  readonly #crowded: RawShaderMaterial;
  readonly #posed = new Map<Shape, Posed>();

  /** @param uniforms of the model, whose colours the copies share as long as they show layers or resin */
  constructor(uniforms: Record<string, IUniform>) {
    const material = (own: Record<string, IUniform>): RawShaderMaterial =>
      new RawShaderMaterial({
        glslVersion: GLSL3,
        vertexShader: MODEL_VERTEX,
        fragmentShader: MODEL_FRAGMENT,
        side: DoubleSide,
        uniforms: { ...uniforms, byHeat: { value: false }, byDistance: { value: false }, ...own },
      });
    this.#plain = material({});
    this.#crowded = material({ byThickness: { value: false }, resin: { value: new Vector3(0.8, 0.2, 0.2) } });
  }

  /** How far supports lift all models above the plate, mm. */
  get lift_mm(): number {
    return this.group.position.z;
  }

  set lift_mm(mm: number) {
    this.group.position.z = mm;
  }

  setBad([r, g, b]: Rgb): void {
    const resin = this.#crowded.uniforms["resin"];
    if (resin !== undefined) resin.value = new Vector3(r, g, b).divideScalar(255);
  }

  /** The material of a copy that is where it cannot stay. */
  get crowded(): RawShaderMaterial {
    return this.#crowded;
  }

  /** Shows these copies, except the one at `selected`. */
  set(copies: readonly Copy[], selected: number | null): void {
    this.group.clear();
    for (const copy of copies) {
      if (copy.place === selected) continue;
      const { geometry, matrix } = this.#of(copy.shape);
      const mesh = new Mesh(geometry, copy.isCrowded ? this.#crowded : this.#plain);
      mesh.matrixAutoUpdate = false;
      mesh.matrix.copy(matrixOf(copy)).multiply(matrix);
      this.group.add(mesh);
    }
    const used = new Set(copies.map(({ shape }) => shape));
    for (const [shape, { geometry }] of this.#posed) {
      if (used.has(shape)) continue;
      geometry.dispose();
      this.#posed.delete(shape);
    }
  }

  /** Size of a copy with what is below it. */
  sizeOf(shape: Shape): Triple {
    const [x, y, z] = this.#of(shape).size_mm;
    return [x, y, z + this.lift_mm];
  }

  dispose(): void {
    this.set([], null);
    this.#plain.dispose();
    this.#crowded.dispose();
  }

  #of(shape: Shape): Posed {
    let posed = this.#posed.get(shape);
    if (posed !== undefined) return posed;
    const { positions, rotation, scale } = shape;
    const extent = extentOf(positions, rotation, scale);
    const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(positions, 3));
    geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
    const matrix = new Matrix4().compose(new Vector3(...standing(extent)), new Quaternion(...rotation), new Vector3(scale, scale, scale));
    this.#posed.set(shape, (posed = { geometry, matrix, size_mm: sizeOf(extent) }));
    return posed;
  }
}

/** Width and depth of a copy's box. */
function boxOf({ shape, turn_deg }: Copy, sizeOf: (shape: Shape) => Triple): readonly [number, number] {
  const [width, depth] = sizeOf(shape);
  const [across, along] = [Math.abs(Math.cos((turn_deg * Math.PI) / 180)), Math.abs(Math.sin((turn_deg * Math.PI) / 180))];
  return [across * width + along * depth, along * width + across * depth];
}

/** The smallest box about the middle of the plate that holds all copies. */
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
