/** The model in the scene: its facets, the stair steps once they are computed, and the material of both. */
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
  type IUniform,
} from "three";
import { HEAT_ROW, HEAT_ROW_FACETS, packHeat, type HeatSource } from "../paint/heat.js";
import { packBoundaries, ROW, rowsFor } from "./lookup.js";
import { PALETTE_SIZE, TABLE, type Rgb } from "../legend/palette.js";
import { extentOf, sizeOf, standing, type Extent, type Rotation, type Triple } from "./pose.js";
import { MODEL_FRAGMENT, MODEL_VERTEX, MOST_MARKS, PICK_FRAGMENT, PICK_VERTEX } from "./shaders.js";
import { isMeasured } from "../steps/distances.js";
import type { Steps } from "../steps/steps.js";
import { WallColours } from "../walls/colours.js";
import type { Walls } from "../walls/thickness.js";

/**
 * `printed`: the stair steps in plain resin; `distance`: the stair steps coloured by their distance from the model; `weights`: heat map of
 * the facets' weights; `walls`: heat map of the wall thickness.
 */
export type Look = "thickness" | "printed" | "distance" | "weights" | "walls";

/** Band while no layer is selected; contains no height. */
const NO_BAND: readonly [number, number] = [0, -1];

function boundariesTexture(rows: number): DataTexture {
  const texture = new DataTexture(new Float32Array(ROW * rows), ROW, rows, RedFormat, FloatType);
  texture.minFilter = texture.magFilter = NearestFilter;
  return texture;
}

