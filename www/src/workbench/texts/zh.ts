/** Chinese. */
import type { WorkbenchWords } from "./index.js";

export const words: WorkbenchWords = {
  choices: "选择",
  answers: "结果",
  mask: "掩膜",
  result: "结果",
  more: "显示结果",
  layer: "视图中的层",
  exposure: (seconds, thickness) => `${thickness} 曝光 ${seconds}`,
};
