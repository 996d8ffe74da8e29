/** Input of the view for a plate: the copies of the session, with the shapes of their models. */
import { heightOf, UPRIGHT } from "../../view/scene/turn.js";
import type { Copy as Standing, Shape } from "../../view/scene/copies.js";
import type { Copy, Entry } from "../state/plate.js";

/** Source of the positions of models on a plate. */
export interface Shapes {
  positionsOf(entry: Entry): Promise<Float32Array>;
}

interface Shaped {
  readonly shape: Shape;
  readonly pose: string;
}

export class PlateView {
  readonly #draw: (standing: readonly Standing[]) => void;
  readonly #shapes = new WeakMap<Float32Array, Shaped>();
  #shows = 0;

  /** @param draw called with the copies once the positions of their models are known */
  constructor(draw: (standing: readonly Standing[]) => void) {
    this.#draw = draw;
  }

  show(copies: readonly Copy[], colliding: ReadonlySet<number>, source: Shapes | null): void {
    const show = ++this.#shows;
    if (copies.length === 0 || source === null) return this.#draw([]);
    const heights = new Map(copies.map(({ entry, height_mm }) => [entry, height_mm]));
    const shaping = [...heights].map(async ([entry, height_mm]) => {
      const positions = await source.positionsOf(entry);
      return [entry, this.#shapeOf(entry, positions, height_mm)] as const;
    });
    void Promise.all(shaping).then(
      (shaped) => {
        // A newer call draws instead.
        if (show !== this.#shows) return;
        const shapes = new Map(shaped);
        this.#draw(
          copies.map(({ entry, place, x_mm, y_mm, turn_deg, supports }) => {
            const shape = shapes.get(entry) as Shape;
            return { place, shape, x_mm, y_mm, turn_deg, isColliding: colliding.has(place), supports };
          }),
        );
      },
      // A broken worker is reported elsewhere.
      () => undefined,
    );
  }

  /** Shape of a model, cached while model and pose stay the same. */
  #shapeOf({ own }: Entry, positions: Float32Array, height_mm: number | null): Shape {
    const pose = JSON.stringify([own.rotation, height_mm]);
    const known = this.#shapes.get(positions);
    if (known?.pose === pose) return known.shape;
    const rotation = (own.rotation as Shape["rotation"] | undefined) ?? UPRIGHT;
    const own_mm = height_mm === null ? 0 : heightOf(positions, rotation);
    const shape = { positions, rotation, scale: own_mm > 0 && height_mm !== null ? height_mm / own_mm : 1 };
    this.#shapes.set(positions, { shape, pose });
    return shape;
  }
}
