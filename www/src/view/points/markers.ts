/** Markers of points on the model; hidden parts are drawn dimmed through it. */
import { BufferAttribute, BufferGeometry, Color, GLSL3, Group, LineBasicMaterial, LineSegments, Points, Quaternion, RawShaderMaterial, Sphere, Vector2, Vector3 } from "three";
import { MARK_COLOUR } from "../scene/marker.js";
import type { Triple } from "../scene/pose.js";
import type { Rgb } from "../legend/palette.js";
import { LOCKED, MARKER_FRAGMENT, MARKER_VERTEX, SELECTED, UNREACHED } from "./shaders.js";

/** A support point, or the start of a drain hole. */
export interface ViewPoint {
  /** x and y from the model's centre, z from its lowest point, mm; independent of the lift. */
  readonly at_mm: Triple;
  readonly isLocked: boolean;
  /** True if no support reaches the point, or the hole meets no void. */
  readonly isUnreached: boolean;
  /** Direction into the model and diameter of a hole, whose rim is drawn. */
  readonly inward?: Triple | null;
  readonly diameter_mm?: number | null;
}

/** Opacity of parts behind the model. */
const DIMMED = 0.4;

/** Number of sides of a rim. */
const SIDES = 48;

const OUTWARD = new Vector3(0, 0, 1);

export class Markers {
  readonly group = new Group();
  #points: readonly ViewPoint[] = [];
  #selected: number | null = null;
  /** The point being dragged, and its current place. */
  #dragged: { readonly place: number; readonly at_mm: Triple; readonly inward: Triple } | null = null;
  readonly #size = new Vector2(1, 1);
  readonly #accent = new Vector3();
  readonly #bad = new Vector3();
  readonly #marks = [this.#layer(DIMMED, false), this.#layer(1, true)] as const;
  readonly #rims = [rims(DIMMED, false), rims(1, true)] as const;

  constructor() {
    // After the model; dimmed layers before the others.
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

  /** Draws a point at another place during a drag; null ends that. */
  drag(dragged: { readonly place: number; readonly at_mm: Triple; readonly inward: Triple } | null): void {
    this.#dragged = dragged;
    this.#draw();
  }

  setTheme(accent: Rgb, bad: Rgb): void {
    this.#accent.set(...accent).divideScalar(255);
    this.#bad.set(...bad).divideScalar(255);
    for (const { material } of this.#rims) material.color.setRGB(accent[0] / 255, accent[1] / 255, accent[2] / 255, "srgb");
  }

  /** @param height_px height of the view, CSS pixels */
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
    // Later markers are on top: those by hand, then the selected one.
    const order = [...points.keys()].sort((a, b) => (shows[a] ?? 0) - (shows[b] ?? 0));
    const positions = Float32Array.from(order.flatMap((place) => points[place]?.at_mm ?? []));
    const shown = Float32Array.from(order.map((place) => shows[place] ?? 0));
    // The marker of a hole is drawn one diameter nearer to the eye, so that the hole's edge does not cover it.
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

/** Replaces the points of a layer. */
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

/** Line segments around a hole, slightly outside the surface. */
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
