/** The plate under the model: a grid in mm, the model's shadow, and the outline of the printer's build volume. */
import {
  BoxGeometry,
  EdgesGeometry,
  GLSL3,
  Group,
  LineBasicMaterial,
  LineSegments,
  LinearFilter,
  LinearMipmapLinearFilter,
  Mesh,
  OrthographicCamera,
  PlaneGeometry,
  RawShaderMaterial,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderTarget,
  type WebGLRenderer,
} from "three";
import type { Rgb } from "../legend/palette.js";
import type { Triple } from "./pose.js";
import { BLUR_FRAGMENT, BLUR_VERTEX, PLATE_FRAGMENT, PLATE_VERTEX, SHADOW_FRAGMENT, SHADOW_VERTEX } from "./shaders.js";

/** Build volume of a printer. */
export interface BuildVolume {
  readonly width_mm: number;
  readonly depth_mm: number;
  readonly height_mm: number;
}

/** Side of the shadow's texture, pixels; it is blurred and needs no detail. */
const SHADOW_PIXELS = 256;

/** Side of that texture as a multiple of the model's width or depth, with room for the blur. */
const SHADOW_ROOM = 1.6;

/** Maximum height from which the model casts a shadow, as a fraction of its longest side. */
const SHADOW_REACH = 0.4;

/** Side of the plate without a printer, as a multiple of the model's longest side. */
const PLATE_ROOM = 3.2;

/** Target number of grid lines across the model; the spacing is rounded to a power of ten, mm. */
const LINES_ACROSS = 4;

