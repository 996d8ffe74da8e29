/** The markers of points on the model: what is hidden is drawn dimmed through it. */
import { BufferAttribute, BufferGeometry, Color, GLSL3, Group, LineBasicMaterial, LineSegments, Points, Quaternion, RawShaderMaterial, Sphere, Vector2, Vector3 } from "three";
import { MARK_COLOUR } from "../scene/marker.js";
import type { Triple } from "../scene/pose.js";
import type { Rgb } from "../legend/palette.js";
import { LOCKED, MARKER_FRAGMENT, MARKER_VERTEX, SELECTED, UNREACHED } from "./shaders.js";

/** A point that is supported, or where a hole begins. */
export interface ViewPoint {
  /** x and y from the model's middle, z from its lowest point, mm: how far the model is lifted does not matter. */
  readonly at_mm: Triple;
  readonly isLocked: boolean;
  /** True if nothing gets there. */
  readonly isUnreached: boolean;
  /** The way in and the diameter of a hole, of which the rim is drawn. */
  readonly inward?: Triple | null;
  readonly diameter_mm?: number | null;
}

/** How strongly what is behind the model is drawn. */
const DIMMED = 0.4;

/** Sides of a rim. */
const SIDES = 48;

const OUTWARD = new Vector3(0, 0, 1);

export class Markers {
  readonly group = new Group();
  #points: readonly ViewPoint[] = [];
  #selected: number | null = null;
  /** The point that is being dragged, and where it is. */
  #dragged: { readonly place: number; readonly at_mm: Triple; readonly inward: Triple } | null = null;
  readonly #size = new Vector2(1, 1);
  readonly #accent = new Vector3();
  readonly #bad = new Vector3();
  readonly #marks = [this.#layer(DIMMED, false), this.#layer(1, true)] as const;
  readonly #rims = [rims(DIMMED, false), rims(1, true)] as const;

  constructor() {
    // After the model, and what is dimmed before what is not.
    for (const [order, layer] of [...this.#rims, ...this.#marks].entries()) {
      layer.renderOrder = 12 + order;
      layer.frustumCulled = false;
      this.group.add(layer);
    }
    this.group.visible = false;
  }

  get points(): readonly ViewPoint[] {
    return this.#points;
  }

  set(points: readonly ViewPoint[], selected: number | null): void {
    this.#points = points;
    this.#selected = selected;
    this.#draw();
  }

  /** Draws a point elsewhere while it is being dragged; null: where it is. */
  drag(dragged: { readonly place: number; readonly at_mm: Triple; readonly inward: Triple } | null): void {
    this.#dragged = dragged;
    this.#draw();
  }

  setTheme(accent: Rgb, bad: Rgb): void {
    this.#accent.set(...accent).divideScalar(255);
    this.#bad.set(...bad).divideScalar(255);
    for (const { material } of this.#rims) material.color.setRGB(accent[0] / 255, accent[1] / 255, accent[2] / 255, "srgb");
  }

  /** @param height_px of the view, CSS pixels */
  prepare(height_px: number, density: number): void {
    this.#size.set(height_px, density);
  }

  dispose(): void {
    for (const { geometry, material } of [...this.#marks, ...this.#rims]) {
      geometry.dispose();
      material.dispose();
    }
  }

  #layer(opacity: number, isTested: boolean): Points<BufferGeometry, RawShaderMaterial> {
    const chosen = new Color().setHex(MARK_COLOUR, "srgb-linear");
    const material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: MARKER_VERTEX,
      fragmentShader: MARKER_FRAGMENT,
      uniforms: {
        view_px: { value: this.#size },
        opacity: { value: opacity },
        accent: { value: this.#accent },
        bad: { value: this.#bad },
        chosen: { value: chosen },
      },
      transparent: true,
      depthTest: isTested,
      depthWrite: false,
    });
    return new Points(new BufferGeometry(), material);
  }

  #draw(): void {
    const dragged = this.#dragged;
    const points = this.#points.map((point, place) => (place === dragged?.place ? { ...point, ...dragged } : point));
    const shows = points.map(({ isLocked, isUnreached }, place) => {
      const isSelected = place === this.#selected;
      return (isLocked ? LOCKED : 0) + (isUnreached ? UNREACHED : 0) + (isSelected ? SELECTED : 0);
    });
    // What is drawn later is above: the selected one, then those by hand.
    const order = [...points.keys()].sort((a, b) => (shows[a] ?? 0) - (shows[b] ?? 0));
    const positions = Float32Array.from(order.flatMap((place) => points[place]?.at_mm ?? []));
    const shown = Float32Array.from(order.map((place) => shows[place] ?? 0));
    // A hole begins a diameter before the surface.
    const before_mm = Float32Array.from(order.map((place) => (points[place]?.inward == null ? 0 : (points[place].diameter_mm ?? 0))));
    for (const layer of this.#marks) {
      const geometry = replaced(layer, positions);
      geometry.setAttribute("shows", new BufferAttribute(shown, 1));
      geometry.setAttribute("before_mm", new BufferAttribute(before_mm, 1));
    }
    const around = Float32Array.from(points.flatMap(rimOf));
    for (const layer of this.#rims) replaced(layer, around);
  }
}

/** Gives what is drawn other points. */
function replaced(layer: Points | LineSegments, positions: Float32Array): BufferGeometry {
  layer.geometry.dispose();
  layer.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(positions, 3));
  layer.geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
  layer.visible = positions.length > 0;
  return layer.geometry;
}

function rims(opacity: number, isTested: boolean): LineSegments<BufferGeometry, LineBasicMaterial> {
  const material = new LineBasicMaterial({ transparent: true, opacity, depthTest: isTested, depthWrite: false });
  return new LineSegments(new BufferGeometry(), material);
}

/** The lines around a hole, a little outside the surface. */
function rimOf({ at_mm, inward, diameter_mm }: ViewPoint): number[] {
  if (inward == null || diameter_mm == null) return [];
  const turn = new Quaternion().setFromUnitVectors(OUTWARD, new Vector3(...inward).negate().normalize());
  const corner = (side: number): number[] => {
    const angle = (2 * Math.PI * side) / SIDES;
    const along = new Vector3(Math.cos(angle), Math.sin(angle), 0.1).multiplyScalar(diameter_mm / 2);
    return along.applyQuaternion(turn).add(new Vector3(...at_mm)).toArray();
  };
  return Array.from({ length: SIDES }, (_, side) => [...corner(side), ...corner(side + 1)]).flat();
}
