/** The model in the scene: its facets, the stair steps once they are there, and what colours both. */
import {
  BufferAttribute,
  BufferGeometry,
  DataTexture,
  DoubleSide,
  FloatType,
  GLSL3,
  Group,
  Mesh,
  NearestFilter,
  RawShaderMaterial,
  RedFormat,
  RGBAFormat,
  Sphere,
  UnsignedByteType,
  Vector2,
  Vector3,
} from "three";
import { HEAT_PALETTE, HEAT_ROW, HEAT_ROW_FACETS, packHeat, type HeatSource } from "../paint/heat.js";
import { packBoundaries, ROW, rowsFor } from "./lookup.js";
import { PALETTE_SIZE, table, type PaletteName, type Rgb } from "../legend/palette.js";
import { extentOf, sizeOf, standing, type Extent, type Rotation, type Triple } from "./pose.js";
import { MODEL_FRAGMENT, MODEL_VERTEX } from "./shaders.js";
import type { Steps } from "../steps/steps.js";

/** `weights`: how much facets matter, once that has been given. */
export type Look = "thickness" | "printed" | "weights";

/** No layer is looked at: a band that holds no height. */
const NO_BAND: readonly [number, number] = [0, -1];

function boundariesTexture(rows: number): DataTexture {
  const texture = new DataTexture(new Float32Array(ROW * rows), ROW, rows, RedFormat, FloatType);
  texture.minFilter = texture.magFilter = NearestFilter;
  return texture;
}

