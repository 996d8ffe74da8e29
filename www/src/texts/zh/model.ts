import type { ModelTexts } from "../en/model.js";

export const model = (): ModelTexts => ({
  open: {
    region: "打开模型",
    drop: "将模型拖放到此处",
    choose: "选择文件",
    another: "打开其他文件",
    opening: (name) => `正在打开 ${name}`,
    place: (place, total) => `第 ${place} 个模型，共 ${total} 个`,
    previous: "上一个模型",
    next: "下一个模型",
  },
  model: {
    region: "模型",
    size: "尺寸",
    sizeHelp: "宽 × 深 × 高",
    scaled: (from) => `由 ${from} 缩放`,
    facets: "三角面",
    surface: "表面",
    closed: "封闭",
    open: "不封闭",
  },
  progress: {
    load: "正在读取模型",
    saliency: "正在找出显眼之处",
    ldi: "正在扫描形状",
    profile: "正在测量表面",
    plan: "正在规划分层",
    masks: "正在绘制各层",
    inspect: "检查可打印性",
    orientation: "正在测量各方向",
    left: (seconds) => `约剩 ${seconds}`,
    cancel: "取消",
  },
  notices: {
    cancelled: "已取消。",
    exportCancelled: "下载已取消。",
    partFailed: "页面的这一部分无法加载。请检查网络连接后重试；如仍无效，请重新加载页面。",
    close: "关闭",
  },
});
