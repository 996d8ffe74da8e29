/**
 * `<cusp-view>`: the model in 3-D, coloured by layer thickness, or as printed, with distances from the model.
 *
 * A pure function of its properties. It shows a rotation by the user at once, without waiting for a plan: a later plan only changes the
 * colours. Import this module lazily, since it loads three.js. The importer defines the element, since a bundler may drop a module's side
 * effects.
 */
import type { PropertyValues, TemplateResult } from "lit";
import { Approach } from "./scene/approach.js";
import { Beside } from "./scene/beside.js";
import type { Alignment, Frame } from "./scene/cameras.js";
import { Derived } from "./steps/derived.js";
import { isMeasured } from "./steps/distances.js";
import type { CopiesDetail, HeightDetail, MenuDetail, PaintDetail, PointDetail, RotateDetail, SizeDetail, ViewErrorDetail, ViewEvents } from "./events.js";
import { pressed } from "./scene/keys.js";
import { places } from "./scene/places.js";
import { legendStyles } from "./legend/legend.js";
import { wallLegendStyles } from "./legend/wall-legend.js";
import { Moving, type MoveDetail, type SelectDetail } from "./scene/moving.js";
import { Painting } from "./paint/painting.js";
import { Placing } from "./points/placing.js";
import { sharePage } from "./scene/page-gestures.js";
import { placeIn, watchPointer, type Point } from "./scene/pointer.js";
import { Pointing, type Shown } from "./scene/pointing.js";
import { layFlat, turned, type Rotation } from "./scene/pose.js";
import { Printed } from "./steps/printed.js";
import { Scene } from "./scene/scene.js";
import { contextOf, place } from "./scene/surface.js";
import { template } from "./template.js";
import { themeOf } from "./scene/theme.js";
import { FLIGHT_MS } from "./scene/viewpoint.js";
import { viewStyles } from "./view-styles.js";
import { elementWith } from "./properties.js";
import { PROPERTIES } from "./view-properties.js";
import { Measuring } from "./walls/measuring.js";
import { wallScale } from "./walls/scale.js";

export { CuspWallLegend } from "./legend/wall-legend.js";

