/** The view's scene on its canvas. Draws only on changes. */
import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  Raycaster,
  Scene as ThreeScene,
  Vector2,
  Vector3,
  type OrthographicCamera,
  type PerspectiveCamera,
  type Ray,
  WebGLRenderer,
} from "three";
import { Offscreen } from "./offscreen.js";
import { Cameras, type Alignment, type Frame } from "./cameras.js";
import { Copies, matrixOf, sizeOfAll, type Copy } from "./copies.js";
import { Gizmo, type GizmoReports } from "./gizmo.js";
import type { Tool } from "./keys.js";
import { Marker, middleOf, type Mark } from "./marker.js";
import { Markers } from "../points/markers.js";
import { Model } from "./model.js";
import type { Rgb } from "../legend/palette.js";
import { Picker, type Hit } from "./picker.js";
import { places } from "./places.js";
import { Plate, type BuildVolume } from "./plate.js";
import { Selection } from "./selection.js";
import type { Rotation, Triple } from "./pose.js";
import type { Viewpoint } from "./viewpoint.js";

/** Maximum pixel ratio for drawing: doubling it costs four times as many pixels with no visible gain. */
const DENSITY_LIMIT = 2;

/** From this many facets on, a software renderer would block the page for too long, so drawing is offscreen. */
const LARGE_FACETS = 50_000;

export interface Theme {
  /** Lines of the plate. */
  readonly ink: Rgb;
  /** The facets highlighted under the pointer. */
  readonly accent: Rgb;
  /** The build volume's outline when the model does not fit. */
  readonly bad: Rgb;
  /** The model in the printed look, or without a plan. */
  readonly resin: Rgb;
  /** Strength of the shadow, 0 to 1. */
  readonly shadow: number;
}

export interface SceneReports extends Omit<GizmoReports, "changed"> {
  /** Called when a frame has been drawn. */
  drawn(frame: Frame | null): void;
  /**
   * Positions at which heights belong; null: none, in perspective. Queried before every frame, since it depends on the page's layout: a
   * cached value would be wrong for at least a frame after a change of layout.
   */
  alignment(): Alignment | null;
}

