/** Small pictures of one model in several poses, each on the plate and from where a model is first seen. */
import { Scene, WebGLRenderer } from "three";
import { lookFirst, perspective } from "./cameras.js";
import { Model } from "./model.js";
import { Plate } from "./plate.js";
import { UPRIGHT, type Rotation } from "./pose.js";
import { contextOf } from "./surface.js";
import { themeOf } from "./theme.js";

const frame = (): Promise<unknown> => new Promise((resolve) => requestAnimationFrame(resolve));

/**
 * Draws the model on each canvas in the rotation beside it, one a frame. One renderer serves all of them and is gone at
 * the end; where there is no WebGL canvases stay empty.
 *
 * @param positions nine numbers a facet, mm, in the file's pose
 * @param host whose text has the colour of the plate's lines
 */
export async function portray(
  positions: Float32Array,
  portraits: readonly (readonly [HTMLCanvasElement, Rotation])[],
  host: HTMLElement,
  signal: AbortSignal,
): Promise<void> {
  const canvas = document.createElement("canvas");
  const context = contextOf(canvas);
  if (context === null) return;
  const renderer = new WebGLRenderer({ canvas, context });
  renderer.setClearColor(0x000000, 0);
  const model = new Model();
  const plate = new Plate(model.facets);
  const scene = new Scene().add(model.pivot, plate.group);
  const camera = perspective();
  try {
    const theme = themeOf({ ink: host, accent: host, bad: host });
    plate.setTheme(theme.ink, theme.bad, theme.shadow);
    model.setResin(theme.resin);
    model.setLook("printed");
    model.setPositions(positions, UPRIGHT, 1);
    for (const [target, rotation] of portraits) {
      await frame();
      if (signal.aborted) return;
      model.setPose(rotation, 1);
      plate.fit(model.size_mm, null);
      renderer.setSize(target.width, target.height, false);
      camera.aspect = target.width / target.height;
      lookFirst(camera, model.size_mm);
      scene.updateMatrixWorld();
      plate.prepare(renderer, model.facets);
      renderer.render(scene, camera);
      const pen = target.getContext("2d");
      pen?.clearRect(0, 0, target.width, target.height);
      pen?.drawImage(canvas, 0, 0);
    }
  } finally {
    plate.dispose();
    model.dispose();
    renderer.dispose();
    // Browsers allow a page only so many contexts, and collect them late.
    renderer.forceContextLoss();
  }
}
