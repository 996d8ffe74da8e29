/** Chinese. */
import type { WorkbenchWords } from "./index.js";

export const words: WorkbenchWords = {
  choices: "查看结果",
  answers: "结果",
  mask: "掩膜",
  result: "结果",
  more: "显示结果",
  layer: "视图中的层",
  exposure: (seconds, thickness) => `${thickness} 曝光 ${seconds}`,
  path: "步骤",
  steps: { turn: "旋转", check: "检查", hollow: "抽壳", support: "支撑", slice: "切片" },
  hints: {
    turn: "模型的摆放决定哪里需要支撑，以及打印多久。",
    check: "打印时可能失败的地方。",
    hollow: "空心模型更省树脂，对离型膜的拉力也更小。",
    support: "从空中开始或大幅外伸之处需要支撑。",
    slice: "选择打印机和树脂。",
  },
  back: "上一步",
  next: (step) => `下一步：${step}`,
  byHand: { rotate: "手动旋转", drains: "手动放置排液孔", supports: "手动放置支撑点" },
  filament: "线材打印机的切片软件会自行处理。",
  states: {
    asFile: "与文件相同",
    turned: "已旋转",
    unchecked: "未检查",
    verdicts: { ok: "未发现问题", review: "值得一看", reject: "会失败" },
    solid: "实心",
    walls: (thickness) => `壁厚 ${thickness}`,
    supports: (strength, points, { count }) => `${strength}，${count(points)} 个点`,
    missing: (points, { count }) => `${count(points)} 个点没有支撑`,
    wrong: "需要更正",
  },
};
