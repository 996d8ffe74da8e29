import type { PaintingTexts } from "./index.js";

export const painting: PaintingTexts = {
  title: "重要之处",
  hint: "权重为 100% 处遵守公差；不太重要之处层可以更厚。在模型上涂抹；在模型旁拖动可转动视图。",
  brush: "画笔",
  modes: { less: "不太重要", more: "更重要", erase: "擦除", soften: "柔化" },
  size: "大小（mm）",
  strength: "强度",
  fills: "填充平滑区域",
  crease: "直到棱角达",
  mirrors: "左右对称",
  base: "未涂处权重",
  least: "最小权重",
  saliency: "显眼之处更重要",
  show: "显示",
  colours: { paint: "涂抹的权重", saliency: "显眼之处", product: "生效的权重", layers: "层厚" },
  finding: "正在找出显眼之处",
  undo: "撤销笔画",
  redo: "重做笔画",
  clear: "清空",
  save: "保存权重",
  open: "载入权重",
};
