/**
 * Draws offscreen and shows the picture once it is finished.
 *
 * Without a GPU, the browser copies the canvas in every frame of the page, and the page freezes until the software renderer has drawn it:
 * seconds for a million facets. With offscreen drawing, the page stays responsive, and the canvas keeps its previous picture until the new
 * one is ready.
 */
import {
  GLSL3,
  Mesh,
  NearestFilter,
  NoBlending,
  OrthographicCamera,
  PlaneGeometry,
  RawShaderMaterial,
  SRGBColorSpace,
  WebGLRenderTarget,
  type Camera,
  type Scene,
  type WebGLRenderer,
} from "three";

/** Interval between checks whether a picture is finished, ms. */
const LOOK_EVERY_MS = 8;

const VERTEX = `precision highp float;
in vec3 position;
void main() {
  gl_Position = vec4(position.xy, 0.0, 1.0);
}`;

const FRAGMENT = `precision highp float;
uniform sampler2D picture;
out vec4 colour;
void main() {
  colour = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
}`;

/** A target for which three.js encodes colours as for a canvas; in other targets, it leaves them linear. */
class CanvasLike extends WebGLRenderTarget {
  readonly isXRRenderTarget = true;
}

export interface OffscreenReports {
  /** Called when the canvas must take the picture's size. */
  fit(): void;
  /** Called when the picture is on the canvas. */
  shown(): void;
  /** Called when the next picture may be drawn. */
  free(): void;
}

export class Offscreen {
  readonly #renderer: WebGLRenderer;
  readonly #target: CanvasLike;
  readonly #copy: Mesh<PlaneGeometry, RawShaderMaterial>;
  readonly #eye = new OrthographicCamera();
  #isBusy = false;
  #timer = 0;
  #asked = 0;
  #done: WebGLSync | null = null;

  constructor(renderer: WebGLRenderer) {
    this.#renderer = renderer;
    const gl = renderer.getContext();
    this.#target = new CanvasLike(1, 1, {
      colorSpace: SRGBColorSpace,
      // Not an sRGB format: the encoded values are copied unchanged.
      internalFormat: "RGBA8",
      minFilter: NearestFilter,
      magFilter: NearestFilter,
      // Antialiased like the canvas.
      samples: Number(gl.getParameter(gl.SAMPLES)),
    });
    this.#copy = new Mesh(
      new PlaneGeometry(2, 2),
      new RawShaderMaterial({
        glslVersion: GLSL3,
        vertexShader: VERTEX,
        fragmentShader: FRAGMENT,
        uniforms: { picture: { value: this.#target.texture } },
        blending: NoBlending,
        depthTest: false,
        depthWrite: false,
      }),
    );
    this.#copy.frustumCulled = false;
  }

  get isBusy(): boolean {
    return this.#isBusy;
  }

  /** Draws a picture of this size in pixels. Must not be called while busy. */
  draw(scene: Scene, camera: Camera, [width, height]: readonly [number, number], { fit, shown, free }: OffscreenReports): void {
    const gl = this.#renderer.getContext() as WebGL2RenderingContext;
    this.#target.setSize(width, height);
    this.#renderer.setRenderTarget(this.#target);
    this.#renderer.render(scene, camera);
    this.#renderer.setRenderTarget(null);
    const done = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    this.#isBusy = true;
    this.#done = done;
    const look = (): void => {
      if (done !== null && !gl.isContextLost() && gl.clientWaitSync(done, 0, 0) === gl.TIMEOUT_EXPIRED) {
        this.#timer = window.setTimeout(look, LOOK_EVERY_MS);
        return;
      }
      gl.deleteSync(done);
      this.#done = null;
      this.#asked = requestAnimationFrame(() => {
        fit();
        this.#renderer.render(this.#copy, this.#eye);
        shown();
        // If the next picture started before the browser has fetched this one, the browser would wait for both.
        this.#asked = requestAnimationFrame(() => {
          this.#isBusy = false;
          free();
        });
      });
    };
    // A GPU has finished by then.
    this.#timer = window.setTimeout(look);
  }

  dispose(): void {
    clearTimeout(this.#timer);
    cancelAnimationFrame(this.#asked);
    (this.#renderer.getContext() as WebGL2RenderingContext).deleteSync(this.#done);
    this.#target.dispose();
    this.#copy.geometry.dispose();
    this.#copy.material.dispose();
  }
}