function paletteTexture(name: PaletteName): DataTexture {
  const texture = new DataTexture(table(name), PALETTE_SIZE, 1, RGBAFormat, UnsignedByteType);
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

function heatTexture(rows: number): DataTexture {
  const texture = new DataTexture(new Uint8Array(HEAT_ROW_FACETS * rows), HEAT_ROW, rows, RGBAFormat, UnsignedByteType);
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

/** Bounds that three need not work out: it would go through all the points again. */
function bounded(geometry: BufferGeometry): BufferGeometry {
  geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
  return geometry;
}

export class Model {
  /** Turns about the middle of the model; what the gizmo holds. */
  readonly pivot = new Group();
  readonly facets: Mesh<BufferGeometry, RawShaderMaterial>;
  /** The stair steps, already in their pose. */
  readonly steps = new Group();
  /** Of the model as it stands, mm. */
  size_mm: Triple = [0, 0, 0];
  #positions: Float32Array = new Float32Array(0);
  #points: Float32Array = this.#positions;
  #middle = new Vector3();
  #boundaries = boundariesTexture(1);
  #palette = paletteTexture("classic");
  readonly #heatPalette = paletteTexture(HEAT_PALETTE);
  #heat = heatTexture(1);
  /** Whether the graphics card has the heat of every facet, so that changes are enough. */
  #hasHeat = false;
  /** Rows of it that have changed since. */
  readonly #stale = new Set<number>();
  #look: Look = "thickness";
  #hasSteps = false;
  #hasPlan = false;
  readonly #material: RawShaderMaterial;

  constructor() {
    this.#material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: MODEL_VERTEX,
      fragmentShader: MODEL_FRAGMENT,
      side: DoubleSide,
      uniforms: {
        boundaries: { value: this.#boundaries },
        layers: { value: 1 },
        palette: { value: this.#palette },
        limits: { value: new Vector2(0, 0) },
        byThickness: { value: false },
        heat: { value: this.#heat },
        heatPalette: { value: this.#heatPalette },
        byHeat: { value: false },
        resin: { value: new Vector3(0.75, 0.77, 0.8) },
        band: { value: new Vector2(...NO_BAND) },
      },
    });
    this.facets = new Mesh(new BufferGeometry(), this.#material);
    this.pivot.add(this.facets);
  }

  get positions(): Float32Array {
    return this.#positions;
  }

  /** What the file's lengths are multiplied by. */
  get scale(): number {
    return this.pivot.scale.x || 1;
  }

  /** @param positions nine numbers a facet, mm, in the file's pose */
  setPositions(positions: Float32Array, rotation: Rotation, scale: number): void {
    this.#positions = positions;
    this.#points = positions;
    this.facets.geometry.dispose();
    this.facets.geometry = bounded(new BufferGeometry());
    this.facets.geometry.setAttribute("position", new BufferAttribute(positions, 3));
    this.setSteps(null);
    const { least, greatest } = this.setPose(rotation, scale);
    // The middle of the bounds as it stands now is what it turns about from now on.
    this.#middle
      .set(...least)
      .add(new Vector3(...greatest))
      .divideScalar(2 * (scale || 1))
      .applyQuaternion(this.pivot.quaternion.clone().invert());
    this.facets.position.copy(this.#middle).negate();
    this.pivot.position.set(0, 0, this.size_mm[2] / 2);
  }

  /** The same points without repeats, which are quicker to go through. */
  setPoints(points: Float32Array): void {
    this.#points = points;
  }

  /** Gives the bounds before the model is put on the plate. Cost: its points. */
  setPose(rotation: Rotation, scale: number): Extent {
    const extent = extentOf(this.#points, rotation, scale);
    this.pivot.quaternion.set(...rotation);
    this.pivot.scale.setScalar(scale);
    this.pivot.position
      .copy(this.#middle)
      .multiplyScalar(scale)
      .applyQuaternion(this.pivot.quaternion)
      .add(new Vector3(...standing(extent)));
    this.size_mm = sizeOf(extent);
    return extent;
  }

  /** Colours by the layers between these boundaries; fewer than two boundaries leave the model plain. */
  setPlan(z_mm: readonly number[]): void {
    const rows = rowsFor(z_mm.length);
    if (rows !== this.#boundaries.image.height) {
      this.#boundaries.dispose();
      this.#boundaries = boundariesTexture(rows);
    }
    packBoundaries(z_mm, this.#boundaries.image.data as Float32Array);
    this.#boundaries.needsUpdate = true;
    this.#set("boundaries", this.#boundaries);
    this.#set("layers", Math.max(1, z_mm.length - 1));
    this.#hasPlan = z_mm.length >= 2;
    this.#show();
  }

  setPalette(name: PaletteName): void {
    this.#palette.dispose();
    this.#palette = paletteTexture(name);
    this.#set("palette", this.#palette);
  }

  setLimits(limits: readonly [number, number]): void {
    this.#set("limits", new Vector2(...limits));
  }

  /** Colours by how much facets matter; with `facets` that of others is as it was. */
  setHeat(source: HeatSource, facets: Iterable<number> | null): void {
    const count = this.#positions.length / 9;
    const rows = Math.max(1, Math.ceil(count / HEAT_ROW_FACETS));
    if (rows !== this.#heat.image.height) {
      this.#heat.dispose();
      this.#heat = heatTexture(rows);
      this.#set("heat", this.#heat);
      this.#hasHeat = false;
    }
    const changed = packHeat(source, facets ?? Array(count).keys(), this.#heat.image.data as Uint8Array);
    this.#heat.clearUpdateRanges();
    if (facets === null || !this.#hasHeat) {
      this.#hasHeat = false;
      this.#stale.clear();
      this.#heat.onUpdate = () => (this.#hasHeat = true);
    } else {
      for (const row of changed) this.#stale.add(row);
      for (const row of this.#stale) this.#heat.addUpdateRange(row * HEAT_ROW_FACETS, HEAT_ROW_FACETS);
      this.#heat.onUpdate = () => this.#stale.clear();
    }
    this.#heat.needsUpdate = true;
  }

  setResin(colour: Rgb): void {
    this.#set("resin", new Vector3(...colour).divideScalar(255));
  }

  /** Marks the heights between two boundaries, mm. */
  setBand(band: readonly [number, number] | null): void {
    this.#set("band", new Vector2(...(band ?? NO_BAND)));
  }

  setLook(look: Look): void {
    this.#look = look;
    this.#show();
  }

  setSteps(steps: Steps | null): void {
    this.#clearSteps();
    for (const { positions, index } of steps?.parts ?? []) {
      const geometry = bounded(new BufferGeometry());
      geometry.setAttribute("position", new BufferAttribute(positions, 3));
      geometry.setIndex(new BufferAttribute(index, 1));
      this.steps.add(new Mesh(geometry, this.#material));
    }
    this.#hasSteps = steps !== null;
    this.#show();
  }

  dispose(): void {
    this.facets.geometry.dispose();
    this.#clearSteps();
    this.#material.dispose();
    this.#boundaries.dispose();
    this.#palette.dispose();
    this.#heatPalette.dispose();
    this.#heat.dispose();
  }

  #clearSteps(): void {
    for (const part of this.steps.children) if (part instanceof Mesh) part.geometry.dispose();
    this.steps.clear();
  }

  #set(uniform: string, value: unknown): void {
    const found = this.#material.uniforms[uniform];
    if (found !== undefined) found.value = value;
  }

  /** Until the steps are there the facets stand in for them, in the same resin. */
  #show(): void {
    const asSteps = this.#look === "printed" && this.#hasSteps;
    this.steps.visible = asSteps;
    this.facets.visible = !asSteps && this.#positions.length > 0;
    this.#set("byThickness", this.#look === "thickness" && this.#hasPlan);
    this.#set("byHeat", this.#look === "weights");
  }
}
