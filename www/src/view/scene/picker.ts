/** Picks the facet under a pixel by rendering only that pixel, with facet numbers as colours. */
import {
  DoubleSide,
  GLSL3,
  Mesh,
  NearestFilter,
  Plane,
  RawShaderMaterial,
  Raycaster,
  Scene,
  Vector2,
  Vector3,
  WebGLRenderTarget,
  type BufferGeometry,
  type IUniform,
  type OrthographicCamera,
  type PerspectiveCamera,
  type WebGLRenderer,
} from "three";
import { PICK_FRAGMENT, PICK_VERTEX } from "./shaders.js";

export interface Hit {
  readonly facet: number;
  /** Height above the plate, mm. */
  readonly z_mm: number;
}

export class Picker {
  readonly #target = new WebGLRenderTarget(1, 1, { minFilter: NearestFilter, magFilter: NearestFilter });
  readonly #material: RawShaderMaterial;
  readonly #mesh = new Mesh<BufferGeometry, RawShaderMaterial>();
  readonly #scene = new Scene();
  readonly #ray = new Raycaster();

  /** @param cut height above which nothing is met, mm */
  constructor(cut: IUniform<number>) {
    this.#material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: PICK_VERTEX,
      fragmentShader: PICK_FRAGMENT,
      side: DoubleSide,
      uniforms: { cut },
    });
    this.#mesh.material = this.#material;
    this.#mesh.matrixAutoUpdate = false;
    this.#mesh.matrixWorldAutoUpdate = false;
    this.#scene.add(this.#mesh);
  }

  /** The facet of `model` under the pixel (x, y) of a view of `width` by `height` pixels, y downwards; or null. */
  async pick(
    renderer: WebGLRenderer,
    camera: PerspectiveCamera | OrthographicCamera,
    model: Mesh,
    [x, y]: readonly [number, number],
    [width, height]: readonly [number, number],
  ): Promise<Hit | null> {
    const matrix = model.matrixWorld.clone();
    const positions = model.geometry.getAttribute("position");
    if (positions === undefined) return null;
    this.#mesh.geometry = model.geometry;
    this.#mesh.matrixWorld.copy(matrix);
    this.#ray.setFromCamera(new Vector2(((x + 0.5) / width) * 2 - 1, 1 - ((y + 0.5) / height) * 2), camera);
    const ray = this.#ray.ray.clone();
    camera.setViewOffset(width, height, x, y, 1, 1);
    renderer.setRenderTarget(this.#target);
    renderer.render(this.#scene, camera);
    renderer.setRenderTarget(null);
    camera.clearViewOffset();
    const pixel = new Uint8Array(4);
    await renderer.readRenderTargetPixelsAsync(this.#target, 0, 0, 1, 1, pixel);
    const facet = new DataView(pixel.buffer).getUint32(0, true) - 1;
    if (facet < 0 || 3 * facet + 2 >= positions.count) return null;
    const [a, b, c] = [0, 1, 2].map((i) =>
      new Vector3().fromBufferAttribute(positions, 3 * facet + i).applyMatrix4(matrix),
    ) as [Vector3, Vector3, Vector3];
    // Intersects the plane, not the triangle: at an edge, the centre of the pixel may lie just outside the triangle.
    const at = ray.intersectPlane(new Plane().setFromCoplanarPoints(a, b, c), new Vector3());
    const z = at?.z ?? (a.z + b.z + c.z) / 3;
    const [lowest, highest] = [Math.min(a.z, b.z, c.z), Math.max(a.z, b.z, c.z)];
    return { facet, z_mm: Math.min(Math.max(z, lowest), highest) };
  }

  dispose(): void {
    this.#target.dispose();
    this.#material.dispose();
  }
}
