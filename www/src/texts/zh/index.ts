import type { Format } from "../format.js";
import type { Texts } from "../index.js";
import { orientation } from "./orientation.js";
import { model } from "./model.js";
import { offers } from "./offers.js";
import { plan } from "./plan.js";
import { plate } from "./plate.js";
import { settings } from "./settings.js";
import { view } from "./view.js";
import { warnings } from "./warnings.js";

export const units = { hours: "小时", minutes: "分钟" };

export const zh = (format: Format): Texts => ({
  ...model(),
  ...settings(),
  ...plan(format),
  ...plate(),
  ...view(format),
  ...orientation(format),
  offers: offers(format),
  warnings: warnings(format),
});
