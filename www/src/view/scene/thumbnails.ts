/** Offscreen pictures of a model in its initial view: in several poses on the plate, or coloured by its layers. */
import { Scene, WebGLRenderer } from "three";
import { lookFirst, perspective } from "./cameras.js";
import { Model } from "./model.js";
import { Plate } from "./plate.js";
import { UPRIGHT, type Rotation } from "./pose.js";
import { contextOf } from "./surface.js";
import { themeOf } from "./theme.js";

const frame = (): Promise<unknown> => new Promise((resolve) => requestAnimationFrame(resolve));

/** Creates an offscreen scene for `draw` and disposes of it afterwards. Null without WebGL. */
async function withScene<T>(draw: (studio: Studio) => Promise<T>): Promise<T | null> {
  const canvas = document.createElement("canvas");
  const context = contextOf(canvas);
  if (context === null) return null;
  const renderer = new WebGLRenderer({ canvas, context });
  renderer.setClearColor(0x000000, 0);
  const model = new Model();
  const plate = new Plate(model.facets);
  const scene = new Scene().add(model.stand, plate.group);
  const camera = perspective();
  const shoot = (width_px: number, height_px: number): HTMLCanvasElement => {
    plate.fit(model.size_mm, null);
    renderer.setSize(width_px, height_px, false);
    camera.aspect = width_px / height_px;
    lookFirst(camera, model.size_mm);
    scene.updateMatrixWorld();
    plate.prepare(renderer, model.facets);
    renderer.render(scene, camera);
    return canvas;
  };
  try {
    return await draw({ model, plate, shoot });
  } finally {
    plate.dispose();
    model.dispose();
    renderer.dispose();
    // Browsers limit the contexts per page and reclaim them late.
    renderer.forceContextLoss();
  }
}

interface Studio {
  readonly model: Model;
  readonly plate: Plate;
  /** Draws the whole model in its pose; the next picture reuses the canvas. */
  shoot(width_px: number, height_px: number): HTMLCanvasElement;
}

/**
 * Draws the model on each canvas in its rotation, one per frame. Without WebGL, the canvases stay empty.
 *
 * @param positions nine numbers per facet, mm, in the file's pose
 * @param host element whose text colour is used for the plate's lines
 */
export async function drawThumbnails(
  positions: Float32Array,
  thumbnails: readonly (readonly [HTMLCanvasElement, Rotation])[],
  host: HTMLElement,
  signal: AbortSignal,
): Promise<void> {
  await withScene(async ({ model, plate, shoot }) => {
    const theme = themeOf({ ink: host, accent: host, bad: host });
    plate.setTheme(theme.ink, theme.bad, theme.shadow);
    model.setResin(theme.resin);
    model.setLook("printed");
    model.setPositions(positions, UPRIGHT, 1);
    for (const [target, rotation] of thumbnails) {
      await frame();
      if (signal.aborted) return;
      model.setPose(rotation, 1);
      const canvas = shoot(target.width, target.height);
      const pen = target.getContext("2d");
      pen?.clearRect(0, 0, target.width, target.height);
      pen?.drawImage(canvas, 0, 0);
    }
  });
}

/** A model and its layers. */
export interface Layered {
  /** Nine numbers per facet, mm, in the file's pose. */
  readonly positions: Float32Array;
  readonly rotation: Rotation;
  /** Factor applied to the file's lengths. */
  readonly scale: number;
  /** Layer boundaries from 0 to the top, mm. */
  readonly z_mm: readonly number[];
  /** Thicknesses at the ends of the colour scale, mm. */
  readonly limits: readonly [number, number];
}

/** Square PNG of a model coloured by layer thickness, on a transparent background; null without WebGL. */
export function thumbnail({ positions, rotation, scale, z_mm, limits }: Layered, size_px: number): Promise<Blob | null> {
  return withScene(({ model, plate, shoot }) => {
    plate.group.visible = false;
    model.setPositions(positions, rotation, scale);
    model.setPlan(z_mm);
    model.setLimits(limits);
    model.setLook("thickness");
    const canvas = shoot(size_px, size_px);
    return new Promise<Blob | null>((resolve) => canvas.toBlob(resolve, "image/png"));
  });
}
