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
  plate: {
    add: "添加模型",
    copies: "份数",
    copiesOf: (name) => `${name} 的份数`,
    fewer: "减少一份",
    more: "增加一份",
    arrange: "排列",
    quality: "质量曲线只针对单个模型。平台按设置中的公差规划。",
  },
};
