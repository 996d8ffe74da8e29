import type { PlateTexts } from "../en/plate.js";

export const plate = (): PlateTexts => ({
  plate: {
    add: "添加模型",
    copies: "份数",
    copiesOf: (name) => `${name} 的份数`,
    fewer: "减少一份",
    more: "增加一份",
    arrange: "排列",
    title: "平台上的模型",
    remove: (name) => `移除 ${name}`,
    spacing: "间距（毫米）",
    turns: "转动",
    turnless: "不转动",
    step: (degrees) => `以 ${degrees}° 为步长`,
    plate: (number, count) => `第 ${number} 块平台，共 ${count} 块`,
    previous: "上一块平台",
    next: "下一块平台",
    each: (time, resin) => `每份 ${time}、${resin}`,
    whole: (time, resin) => `全部平台：${time}、${resin}`,
    all: "下载全部平台",
    others: (count) => `还有 ${count} 个。`,
    moved: "副本位于移动后的位置。",
  },
});