// oxlint-disable-next-line typescript/no-unsafe-declaration-merging -- it only types listeners, which are the base's
export class CuspView extends elementWith(PROPERTIES) {
  #scene: Scene | null = null;
  #derived: Derived | null = null;
  #life = new AbortController();
  #frame: Frame | null = null;
  /** Camera rotation in the last `cusp-camera`. */
  #camera: Rotation | null = null;
  #isHeld = false;
  #approach: Approach | null = null;
  #beside: Beside | null = null;
  #pointing: Pointing | null = null;
  #painting: Painting | null = null;
  #moving: Moving | null = null;
  #placing: Placing | null = null;
  /** Current rotation while the rings are dragged. */
  #turned: Rotation | null = null;
  #unsaid: RotateDetail | null = null;
  readonly #printed = new Printed({
    building: (progress) => (this.building = progress),
    measuring: (progress) => (this.measuring = progress),
    steps: (steps) => {
      this.greatest_mm = isMeasured(steps) ? steps.greatest_mm : null;
      this.#scene?.model.setSteps(steps);
      this.#scene?.invalidate();
    },
  });
  readonly #measuring = new Measuring({
    progress: (progress) => (this.probing = progress),
    walls: (walls) => (this.walls = walls),
  });
  readonly #reducedMotion = matchMedia("(prefers-reduced-motion: reduce)");

  static override styles = [viewStyles, legendStyles, wallLegendStyles];

  override render(): TemplateResult {
    return template(this, {
      size_mm: this.#scene?.model.size_mm ?? [0, 0, 0],
      step_mm: this.#scene?.plate.step_mm ?? 1,
      layerWords: this.#layerWords(),
      keyed: this.#key,
      again: () => {
        this.#stop();
        this.#start();
      },
    });
  }

  override connectedCallback(): void {
    super.connectedCallback();
    if (this.hasUpdated) this.#start();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.#stop();
  }

  override firstUpdated(): void {
    this.#start();
  }

  /** Updates the scene before rendering, since the template shows the size that the scene computes. */
  override willUpdate(changed: PropertyValues<this>): void {
    // While the rings are dragged, only the pointer turns the model, not a late answer to an earlier `cusp-rotate`.
    if (this.#isHeld && this.#turned !== null) this.rotation = this.#turned;
    if (this.#scene !== null) this.#show(this.#scene, (name) => changed.has(name));
  }

  /** Returns to the initial view of the whole model. */
  reset(): void {
    this.#scene?.cameras.reset();
  }

  /** Undoes the last stroke of the brush. */
  undo(): void {
    this.#painting?.undo();
  }

  redo(): void {
    this.#painting?.redo();
  }

  #start(): void {
    const life = new AbortController();
    this.#life = life;
    const canvas = document.createElement("canvas");
    const holder = this.renderRoot.querySelector<HTMLElement>(".scene");
    const context = contextOf(canvas);
    if (holder === null || context === null) {
      // A lost context may come back; only a missing one is permanent.
      if (this.lost) return;
      this.broken = true;
      const { unavailable: message } = this.texts;
      this.#tell<ViewErrorDetail>("cusp-view-error", { code: "no-webgl", message });
      return;
    }
    this.lost = false;
    holder.prepend(canvas);
    canvas.addEventListener("webglcontextlost", () => (this.lost = true), { signal: life.signal });
    canvas.addEventListener("webglcontextrestored", () => (this.lost = false), { signal: life.signal });
    const scene = new Scene(
      canvas,
      context,
      {
        held: (on) => (this.#isHeld = on),
        turned: (rotation) => this.#rotate(rotation, false),
        done: (rotation) => this.#rotate(rotation, true),
        shifted: (x_mm, y_mm, isFinal) => this.#moving?.shift(x_mm, y_mm, isFinal),
        sized: (factor, final) => this.#size(factor, final),
        drawn: (frame) => this.#drawn(frame),
        alignment: () => this.#alignment(),
      },
    );
    this.#scene = scene;
    const pointing = new Pointing(scene, () => this.#shown(), {
      height: (detail) => this.#tell<HeightDetail>("cusp-height", detail),
      layer: (layer) => this.#tell<number>("cusp-layer", layer),
      lay: (normal) => this.#rotate(layFlat(this.rotation, normal), true),
    });
    this.#pointing = pointing;
    const painting = new Painting(scene, {
      changed: (facets) => this.#heat(facets),
      painted: (detail) => this.#tell<PaintDetail>("cusp-paint", detail),
    });
    this.#painting = painting;
    const hovered = (at: Point | null): void => {
      painting.hover(at);
      void pointing.hovered(at);
    };
    const placing = new Placing(scene, (detail) => this.#tell<PointDetail>("cusp-point", detail));
    this.#placing = placing;
    placing.watch(holder, (event) => placeIn(canvas, event), life.signal);
    watchPointer(canvas, { clicked: this.#clicked, menu: this.#menu, hovered }, life.signal);
    const moving = new Moving(scene, {
      selected: (detail) => this.#tell<SelectDetail>("cusp-select", detail),
      moved: (detail) => this.#tell<MoveDetail>("cusp-move", detail),
    });
    this.#moving = moving;
    moving.watch(holder, (event) => placeIn(canvas, event), life.signal);
    painting.watch(holder, (event) => placeIn(canvas, event), life.signal);
    sharePage(holder, () => this.shadowRoot?.activeElement === holder, life.signal);
    // When it starts, a transition may still have the old colour.
    for (const type of ["transitionrun", "transitionend"]) this.renderRoot.addEventListener(type, this.#recolour, { signal: life.signal });
    this.#reducedMotion.addEventListener("change", this.#damp, { signal: life.signal });
    const resize = (): void => scene.setSize(holder.clientWidth, holder.clientHeight, parseFloat(getComputedStyle(holder).paddingInlineEnd));
    this.#beside = new Beside(holder, resize, life.signal);
    this.#approach = new Approach(scene);
    this.#damp();
    this.#recolour();
    this.#show(scene, () => true);
    resize();
    // The view was rendered before the size and the grid were known.
    this.requestUpdate();
  }

  #stop(): void {
    this.#life.abort();
    this.#printed.want(null, false);
    this.#measuring.forget();
    this.#derived?.dispose();
    this.#derived = null;
    this.#approach?.dispose();
    this.#approach = this.#beside = null;
    this.#scene?.dispose();
    this.#scene = null;
    this.#pointing = null;
    this.#painting = this.#moving = this.#placing = null;
    this.renderRoot.querySelector("canvas")?.remove();
    this.#frame = null;
    this.#isHeld = false;
    this.#turned = null;
  }

  /** Applies the changed properties to the scene. */
  #show(scene: Scene, has: (name: keyof CuspView) => boolean): void {
    const { model } = scene;
    if (has("plate")) scene.setVolume(this.plate);
    if (has("lift_mm")) model.lift_mm = scene.copies.lift_mm = this.lift_mm;
    if (has("supports") || has("rotation")) model.setSupports(has("supports") ? this.supports : null);
    if (has("voids") || has("rotation")) model.setVoids(has("voids") ? this.voids : null);
    if (has("positions")) {
      this.#measuring.forget();
      this.#derived?.dispose();
      this.#derived = this.positions === null ? null : new Derived(this.positions);
      scene.setPositions(this.positions ?? new Float32Array(0), this.rotation, this.scale);
    } else if (has("rotation") || has("scale") || has("lift_mm")) scene.setPose(this.rotation, this.scale, !this.#isHeld);
    if (has("copies") || has("selected")) scene.setCopies(this.copies, this.selected);
    if (this.#moving !== null) {
      this.#moving.isOn = this.tool === "move";
      this.#moving.copies = this.copies;
      this.#moving.chosen = this.chosen;
    }
    if (has("chosen")) scene.setChosen(this.chosen);
    if (has("points") || has("point")) scene.markers.set(this.points, this.point);
    if (this.#placing !== null) {
      this.#placing.isOn = places(this.tool);
      this.#placing.selected = this.point;
      this.#placing.prepare(this.#derived, this.supports);
    }
    if (has("z_mm")) model.setPlan(this.z_mm);
    if (has("limits")) model.setLimits(this.limits);
    if (has("look")) model.setLook(this.look);
    if (has("look") || has("positions")) this.#measuring.want(this.look === "walls" ? this.#derived : null);
    if (has("walls")) model.setWalls(this.walls);
    model.wallColours.setScale(wallScale(this.wall_mm), this.scale);
    if (has("layer") || has("z_mm") || has("cuts")) {
      const band = this.#band();
      model.setBand(band);
      scene.setCut(this.cuts && band !== null ? band[1] : null);
    }
    if (has("plot") && this.#beside !== null) this.#beside.plot = this.plot;
    if (has("tool")) scene.setTool(this.tool);
    if ((has("tool") || has("positions")) && this.tool !== "turn") void this.#prepare();
    if (has("tool") || has("positions")) this.#painting?.prepare(this.#derived, this.tool === "paint");
    if (this.#painting !== null) {
      this.#painting.brush = this.brush;
      if (has("weights")) this.#painting.weights = this.weights;
    }
    if ((["positions", "look", "heat", "saliency", "least"] as const).some(has)) this.#heat(null);
    if ((["positions", "rotation", "scale", "lift_mm", "z_mm", "look"] as const).some(has)) this.#print();
    if (has("places")) scene.setPlaces(this.places);
    if (has("marks") && (this.marks.length > 0 || this.hasUpdated)) scene.setMarks(this.marks, this.#flight_ms);
    this.#near();
    scene.invalidate();
  }

  /** Duration of camera flights, ms; 0 on slow renderers, where a flight would be a few jumps. */
  get #flight_ms(): number {
    return this.#scene?.isSmooth === true && !this.#reducedMotion.matches ? FLIGHT_MS : 0;
  }

  #near(): void {
    const { near, aligned, positions, z_mm } = this;
    const isCalm = this.#reducedMotion.matches;
    // At once if aligned: that view has another camera, so the flight would be invisible.
    if (!near) this.#approach?.leave(isCalm || aligned);
    else if (!aligned && positions !== null && z_mm.length >= 2) this.#approach?.go({ positions, z_mm }, isCalm);
  }

  #alignment(): Alignment | null {
    const beside = this.#beside?.inset;
    const isBeside = beside === undefined ? null : beside !== null;
    if (isBeside !== this.isBeside) {
      this.isBeside = isBeside;
      this.#tell<boolean>("cusp-beside", isBeside === true);
    }
    const inset = beside === undefined ? this.inset : beside;
    return this.aligned && inset !== null ? { heights_mm: this.heights_mm, inset } : null;
  }

  /** Finds the distinct points before the first turn, which they speed up. */
  async #prepare(): Promise<void> {
    const derived = this.#derived;
    const points = await derived?.points();
    if (points != null && derived === this.#derived) this.#scene?.model.setPoints(points);
  }

  /** Updates the heat map of these facets; null: of all facets. */
  #heat(facets: Iterable<number> | null): void {
    if (this.#scene === null || this.look !== "weights") return;
    const { heat, saliency, least } = this;
    const weights = this.#painting?.weights ?? null;
    this.#scene.model.setHeat({ heat, weights, saliency, least }, facets);
    this.#scene.invalidate();
  }

  #shown(): Shown {
    const { tool, z_mm } = this;
    const derived = this.#derived;
    return {
      tool,
      z_mm,
      face: async (facet) => {
        const face = (await derived?.face(facet)) ?? null;
        return derived === this.#derived ? face : null;
      },
    };
  }

  #band(): readonly [number, number] | null {
    if (this.layer === null) return null;
    const [bottom, top] = [this.z_mm[this.layer], this.z_mm[this.layer + 1]];
    return bottom === undefined || top === undefined ? null : [bottom, top];
  }

  #layerWords(): string {
    const { layer } = this;
    const band = this.#band();
    if (layer === null || band === null) return "";
    return this.texts.layer(layer, band[0], this.thickness_mm[layer] ?? band[1] - band[0]);
  }

  /** Requests new stair steps if the look needs them, except while the model is being turned. */
  #print(): void {
    const { rotation, scale, z_mm, look } = this;
    const derived = this.#derived;
    const measures = look === "distance";
    const isWanted = (look === "printed" || measures) && z_mm.length >= 2 && !this.#isHeld;
    // Steps are computed on the plate, and then lifted with the model.
    const own_mm = this.lift_mm === 0 ? z_mm : z_mm.map((z) => z - this.lift_mm);
    this.#printed.want(derived !== null && isWanted ? { derived, rotation, scale, z_mm: own_mm } : null, measures);
  }

  #rotate(rotation: Rotation, final: boolean): void {
    this.rotation = rotation;
    this.#turned = final ? null : rotation;
    if (final) {
      this.#unsaid = null;
      this.#tell<RotateDetail>("cusp-rotate", { rotation, final });
      return;
    }
    if (this.#unsaid === null) {
      requestAnimationFrame(() => {
        if (this.#unsaid !== null) this.#tell("cusp-rotate", this.#unsaid);
        this.#unsaid = null;
      });
    }
    this.#unsaid = { rotation, final };
  }

  #size(factor: number, final: boolean): void {
    this.#scene?.setPose(this.rotation, this.scale * factor, false);
    this.#tell<SizeDetail>("cusp-size", { factor, final });
  }

  readonly #clicked = (at: Point, isMore = false): void => {
    if (places(this.tool)) return this.#placing?.clicked(at);
    if (this.tool !== "flat" && this.#scene?.isHot === false && this.#moving?.choose(at, isMore) === true) return;
    void this.#pointing?.clicked(at);
  };

  readonly #menu = (at: Point): void => {
    this.#tell<MenuDetail>("cusp-menu", { at, place: this.#moving?.at(at) ?? null });
  };

  readonly #key = (event: KeyboardEvent): void => {
    if (event.key === "Escape" && this.#placing?.cancel() === true) {
      // Escape ends the drag only, not a task or the choice of a finding.
      event.stopPropagation();
      return;
    }
    const action = pressed(event, this.tool);
    if (action === null || this.#scene === null) return;
    event.preventDefault();
    const { cameras } = this.#scene;
    if (action.do === "turn-view") cameras.turn(action.right_deg, action.up_deg);
    else if (action.do === "zoom") cameras.zoom(action.factor);
    else if (action.do === "reset") cameras.reset();
    else if (action.do === "move-copy") this.#moving?.step(action.x_mm, action.y_mm, action.turn_deg);
    else if (action.do === "size-model") this.#size(action.factor, true);
    else if (action.do === "menu") this.#menu(cameras.middle);
    else if (action.do === "duplicate") this.#tell<CopiesDetail>("cusp-copies", "duplicate");
    else if (action.do === "remove-copies") this.#tell<CopiesDetail>("cusp-copies", "remove");
    else if (action.do === "next-point") this.#placing?.step(action.by, this.#flight_ms);
    else if (action.do === "remove-point") this.#placing?.edit("remove");
    else if (action.do === "lock-point") this.#placing?.edit("lock");
    else if (action.do === "turn-model") this.#rotate(turned(this.rotation, action.axis, action.degrees), true);
    else if (action.do === "undo-stroke" || action.do === "redo-stroke") {
      // Keeps the page's own undo from reacting.
      event.stopPropagation();
      if (action.do === "undo-stroke") this.undo();
      else this.redo();
    } else if (this.tool === "paint") void this.#painting?.stamp(cameras.middle);
    else this.#clicked(cameras.middle);
  };

  /** Disables damping on slow renderers, where it would last for seconds. */
  readonly #damp = (): void => {
    this.#scene?.cameras.setDamping(this.#scene.isSmooth && !this.#reducedMotion.matches);
  };

  readonly #recolour = (): void => {
    const probe = (name: string): HTMLElement => {
      const found = this.renderRoot.querySelector<HTMLElement>(`.probe.${name}`);
      if (found === null) throw new Error(`the view has no probe of ${name}`);
      return found;
    };
    this.#scene?.setTheme(themeOf({ ink: probe("ink"), accent: probe("accent"), bad: probe("bad") }));
  };

  /** Updates everything that depends on the frame: the layer's label, and the events on camera and heights. */
  #drawn(frame: Frame | null): void {
    const label = this.renderRoot.querySelector<HTMLElement>(".label");
    const band = this.positions === null ? null : this.#band();
    if (label !== null && this.#scene !== null) {
      place(label, band === null ? null : this.#scene.edgeAt((band[0] + band[1]) / 2), this.#scene.cameras.width_px);
    }
    this.#tellCamera();
    if (frame?.top_px === this.#frame?.top_px && frame?.bottom_px === this.#frame?.bottom_px) return;
    this.#frame = frame;
    this.#tell<Frame | null>("cusp-frame", frame);
  }

  #tellCamera(): void {
    const camera = this.#scene?.cameras.turned ?? null;
    if (camera === null || String(camera) === String(this.#camera)) return;
    this.#camera = camera;
    this.#tell<Rotation>("cusp-camera", camera);
  }

  #tell<Detail>(name: string, detail: Detail): void {
    this.dispatchEvent(new CustomEvent<Detail>(name, { detail }));
  }
}

/** Typed listeners for the view's own events. */
export interface CuspView {
  addEventListener<Type extends keyof ViewEvents>(
    type: Type,
    listener: (this: CuspView, event: ViewEvents[Type]) => void,
    options?: boolean | AddEventListenerOptions,
  ): void;
  addEventListener(
    type: string,
    listener: EventListenerOrEventListenerObject,
    options?: boolean | AddEventListenerOptions,
  ): void;
}

declare global {
  interface HTMLElementTagNameMap {
    "cusp-view": CuspView;
  }
}
