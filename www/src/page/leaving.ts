/** The browser's question before the page is left: only while something made by hand would be lost with it. */
import type { Handwork, SlicerElement } from "../element/slicer-element.js";
import { fromAddress } from "../element/state/settings.js";

/** What `askBeforeLeaving` uses of the element. */
type Worked = Pick<SlicerElement, "handwork" | "plates" | "addEventListener">;

/** After any of these something may be lost, or nothing any more. */
const EVENTS = ["cusp-load", "cusp-change", "cusp-paint", "cusp-plan", "cusp-export"] as const;

/** @param asked the settings of the address, which may have points already */
export function askBeforeLeaving(element: Worked, asked: string): void {
  const link = fromAddress(asked);
  const isWork = ({ isPainted, points, drains, models }: Handwork): boolean =>
    isPainted || models > 1 || (points !== "" && points !== link.points) || (drains !== "" && drains !== link.drains);
  const plan = (): unknown => element.plates?.plates[0]?.report;
  let saved: unknown = null;
  const ask = (event: Event): void => event.preventDefault();
  for (const name of EVENTS) {
    element.addEventListener(name, () => {
      if (name === "cusp-export") saved = plan();
      // A page that always asks is not kept when somebody goes back to it.
      if (isWork(element.handwork()) && plan() !== saved) window.addEventListener("beforeunload", ask);
      else window.removeEventListener("beforeunload", ask);
    });
  }
}
