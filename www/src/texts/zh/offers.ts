import type { OfferTexts } from "../en/offers.js";
import type { Format } from "../format.js";
import { UNITS } from "./nouns.js";

export const offers = (format: Format): OfferTexts => ({
  tolerance: (error) => `公差 ${error}`,
  layersFrom: (thickness) => `层厚从 ${thickness} 起`,
  rays: (count) => `${count} 条光线`,
  scale: (height) => `缩放到 ${height}`,
  uniform: (thickness) => `均匀层厚 ${thickness}`,
  bestUniform: (thickness, layers) => `均匀层厚 ${thickness}（${format.count(layers)} 层）`,
  images: "保存为图像",
  noPrinter: "不指定打印机",
  unit: (unit) => `单位是${UNITS[unit]}`,
  again: "再试一次",
});