export class Plate {
  readonly group = new Group();
  /** Spacing of the thin grid lines, mm. */
  step_mm = 10;
  readonly #ground: Mesh<PlaneGeometry, RawShaderMaterial>;
  readonly #edges: LineSegments<EdgesGeometry, LineBasicMaterial>;
  readonly #target = new WebGLRenderTarget(SHADOW_PIXELS, SHADOW_PIXELS, {
    depthBuffer: true,
    generateMipmaps: true,
    minFilter: LinearMipmapLinearFilter,
    magFilter: LinearFilter,
  });
  /** The shadow's texture, blurred. */
  readonly #soft = new WebGLRenderTarget(SHADOW_PIXELS / 2, SHADOW_PIXELS / 2, { depthBuffer: false });
  readonly #blur = new Mesh(
    new PlaneGeometry(1, 1),
    new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: BLUR_VERTEX,
      fragmentShader: BLUR_FRAGMENT,
      uniforms: { sharp: { value: this.#target.texture } },
    }),
  );
  readonly #below = new OrthographicCamera();
  readonly #scene = new Scene();
  readonly #caster: Mesh;
  readonly #shade = new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: SHADOW_VERTEX,
    fragmentShader: SHADOW_FRAGMENT,
    uniforms: { reach: { value: 1 } },
    side: 2,
  });
  #ink: Rgb = [0, 0, 0];
  #bad: Rgb = [200, 40, 40];
  #fits = true;
  #stale = true;
  #shadowStrength = 0.5;

  constructor(model: Mesh) {
    this.#ground = new Mesh(
      new PlaneGeometry(1, 1),
      new RawShaderMaterial({
        glslVersion: GLSL3,
        vertexShader: PLATE_VERTEX,
        fragmentShader: PLATE_FRAGMENT,
        transparent: true,
        premultipliedAlpha: true,
        depthWrite: false,
        side: 2,
        uniforms: {
          ink: { value: new Vector3() },
          step_mm: { value: 10 },
          half_mm: { value: new Vector2(1, 1) },
          hasEdge: { value: false },
          shadow: { value: this.#soft.texture },
          shadowHalf_mm: { value: 1 },
          shadowStrength: { value: 0.5 },
        },
      }),
    );
    this.#blur.frustumCulled = false;
    // Drawn after the model, which hides the parts behind it.
    this.#ground.renderOrder = 1;
    this.#edges = new LineSegments(
      new EdgesGeometry(new BoxGeometry(1, 1, 1).translate(0, 0, 0.5)),
      new LineBasicMaterial({ transparent: true, depthWrite: false }),
    );
    this.#edges.renderOrder = 2;
    this.group.add(this.#ground, this.#edges);
    this.#caster = model.clone();
    this.#caster.material = this.#shade;
    this.#caster.matrixAutoUpdate = false;
    this.#caster.matrixWorldAutoUpdate = false;
    this.#scene.add(this.#caster);
    this.#below.position.set(0, 0, 0);
    this.#below.up.set(0, 1, 0);
    this.#below.lookAt(0, 0, 1);
  }

  setTheme(ink: Rgb, bad: Rgb, shadowStrength: number): void {
    this.#ink = ink;
    this.#bad = bad;
    this.#set("ink", new Vector3(...ink).divideScalar(255));
    this.#shadowStrength = shadowStrength;
    this.#set("shadowStrength", shadowStrength);
    this.#colourEdges();
  }

  /** Fits the plate to a model of this size, mm, and to the printer, if any. */
  fit(size_mm: Triple, volume: BuildVolume | null): void {
    const [x, y, z] = size_mm;
    const span = Math.max(x, y, z, 1e-3);
    const [width, depth] =
      volume === null ? [PLATE_ROOM * span, PLATE_ROOM * span] : [volume.width_mm, volume.depth_mm];
    this.#ground.scale.set(width, depth, 1);
    this.#set("half_mm", new Vector2(width / 2, depth / 2));
    this.#set("hasEdge", volume !== null);
    this.step_mm = 10 ** Math.round(Math.log10(span / LINES_ACROSS));
    this.#set("step_mm", this.step_mm);
    this.#edges.visible = volume !== null;
    this.#edges.scale.set(width, depth, volume?.height_mm ?? 1);
    this.#fits = volume === null || (x <= width && y <= depth && z <= volume.height_mm);
    this.#colourEdges();
    const half = (SHADOW_ROOM * Math.max(x, y, 1e-3)) / 2;
    this.#set("shadowHalf_mm", half);
    // From below, the picture is mirrored; swapping left and right undoes that.
    Object.assign(this.#below, { left: half, right: -half, top: half, bottom: -half, near: -0.01 * span, far: span });
    this.#below.updateProjectionMatrix();
    const reach = this.#shade.uniforms["reach"];
    if (reach !== undefined) reach.value = SHADOW_REACH * span;
    this.#stale = true;
  }

  /** Sets whether all placements are valid, and whether the model casts a shadow, which would be incomplete with several copies. */
  setPlated(isGood: boolean, hasShadow: boolean): void {
    this.#fits &&= isGood;
    this.#colourEdges();
    this.#set("shadowStrength", hasShadow ? this.#shadowStrength : 0);
  }

  /** Redraws the shadow if the model has changed. */
  prepare(renderer: WebGLRenderer, model: Mesh): void {
    if (!this.#stale || !this.group.visible) return;
    this.#stale = false;
    this.#caster.geometry = model.geometry;
    this.#caster.matrixWorld.copy(model.matrixWorld);
    renderer.setRenderTarget(this.#target);
    renderer.render(this.#scene, this.#below);
    renderer.setRenderTarget(this.#soft);
    renderer.render(this.#blur, this.#below);
    renderer.setRenderTarget(null);
  }

  /** Must be called when a lost context is restored, which loses the shadow. */
  restored(): void {
    this.#stale = true;
  }

  dispose(): void {
    this.#target.dispose();
    this.#soft.dispose();
    this.#blur.geometry.dispose();
    this.#blur.material.dispose();
    this.#shade.dispose();
    this.#ground.geometry.dispose();
    this.#ground.material.dispose();
    this.#edges.geometry.dispose();
    this.#edges.material.dispose();
  }

  #colourEdges(): void {
    const { color } = this.#edges.material;
    const [r, g, b] = this.#fits ? this.#ink : this.#bad;
    color.setRGB(r / 255, g / 255, b / 255, "srgb");
    this.#edges.material.opacity = this.#fits ? 0.22 : 0.9;
  }

  #set(uniform: string, value: unknown): void {
    const found = this.#ground.material.uniforms[uniform];
    if (found !== undefined) found.value = value;
  }
}
