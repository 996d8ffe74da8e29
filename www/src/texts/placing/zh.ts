import type { PlacingTexts } from "./index.js";

export const placing: PlacingTexts = {
  points: {
    title: "支撑点",
    hint: "点击模型添加支撑点，拖动即可移动。",
    unreached: "无法到达",
    selected: (number, all, height) => `第 ${number} 个支撑点，共 ${all} 个，高度 ${height}`,
    none: "未选择支撑点",
    lockHint: "自动放置时，锁定的支撑点保持不变。",
  },
  drains: {
    title: "排液孔",
    hint: "点击模型添加排液孔，拖动即可移动。",
    unreached: "未通空腔",
    selected: (number, all, height) => `第 ${number} 个排液孔，共 ${all} 个，高度 ${height}`,
    none: "未选择排液孔",
    lockHint: "自动放置时，锁定的排液孔保持不变。",
  },
  automatic: "自动",
  byHand: "手动",
  diameter: "直径 (mm)",
  newDiameter: "新排液孔的直径 (mm)",
  lock: "锁定",
  remove: "删除",
  protect: "支撑点和排液孔避开涂为重要之处",
  protectHint: "对支撑点和排液孔均有效。请先用“重要之处”涂抹。",
  plugs: "下载塞子 (STL)",
  plugsHint: "用于封闭排液孔的销钉：打印后用树脂粘入。",
  automatically: "自动放置",
  clear: "全部清除",
};