function paletteTexture(): DataTexture {
  const texture = new DataTexture(TABLE, PALETTE_SIZE, 1, RGBAFormat, UnsignedByteType);
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

/** Sets infinite bounds, which saves three.js a pass over all points. */
function bounded(geometry: BufferGeometry): BufferGeometry {
  geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
  return geometry;
}

/** Colour of supports, which is in no scale. */
const SUPPORT_RESIN = [0.52, 0.58, 0.68] as const;

/** Colour of the void, seen through the model. */
const VOID_COLOUR = [0.36, 0.62, 0.75] as const;

/** Opacity of the model while the void is seen through it. */
const SEE_THROUGH = 0.32;

/** Height of a cut above everything: none. */
export const NO_CUT_MM = 1e9;

export class Model {
  /** Height above which everything is cut off, mm; a uniform of all materials. */
  readonly cut: IUniform<number> = { value: NO_CUT_MM };
  /** Position of the selected copy: the middle, if it is the only one. */
  readonly stand = new Group();
  /** Turns about the model's centre; the gizmo is attached to it. */
  readonly pivot = new Group();
  readonly facets: Mesh<BufferGeometry, RawShaderMaterial>;
  /** The stair steps, already posed. */
  readonly steps = new Group();
  /** The supports, already posed. */
  readonly supports: Mesh<BufferGeometry, RawShaderMaterial>;
  /** The walls of the void, already posed. */
  readonly voids: Mesh<BufferGeometry, RawShaderMaterial>;
  /** Lift of the model above the plate, mm. Takes effect with the next pose. */
  lift_mm = 0;
  /** Size of the posed model including the lift below it, mm. */
  size_mm: Triple = [0, 0, 0];
  #positions: Float32Array = new Float32Array(0);
  #points: Float32Array = this.#positions;
  #middle = new Vector3();
  #boundaries = boundariesTexture(1);
  readonly #palette = paletteTexture();
  #heat = heatTexture(1);
  /** True if the GPU has the heat of every facet, so that only changes need uploading. */
  #hasHeat = false;
  /** Texture rows that have changed since. */
  readonly #stale = new Set<number>();
  #look: Look = "thickness";
  #hasSteps = false;
  #hasDistances = false;
  #hasPlan = false;
  #hasWalls = false;
  #hasVoids = false;
  readonly wallColours = new WallColours();
  #isSeenThrough = false;
  #isMarked = false;
  readonly #material: RawShaderMaterial;
  /** Depth pass, which limits a transparent model to its nearest facets. */
  readonly #depth: Mesh<BufferGeometry, RawShaderMaterial>;

  constructor() {
    this.#material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: MODEL_VERTEX,
      fragmentShader: MODEL_FRAGMENT,
      side: DoubleSide,
      uniforms: {
        boundaries: { value: this.#boundaries },
        layers: { value: 1 },
        cellsPerMm: { value: 0 },
        palette: { value: this.#palette },
        limits: { value: new Vector2(0, 0) },
        byThickness: { value: false },
        heat: { value: this.#heat },
        greatest: { value: 1 },
        resin: { value: new Vector3(0.75, 0.77, 0.8) },
        band: { value: new Vector2(...NO_BAND) },
        opacity: { value: 1 },
        cut: this.cut,
        marks: { value: 0 },
        markLow: { value: [] },
        markHigh: { value: [] },
        ...this.wallColours.uniforms,
      },
    });
    this.facets = new Mesh(new BufferGeometry(), this.#material);
    const body = (colour: readonly [number, number, number]): Mesh<BufferGeometry, RawShaderMaterial> => {
      const mesh = new Mesh(new BufferGeometry(), this.#material.clone());
      Object.assign(mesh.material.uniforms, { resin: { value: new Vector3(...colour) }, cut: this.cut });
      mesh.visible = false;
      return mesh;
    };
    this.supports = body(SUPPORT_RESIN);
    this.voids = body(VOID_COLOUR);
    const depth = { glslVersion: GLSL3, vertexShader: PICK_VERTEX, fragmentShader: PICK_FRAGMENT, side: DoubleSide, colorWrite: false } as const;
    // Drawn among transparent objects, after the void and before the facets; offset slightly behind the facets, so as never to hide them.
    const behind = { transparent: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 4 } as const;
    this.#depth = new Mesh(this.facets.geometry, new RawShaderMaterial({ ...depth, ...behind, uniforms: { cut: this.cut } }));
    this.#depth.renderOrder = 5;
    this.#depth.visible = false;
    this.facets.renderOrder = 6;
    this.facets.add(this.#depth);
    this.pivot.add(this.facets);
    this.stand.add(this.pivot, this.steps, this.supports, this.voids);
    this.stand.matrixAutoUpdate = false;
  }

  get material(): RawShaderMaterial {
    return this.#material;
  }

  get positions(): Float32Array {
    return this.#positions;
  }

  /** Factor applied to the file's lengths. */
  get scale(): number {
    return this.pivot.scale.x || 1;
  }

  /** @param positions nine numbers per facet, mm, in the file's pose */
  setPositions(positions: Float32Array, rotation: Rotation, scale: number): void {
    this.#positions = positions;
    this.#points = positions;
    this.facets.geometry.dispose();
    this.facets.geometry = bounded(new BufferGeometry());
    this.facets.geometry.setAttribute("position", new BufferAttribute(positions, 3));
    this.#depth.geometry = this.facets.geometry;
    this.setSteps(null);
    const { least, greatest } = this.setPose(rotation, scale);
    // The model turns about the centre of these bounds from now on.
    this.#middle
      .set(...least)
      .add(new Vector3(...greatest))
      .divideScalar(2 * (scale || 1))
      .applyQuaternion(this.pivot.quaternion.clone().invert());
    this.facets.position.copy(this.#middle).negate();
    this.pivot.position.set(0, 0, (this.size_mm[2] + this.lift_mm) / 2);
  }

  /** Sets the same points without duplicates, to speed up `setPose`. */
  setPoints(points: Float32Array): void {
    this.#points = points;
  }

  /** Returns the bounds before the model is placed on the plate. Cost: linear in its points. */
  setPose(rotation: Rotation, scale: number): Extent {
    const extent = extentOf(this.#points, rotation, scale);
    this.pivot.quaternion.set(...rotation);
    this.pivot.scale.setScalar(scale);
    this.pivot.position
      .copy(this.#middle)
      .multiplyScalar(scale)
      .applyQuaternion(this.pivot.quaternion)
      .add(new Vector3(...standing(extent)))
      .add(new Vector3(0, 0, this.lift_mm));
    this.steps.position.z = this.lift_mm;
    const [x, y, z] = sizeOf(extent);
    this.size_mm = [x, y, z + this.lift_mm];
    return extent;
  }

  /** @param positions nine numbers per facet, mm, z from the plate; null: none */
  setSupports(positions: Float32Array | null): void {
    this.supports.visible = replaced(this.supports, positions);
  }

  /** Sets the walls of the void, likewise; visible while the model is transparent. */
  setVoids(positions: Float32Array | null): void {
    this.#hasVoids = replaced(this.voids, positions);
    this.#show();
  }

  /** Shows the void through the model. */
  setSeeThrough(on: boolean): void {
    this.#isSeenThrough = on;
    this.#show();
  }

  /** Colours by the layers between these boundaries; with fewer than two boundaries, the model is plain. */
  setPlan(z_mm: readonly number[]): void {
    const rows = rowsFor(z_mm.length);
    if (rows !== this.#boundaries.image.height) {
      this.#boundaries.dispose();
      this.#boundaries = boundariesTexture(rows);
    }
    this.#set("cellsPerMm", packBoundaries(z_mm, this.#boundaries.image.data as Float32Array));
    this.#boundaries.needsUpdate = true;
    this.#set("boundaries", this.#boundaries);
    this.#set("layers", Math.max(1, z_mm.length - 1));
    this.#hasPlan = z_mm.length >= 2;
    this.#show();
  }

  setLimits(limits: readonly [number, number]): void {
    this.#set("limits", new Vector2(...limits));
  }

  /** Updates the heat map of all facets, or only of `facets`. */
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

  /** Marks the heights between two boundaries, mm; null: none. */
  setBand(band: readonly [number, number] | null): void {
    this.#set("band", new Vector2(...(band ?? NO_BAND)));
  }

  /** Cuts off everything above a height, mm; null: nothing. */
  setCut(cut_mm: number | null): void {
    this.cut.value = cut_mm ?? NO_CUT_MM;
    define(this.supports.material, cut_mm === null ? [] : ["CUT"]);
    define(this.voids.material, cut_mm === null ? [] : ["CUT", "VOID"]);
    this.#show();
  }

  /** Paints what is within these boxes, in the frame of the scene. */
  setMarked(boxes: readonly (readonly [Vector3, Vector3])[]): void {
    const all = boxes.slice(0, MOST_MARKS);
    // The shader's arrays have one length.
    const filled = (corners: readonly Vector3[]): Vector3[] => Array.from({ length: MOST_MARKS }, (_, i) => corners[i] ?? new Vector3());
    this.#set("marks", all.length);
    this.#set("markLow", filled(all.map(([low]) => low)));
    this.#set("markHigh", filled(all.map(([, high]) => high)));
    this.#isMarked = all.length > 0;
    this.#show();
  }

  setLook(look: Look): void {
    this.#look = look;
    this.#show();
  }

  setWalls(walls: Walls | null): void {
    this.wallColours.set(walls);
    this.#hasWalls = walls !== null;
    this.#show();
  }

  setSteps(steps: Steps | null): void {
    this.#clearSteps();
    const measured = isMeasured(steps) ? steps : null;
    for (const [i, { positions, index }] of (steps?.parts ?? []).entries()) {
      const geometry = bounded(new BufferGeometry());
      const away_mm = measured?.parts[i]?.away_mm;
      geometry.setAttribute("position", new BufferAttribute(positions, 3));
      if (away_mm !== undefined) geometry.setAttribute("away", new BufferAttribute(away_mm, 1));
      geometry.setIndex(new BufferAttribute(index, 1));
      this.steps.add(new Mesh(geometry, this.#material));
    }
    this.#hasSteps = steps !== null;
    this.#hasDistances = measured !== null;
    // If no step deviates from the model, any scale gives all the colour of zero.
    this.#set("greatest", measured?.greatest_mm || 1);
    this.#show();
  }

  dispose(): void {
    this.facets.geometry.dispose();
    this.#clearSteps();
    this.supports.geometry.dispose();
    this.supports.material.dispose();
    this.voids.geometry.dispose();
    this.voids.material.dispose();
    this.#depth.material.dispose();
    this.#material.dispose();
    this.#boundaries.dispose();
    this.#palette.dispose();
    this.#heat.dispose();
    this.wallColours.dispose();
  }

  #clearSteps(): void {
    for (const part of this.steps.children) if (part instanceof Mesh) part.geometry.dispose();
    this.steps.clear();
  }

  #set(uniform: string, value: unknown): void {
    const found = this.#material.uniforms[uniform];
    if (found !== undefined) found.value = value;
  }

  /** Shows the facets in the same resin until the steps are computed. */
  #show(): void {
    const asSteps = (this.#look === "printed" || this.#look === "distance") && this.#hasSteps;
    this.steps.visible = asSteps;
    this.facets.visible = !asSteps && this.#positions.length > 0;
    const isSeenThrough = this.#isSeenThrough && this.facets.visible;
    this.#depth.visible = isSeenThrough && this.#hasVoids;
    this.voids.visible = this.#hasVoids && (isSeenThrough || this.#isCut);
    this.#material.transparent = this.#depth.visible;
    this.#set("opacity", this.#depth.visible ? SEE_THROUGH : 1);
    this.#set("byThickness", this.#look === "thickness" && this.#hasPlan && !this.#depth.visible);
    const look =
      this.#look === "weights"
        ? ["BY_HEAT"]
        : this.#look === "distance" && this.#hasDistances
          ? ["BY_DISTANCE"]
          : this.#look === "walls" && this.#hasWalls
            ? ["BY_WALLS"]
            : [];
    define(this.#material, [...look, ...(this.#isCut ? ["CUT"] : []), ...(this.#isMarked ? ["MARKED"] : [])]);
  }

  get #isCut(): boolean {
    return this.cut.value < NO_CUT_MM;
  }
}

/** Switches to a variant of the shader. three.js caches the program of each. */
export function define(material: RawShaderMaterial, names: readonly string[]): void {
  if (String(names) === String(Object.keys(material.defines))) return;
  material.defines = Object.fromEntries(names.map((name) => [name, true]));
  material.needsUpdate = true;
}

/** Replaces the facets of a body; returns true if it has any. */
function replaced(body: Mesh, positions: Float32Array | null): boolean {
  body.geometry.dispose();
  body.geometry = bounded(new BufferGeometry());
  if (positions !== null) body.geometry.setAttribute("position", new BufferAttribute(positions, 3));
  return positions !== null && positions.length > 0;
}
