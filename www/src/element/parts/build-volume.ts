/** Build volume of a printer, as drawn in the view. */
import type { Printer } from "../../api/wire.js";
import type { BuildVolume } from "../../view/scene/plate.js";

const volumes = new WeakMap<object, BuildVolume>();

/** The build volume of a printer, cached per printer, since a new object would count as a change. */
export function volumeOf(printer: Pick<Printer, "volume_mm"> | null): BuildVolume | null {
  if (printer === null) return null;
  let volume = volumes.get(printer);
  if (volume === undefined) {
    const [width_mm, depth_mm, height_mm] = printer.volume_mm;
    volumes.set(printer, (volume = { width_mm, depth_mm, height_mm }));
  }
  return volume;
}
