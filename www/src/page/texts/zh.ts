import type { PageWords } from "./index.js";

export const words: PageWords = {
  title: "Cusp：光固化打印的自适应分层",
  tagline: "表面需要处用薄层，不需要处用厚层。",
  private: "您的模型不会离开这台电脑。",
  drop: "松开即可打开",
  languages: "语言",
  noModel: "手边没有模型？",
  tryExample: "试试示例",
  printFile: "查看打印文件",
  example: "示例",
  recent: "最近的模型",
  saved: "预设",
  keys: "快捷键",
  notices: {
    part: "页面的这一部分无法加载，可能已被新版本替换。请重新加载页面。",
    reader: (name) => `打印文件读取器无法加载，因此 ${name} 未打开。请重新加载页面，然后再次打开该文件。`,
    notKept: (name) => `${name} 未保留到下次访问：此浏览器空间不足或不允许保存。`,
    reload: "重新加载",
    close: "关闭",
  },
  points: [
    ["层数最少", "在所有满足公差的方案中选取最短的一个。"],
    ["没有过高的台阶", "每一层都满足公差，而不是平均满足。"],
    ["可打印的文件", "适用于已知的打印机，或导出为带层厚的图像压缩包。"],
  ],
};
