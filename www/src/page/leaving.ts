/** Asks before the user leaves the page, but only if handmade edits would be lost: not where this browser keeps them. */
import type { Handwork, SlicerElement } from "../element/slicer-element.js";
import { fromAddress } from "../element/state/settings.js";

/** The part of the element used by `askBeforeLeaving`. */
type Worked = Pick<SlicerElement, "handwork" | "plates" | "addEventListener">;

/** Events that may change whether there are edits to lose. */
const EVENTS = ["cusp-load", "cusp-change", "cusp-paint", "cusp-plan", "cusp-export"] as const;

/**
 * @param asked settings of the URL, which may already contain points
 * @param isKept returns true if this browser has kept the edits
 */
export function askBeforeLeaving(element: Worked, asked: string, isKept: () => boolean): void {
  const link = fromAddress(asked);
  const isWork = ({ isPainted, points, drains, models }: Handwork): boolean =>
    isPainted || models > 1 || (points !== "" && points !== link.points) || (drains !== "" && drains !== link.drains);
  const plan = (): unknown => element.plates?.plates[0]?.report;
  let saved: unknown = null;
  const ask = (event: Event): void => {
    if (!isKept()) event.preventDefault();
  };
  for (const name of EVENTS) {
    element.addEventListener(name, () => {
      if (name === "cusp-export") saved = plan();
      // Browsers do not cache a page that always asks, so the listener is removed when not needed.
      if (isWork(element.handwork()) && plan() !== saved) window.addEventListener("beforeunload", ask);
      else window.removeEventListener("beforeunload", ask);
    });
  }
}
