/** `<cusp-figure>`: a turning vase in layers of varying thickness, drawn on a plain canvas before there is a 3-D view. */
import { css, ofThickness } from "../view/legend/palette.js";

const HEIGHT_MM = 40;
const WIDEST_MM = 13.5;
/** Layer thickness, mm: coarser than any print, so that each layer can be seen. */
const LIMITS_MM = [0.35, 1.5] as const;
/** Largest step on the surface, mm. */
const STEP_MM = 0.3;
/** Height of a level circle over its width: the view is from slightly above. */
const TILT = 0.28;
const FLUTES = 9;
/** Points of an outline. */
const AROUND = 90;
const TURN_S = 24;
const FRAME_MS = 50;
/** Brightness at the sides and in the hollow. */
const SHADE = 0.68;
const WALL_MM = 1.3;

interface Layer {
  readonly bottom_mm: number;
  readonly top_mm: number;
  readonly colour: string;
  readonly shade: string;
}

/** Mean radius at a height. */
const radiusAt = (z_mm: number): number => 9 + 3.6 * Math.sin(0.19 * z_mm - 0.9) + 0.0006 * z_mm * z_mm;

/** Layers from the plate upwards, each as thick as the slope allows. */
function layersOf(): Layer[] {
  const layers: Layer[] = [];
  const [least, most] = LIMITS_MM;
  for (let z = 0; z < HEIGHT_MM; ) {
    const slope = Math.abs(radiusAt(z + 0.1) - radiusAt(z)) / 0.1;
    const thickness = Math.min(most, Math.max(least, (STEP_MM * Math.hypot(1, slope)) / Math.max(slope, 0.01)));
    const rgb = ofThickness(thickness, LIMITS_MM);
    const top_mm = Math.min(HEIGHT_MM, z + thickness);
    layers.push({ bottom_mm: z, top_mm, colour: css(rgb), shade: css([rgb[0] * SHADE, rgb[1] * SHADE, rgb[2] * SHADE]) });
    z = top_mm;
  }
  return layers;
}

class CuspFigure extends HTMLElement {
  readonly #canvas = document.createElement("canvas");
  readonly #layers = layersOf();
  readonly #resized = new ResizeObserver(() => this.#draw());
  #timer: ReturnType<typeof setInterval> | undefined;
  #turned_ms = 0;

  connectedCallback(): void {
    this.replaceChildren(this.#canvas);
    this.#resized.observe(this);
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) return;
    this.#timer = setInterval(() => {
      if (document.hidden || this.clientWidth === 0) return;
      this.#turned_ms += FRAME_MS;
      this.#draw();
    }, FRAME_MS);
  }

  disconnectedCallback(): void {
    clearInterval(this.#timer);
    this.#resized.disconnect();
  }

  #draw(): void {
    const density = Math.min(2, devicePixelRatio);
    const [width, height] = [Math.floor(density * this.clientWidth), Math.floor(density * this.clientHeight)];
    const pen = this.#canvas.getContext("2d");
    if (pen === null || width === 0 || height === 0) return;
    if (this.#canvas.width !== width || this.#canvas.height !== height) Object.assign(this.#canvas, { width, height });
    pen.clearRect(0, 0, width, height);
    pen.lineWidth = density;
    const scale = Math.min(height / (HEIGHT_MM + 2 * WIDEST_MM * TILT), width / (2 * WIDEST_MM));
    const [middle, bottom] = [width / 2, (height + scale * HEIGHT_MM) / 2];
    const turn = (this.#turned_ms / (1000 * TURN_S)) * 2 * Math.PI;
    /** Adds part of the outline of the solid at `z_mm` to the path, at the height `at_mm`; angles from 0 to half a turn are its front. */
    const outline = (z_mm: number, at_mm: number, from: number, to: number, inward_mm = 0): void => {
      const steps = Math.round((AROUND * Math.abs(to - from)) / (2 * Math.PI));
      for (let i = 0; i <= steps; i++) {
        const angle = from + ((to - from) * i) / steps;
        const flute = 1 + 0.05 * Math.cos(FLUTES * (angle + turn - 0.035 * z_mm));
        const r = scale * (radiusAt(z_mm) * flute - inward_mm);
        pen.lineTo(middle + r * Math.cos(angle), bottom - scale * at_mm + TILT * r * Math.sin(angle));
      }
    };
    for (const { bottom_mm, top_mm, colour, shade } of this.#layers) {
      const z = (bottom_mm + top_mm) / 2;
      const half = scale * radiusAt(z);
      const across = pen.createLinearGradient(middle - half, 0, middle + half, 0);
      for (const [place, at] of [[0, shade], [0.35, colour], [1, shade]] as const) across.addColorStop(place, at);
      pen.beginPath();
      outline(z, bottom_mm, 0, Math.PI);
      outline(z, top_mm, Math.PI, 0);
      pen.fillStyle = across;
      pen.fill();
      pen.beginPath();
      outline(z, top_mm, 0, 2 * Math.PI);
      pen.fillStyle = colour;
      pen.fill();
      pen.strokeStyle = shade;
      pen.stroke();
    }
    pen.beginPath();
    outline(HEIGHT_MM, HEIGHT_MM, 0, 2 * Math.PI, WALL_MM);
    pen.fillStyle = this.#layers.at(-1)?.shade ?? "";
    pen.fill();
  }
}

customElements.define("cusp-figure", CuspFigure);