export class Scene {
  readonly model = new Model();
  readonly cameras: Cameras;
  readonly plate: Plate;
  readonly copies: Copies;
  /** Markers of the points on the model. */
  readonly markers = new Markers();
  readonly #marker = new Marker();
  /** Outlines of other places. */
  readonly #places = new Marker(true);
  readonly #selection = new Selection();
  readonly #renderer: WebGLRenderer;
  readonly #scene = new ThreeScene();
  readonly #gizmo: Gizmo;
  readonly #picker = new Picker(this.model.cut);
  readonly #offscreen: Offscreen;
  readonly #face = new Mesh(
    new BufferGeometry(),
    new MeshBasicMaterial({
      side: DoubleSide,
      transparent: true,
      opacity: 0.75,
      polygonOffset: true,
      polygonOffsetFactor: -2,
      polygonOffsetUnits: -2,
    }),
  );
  readonly #reports: SceneReports;
  #isAligned = false;
  /** Size of the view, CSS pixels. */
  #size: readonly [number, number] = [0, 0];
  /** Size of the canvas, which follows that of the view once a picture of that size is ready. */
  #fitted: readonly [number, number] = [0, 0];
  #asked = 0;
  /** True until the browser has fetched the canvas's content, or the empty canvas. */
  #isUnfetched = true;
  /** True if something has changed since the start of the current offscreen picture. */
  #isStale = false;
  #isGone = false;
  #tool: Tool = "turn";
  #volume: BuildVolume | null = null;
  /** All copies on the plate; empty for a single model. */
  #copied: readonly Copy[] = [];
  #isColliding = false;
  /** Indices of the selected copies. */
  #chosen: readonly number[] = [];

  /** @param context WebGL context of the canvas, with alpha */
  constructor(
    canvas: HTMLCanvasElement,
    context: WebGL2RenderingContext,
    reports: SceneReports,
  ) {
    this.#renderer = new WebGLRenderer({ canvas, context });
    this.#renderer.setClearColor(0x000000, 0);
    this.#offscreen = new Offscreen(this.#renderer);
    this.#reports = reports;
    this.cameras = new Cameras(canvas);
    this.cameras.controls.addEventListener("change", this.invalidate);
    this.plate = new Plate(this.model.facets);
    this.copies = new Copies(this.model.material.uniforms, this.model.supports.material);
    this.#face.frustumCulled = false;
    this.model.facets.add(this.#face);
    this.model.stand.add(this.markers.group);
    this.#scene.add(this.model.stand, this.#marker.group, this.#places.group, this.copies.group, this.plate.group, this.#selection.group);
    this.#gizmo = new Gizmo(this.cameras.current, canvas, this.#scene, {
      ...reports,
      held: (on) => {
        this.cameras.controls.enabled = !on;
        reports.held(on);
      },
      changed: this.invalidate,
    });
    canvas.addEventListener("webglcontextrestored", this.#restored);
  }

  /** Requests a frame; requests before it is drawn are merged. */
  readonly invalidate = (): void => {
    if (this.#asked === 0 && !this.#isGone) this.#asked = requestAnimationFrame(this.#frame);
  };

  /** Returns true if a GPU draws; see `contextOf`. */
  get isSmooth(): boolean {
    return this.#renderer.getContext().getContextAttributes()?.antialias === true;
  }

  get isHot(): boolean {
    return this.#gizmo.isHot;
  }

  /** @param aside_px width of a strip at the right that other content covers */
  setSize(width_px: number, height_px: number, aside_px: number): void {
    if (width_px < 1 || height_px < 1) return;
    this.#size = [width_px, height_px];
    this.cameras.setView(width_px, height_px, aside_px);
    this.#gizmo.fit(this.cameras.width_px / height_px);
    this.drawNow();
  }

  /** Draws before the browser paints, if the layout has changed after the frame was drawn. */
  drawNow(): void {
    this.#draw();
  }

  /** Sets a new model and shows all of it. */
  setPositions(positions: Float32Array, rotation: Rotation, scale: number): void {
    this.model.setPositions(positions, rotation, scale);
    this.setFace(null);
    this.#fitPlate();
    // With several models, the camera already shows all of them.
    if (this.#copied.length === 0) this.cameras.reset(this.model.size_mm);
    this.invalidate();
  }

  /** Sets the copies on the plate; the model is the one at `selected`. Without copies, the model is alone in the middle. */
  setCopies(copies: readonly Copy[], selected: number | null): void {
    const count = this.#copied.length;
    this.#copied = copies;
    const own = copies.find(({ place }) => place === selected);
    this.model.stand.matrix.copy(own === undefined ? new Matrix4() : matrixOf(own));
    this.model.stand.visible = copies.length === 0 || own !== undefined;
    this.#isColliding = copies.some(({ isColliding }) => isColliding);
    this.model.facets.material = own?.isColliding === true ? this.copies.colliding : this.model.material;
    this.copies.set(copies, selected);
    this.#fitPlate();
    if (copies.length !== count) this.cameras.reset(this.#size_mm);
    this.setChosen(this.#chosen);
    this.#showHandles();
    this.invalidate();
  }

  /** Outlines the selected copies, by their indices. A single copy needs no outline. */
  setChosen(chosen: readonly number[]): void {
    this.#chosen = chosen;
    const copies = this.#copied.length < 2 ? [] : this.#copied.filter(({ place }) => chosen.includes(place));
    this.#selection.set(copies, ({ shape }) => this.copies.sizeOf(shape));
    this.invalidate();
  }

  /** Size of the model, or of everything on the plate. */
  get #size_mm(): Triple {
    return this.#copied.length === 0 ? this.model.size_mm : sizeOfAll(this.#copied, (shape) => this.copies.sizeOf(shape));
  }

  #fitPlate(): void {
    const isAlone = this.#copied.length === 0;
    this.plate.fit(isAlone ? this.model.size_mm : [0, 0, this.#size_mm[2]], this.#volume);
    this.plate.setPlated(!this.#isColliding, isAlone);
  }

  /** @param follow true if the camera follows the model's centre */
  setPose(rotation: Rotation, scale: number, follow: boolean): void {
    this.model.setPose(rotation, scale);
    this.#fitPlate();
    if (follow) this.cameras.follow(this.#size_mm);
    this.#showHandles();
    this.invalidate();
  }

  /** Cuts everything off above a height, mm; null: nothing. */
  setCut(cut_mm: number | null): void {
    this.model.setCut(cut_mm);
    this.copies.isCut = cut_mm !== null;
  }

  setVolume(volume: BuildVolume | null): void {
    this.#volume = volume;
    this.#fitPlate();
    this.invalidate();
  }

  setTheme({ ink, accent, bad, resin, shadow }: Theme): void {
    this.plate.setTheme(ink, bad, shadow);
    this.copies.setBad(bad);
    this.markers.setTheme(accent, bad);
    this.#selection.setTheme(accent);
    this.model.setResin(resin);
    this.#face.material.color.setRGB(accent[0] / 255, accent[1] / 255, accent[2] / 255, "srgb");
    this.invalidate();
  }

  /** Activates the camera required by the layout. */
  align(): Alignment | null {
    const alignment = this.#reports.alignment();
    const isAligned = alignment !== null;
    if (isAligned === this.#isAligned) return alignment;
    this.#isAligned = isAligned;
    this.cameras.setAligned(isAligned);
    this.plate.group.visible = !isAligned;
    this.#showHandles();
    return alignment;
  }

  setTool(tool: Tool): void {
    this.#tool = tool;
    if (tool !== "flat") this.setFace(null);
    this.markers.group.visible = places(tool);
    this.model.setSeeThrough(tool === "drains");
    this.#showHandles();
    this.invalidate();
  }

  /** Marks places and turns the first to the viewer. An empty list moves the camera back, unless the user has moved it since. */
  setMarks(marks: readonly Mark[], duration_ms: number): void {
    this.#marker.set(marks, this.model.size_mm);
    this.#paintMarks();
    const isAligned = this.align() !== null;
    const [first] = marks;
    if (first === undefined) this.cameras.withdraw(duration_ms);
    else this.cameras.face(middleOf(first), this.#marker.diagonal_mm, isAligned ? 0 : duration_ms);
    this.invalidate();
  }

  /** Outlines these places. */
  setPlaces(places: readonly Mark[]): void {
    this.#places.set(places, this.model.size_mm);
    this.#paintMarks();
    this.invalidate();
  }

  /** Paints the surface at all places; the chosen ones come first. */
  #paintMarks(): void {
    const boxes = [...this.#marker.painted, ...this.#places.painted];
    this.model.setMarked(boxes);
    this.copies.isMarked = boxes.length > 0;
  }

  /** Highlights these facets; null: none. */
  setFace(facets: readonly number[] | null): void {
    const { geometry } = this.#face;
    geometry.dispose();
    this.#face.visible = facets !== null;
    if (facets !== null) {
      const corners = new Float32Array(9 * facets.length);
      for (const [i, facet] of facets.entries()) {
        corners.set(this.model.positions.subarray(9 * facet, 9 * facet + 9), 9 * i);
      }
      this.#face.geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(corners, 3));
    }
    this.invalidate();
  }

  /** Facet and height under a point of the view, CSS pixels. */
  async pick(x_px: number, y_px: number): Promise<Hit | null> {
    this.cameras.current.updateMatrixWorld();
    return this.#picked(this.cameras.current, [x_px, y_px]);
  }

  /** Facet and height in the middle of the view from a viewpoint. */
  seenFrom(place: Viewpoint): Promise<Hit | null> {
    return this.#picked(this.cameras.tried(place), this.cameras.middle);
  }

  /** Ray through a point of the view, CSS pixels, in the file's pose. */
  rayAt(x_px: number, y_px: number): Ray {
    return this.inFile(this.worldRayAt(x_px, y_px));
  }

  /** Transforms a ray from the plate's frame to the file's pose. */
  inFile(ray: Ray): Ray {
    this.#scene.updateMatrixWorld();
    return ray.clone().applyMatrix4(this.model.facets.matrixWorld.clone().invert());
  }

  /** Ray through a point of the view, CSS pixels, in the plate's frame. */
  worldRayAt(x_px: number, y_px: number): Ray {
    const [width, height] = this.#size;
    this.#scene.updateMatrixWorld();
    this.cameras.current.updateMatrixWorld();
    const caster = new Raycaster();
    caster.setFromCamera(new Vector2((x_px / width) * 2 - 1, 1 - (y_px / height) * 2), this.cameras.current);
    return caster.ray;
  }

  /** Position of the right edge of the model's bounds at a height, CSS pixels, for a label. */
  edgeAt(z_mm: number): readonly [number, number] {
    const camera = this.cameras.current;
    const right = new Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
    const [x, y] = this.model.size_mm;
    const reach = 0.5 * (Math.abs(right.x) * x + Math.abs(right.y) * y);
    const middle = new Vector3().setFromMatrixPosition(this.model.stand.matrix);
    return this.cameras.project(middle.addScaledVector(right, reach).setZ(z_mm));
  }

  dispose(): void {
    this.#isGone = true;
    cancelAnimationFrame(this.#asked);
    this.#renderer.domElement.removeEventListener("webglcontextrestored", this.#restored);
    this.#gizmo.dispose();
    this.cameras.dispose();
    this.#picker.dispose();
    this.#offscreen.dispose();
    this.plate.dispose();
    this.copies.dispose();
    this.#marker.dispose();
    this.#places.dispose();
    this.markers.dispose();
    this.#selection.dispose();
    this.model.dispose();
    this.#face.geometry.dispose();
    this.#face.material.dispose();
    this.#renderer.dispose();
    // Browsers limit the contexts per page and reclaim them late.
    this.#renderer.forceContextLoss();
  }

  readonly #restored = (): void => {
    this.plate.restored();
    this.invalidate();
  };

  readonly #frame = (): void => {
    this.#asked = 0;
    const flying = this.cameras.advance(performance.now());
    // True while damping still moves the view after the pointer was released.
    const moving = this.cameras.controls.enabled && this.cameras.controls.update();
    this.#draw();
    if (flying || moving) this.invalidate();
  };

  readonly #fetched = (): void => {
    this.#isUnfetched = false;
    this.#frame();
  };

  async #picked(camera: PerspectiveCamera | OrthographicCamera, at: readonly [number, number]): Promise<Hit | null> {
    if (this.#isGone || this.#size[0] === 0 || this.#renderer.getContext().isContextLost()) return null;
    this.#scene.updateMatrixWorld();
    const hit = await this.#picker.pick(this.#renderer, camera, this.model.facets, at, this.#size).catch((error: unknown) => {
      // A context lost meanwhile does not answer.
      if (this.#renderer.getContext().isContextLost()) return null;
      throw error;
    });
    return this.#isGone ? null : hit;
  }

  #showHandles(): void {
    const middle = new Vector3().setFromMatrixPosition(this.model.stand.matrix).setZ(this.model.size_mm[2] / 2);
    this.#gizmo.show(this.#tool, this.model.pivot, middle, this.cameras.current);
  }

  #draw(): void {
    if (this.#size[0] === 0 || this.#renderer.getContext().isContextLost()) return;
    this.#isStale = this.#offscreen.isBusy;
    if (this.#isStale) return;
    const frame = this.cameras.prepare(this.align());
    this.markers.group.position.z = this.model.lift_mm;
    this.markers.prepare(this.#size[1], density());
    this.#scene.updateMatrixWorld();
    const size = this.#size;
    const isLarge = this.model.positions.length >= 9 * LARGE_FACETS;
    if (isLarge && this.#isUnfetched) {
      // An empty canvas takes its size at once, to receive the pointer.
      if (this.#fitted[0] === 0) this.#fit(size);
      // Otherwise the browser would wait for the picture, and the page with it.
      if (this.#asked === 0) this.#asked = requestAnimationFrame(() => (this.#asked = requestAnimationFrame(this.#fetched)));
      return;
    }
    this.plate.prepare(this.#renderer, this.model.facets);
    if (!isLarge) {
      this.#fit(size);
      this.#renderer.render(this.#scene, this.cameras.current);
      this.#isUnfetched = true;
      this.#reports.drawn(frame);
      return;
    }
    const free = (): void => {
      if (this.#isStale) this.invalidate();
    };
    const pixels = size.map((px) => Math.floor(px * density())) as unknown as readonly [number, number];
    const fit = (): void => this.#fit(size);
    this.#offscreen.draw(this.#scene, this.cameras.current, pixels, { fit, shown: () => this.#reports.drawn(frame), free });
  }

  /**
   * Sets the canvas to the size of the picture about to be shown. That clears it, so a picture must follow before the browser paints; until
   * then, the canvas keeps its old size, since a stretched picture would be wrong.
   */
  #fit(size: readonly [number, number]): void {
    const [width, height] = this.#fitted;
    const isSame = width === size[0] && height === size[1] && this.#renderer.getPixelRatio() === density();
    if (isSame) return;
    this.#fitted = size;
    this.#renderer.setPixelRatio(density());
    this.#renderer.setSize(...size);
  }
}

const density = (): number => Math.min(devicePixelRatio, DENSITY_LIMIT);
