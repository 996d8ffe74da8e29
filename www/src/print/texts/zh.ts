import type { Format } from "../../texts/format.js";
import type { ErrorSentences, FaultSentences, FindingSentences, PrintWords } from "./index.js";

const KNOWN = "GOO、PRZ、未加密的 CTB、Anycubic 的文件、NanoDLP、SL1、UVJ 或蒙版 zip";

export const words = ({ count }: Format): PrintWords => ({
  region: "打印文件",
  back: "关闭",
  another: "打开其他文件",
  reading: (name) => `正在读取 ${name}`,
  cancel: "取消",
  whole: "文件完整：每一层都能读取，高度自平台逐层上升。",
  warnings: (number) => `${count(number)} 处需要注意`,
  facts: {
    format: "格式",
    software: "生成程序",
    printer: "打印机",
    plate: "成型空间",
    masks: "蒙版",
    layers: "层",
    height: "高度",
    exposure: "曝光",
    bottom: "底层",
    time: "打印时间",
    resin: "树脂",
  },
  pixels: (width, height, side) => `${width} × ${height} 像素，每像素 ${side}`,
  mirrored: "已镜像",
  thickness: (layers, range) => `${count(layers)} 层，${range}`,
  ignored: "打印机忽略各层自己的数值",
  range: (least, greatest) => `${least} 至 ${greatest}`,
  bottomOf: (layers, exposure) => `${count(layers)} 层，每层 ${exposure}`,
  stated: (stated, lit) => `文件所示 ${stated}，按蒙版计 ${lit}`,
  lit: (lit) => `按蒙版计 ${lit}`,
  preview: "文件中的预览图",
  layer: (layer, exposure, lit) => `第 ${count(layer)} 层：${[exposure, lit].filter((it) => it !== "").join("，")}`,
  exposed: (exposure) => `曝光 ${exposure}`,
  pixelsLit: (pixels) => `${count(pixels)} 个亮像素`,
  damaged: "无法读取这一层。",
  rough: "三维视图比实际打印粗糙。",
  noSurface: "这个打印文件细节过多，无法显示三维视图。",
});

export const faults = ({ count }: Format): FaultSentences => ({
  "missing-mask": ({ name }) => `缺少 ${name}`,
  "bad-mask": ({ name, system }) => `${name} 已损坏（${system}）`,
  "mask-size": ({ name, width, height, columns, rows }) => `${name} 为 ${width} × ${height} 像素，而设置要求 ${columns} × ${rows}`,
  "outside-file": ({ end_byte, file_bytes }) => `数据结束于第 ${count(end_byte)} 字节，而文件结束于第 ${count(file_bytes)} 字节`,
  "bad-run": ({ byte }) => `数据的第 ${count(byte)} 字节不是有效的像素段`,
  "too-few-pixels": ({ pixels, expected }) => `数据只覆盖 ${count(expected)} 个像素中的 ${count(pixels)} 个`,
  "too-many-pixels": ({ expected }) => `数据覆盖的像素超过 ${count(expected)} 个`,
  "wrong-checksum": ({ stated, computed }) => `校验和为 ${stated}，而数据的校验和为 ${computed}`,
});

export const findings = ({ count, mm, height }: Format): FindingSentences => ({
  "no-layers": () => "文件中没有任何层；请重新切片。",
  "bad-heights": ({ layers, first_layer }) =>
    `有 ${count(layers)} 层的高度不是数字，首先是第 ${count(first_layer)} 层；请重新导出文件。`,
  "bad-exposures": ({ layers, first_layer }) =>
    `有 ${count(layers)} 层的曝光不是数字，首先是第 ${count(first_layer)} 层；请检查曝光并重新导出文件。`,
  "bad-nominal-values": () => "统一的层厚或曝光不是数字；请检查设置并重新导出文件。",
  "first-layer-below-plate": ({ z_mm }) => `第一层的顶面位于 ${mm(z_mm)}，不在平台之上；请重新切片。`,
  "heights-not-ascending": ({ layers, first_layer, z_mm, below_mm }) =>
    `有 ${count(layers)} 层不高于下面一层，首先是第 ${count(first_layer)} 层：${mm(below_mm)} 之后为 ${mm(z_mm)}；请重新切片。`,
  "ignored-heights": ({ thinnest_mm, thickest_mm, layer_mm }) =>
    `层厚为 ${mm(thinnest_mm)} 至 ${mm(thickest_mm)}，但文件要求打印机忽略这些数值` +
    `${layer_mm === null ? "" : `，每层上升 ${mm(layer_mm)}`}；请导出带有逐层数值的文件，或使用统一层厚。`,
  "no-exposure": ({ layers, first_layer }) =>
    `有 ${count(layers)} 层没有曝光，首先是第 ${count(first_layer)} 层；请检查曝光并重新导出文件。`,
  "black-layers": ({ layers, first_layer, from_mm }) =>
    `有 ${count(layers)} 层全黑，首先是第 ${count(first_layer)} 层，自 ${height(from_mm)} 起：那里不会打印任何东西；请查看蒙版。`,
  "bad-layers": ({ layers, first_layer }, fault) =>
    `有 ${count(layers)} 层损坏，首先是第 ${count(first_layer)} 层：${fault}；请重新复制或导出文件。`,
  "missing-marks": ({ layers, first_layer }) =>
    `有 ${count(layers)} 层末尾缺少字节 0D 0A，首先是第 ${count(first_layer)} 层；请重新复制或导出文件。`,
  "missing-end": () => "文件没有正常结束；请重新复制，它可能不完整。",
  "bad-preview": ({ preview }) => `预览图 ${count(preview)} 已损坏；打印机屏幕可能显示杂色，但不影响打印。`,
});

export const errors = ({ count }: Format): ErrorSentences => ({
  "unknown-kind": () => `这不是可以读取的打印文件；请打开 ${KNOWN}。`,
  "damaged-zip": ({ system }) => `zip 已损坏（${system}）；请重新复制或导出。`,
  "unknown-zip": () => `这个 zip 中没有任何已知格式的设置，例如 run.gcode 或 manifest.json；请打开 ${KNOWN}。`,
  model: ({ has_layers }) =>
    has_layers
      ? "此 3MF 是带有分层、供丝材打印机切片软件使用的模型，没有掩膜；请在该软件中打开，或在此作为模型打开并为树脂打印机切片。"
      : "此 3MF 是模型，没有掩膜；请作为模型打开并切片。",
  "encrypted-ctb": () => "这个 CTB 文件已加密，没有厂商的密钥无法读取；请另存为未加密的 CTB、GOO 或蒙版 zip。",
  unread: ({ kind }) =>
    ({
      cbddlp: "这是早期 ChiTuBox 打印机的 cbddlp 或 photon 文件，无法读取；请另存为未加密的 CTB 或 GOO。",
      "planes-of-bits": "这个 Photon Workshop 文件按灰度分位平面存储，无法读取；请另存为 GOO 或蒙版 zip。",
      outlines: "这个 Anycubic zip 存储的是轮廓而不是蒙版，无法读取；请另存为 GOO 或蒙版 zip。",
    })[kind],
  "unknown-version": ({ version, known }) => `无法读取该格式的版本 ${version}；请另存为版本 ${known}。`,
  truncated: ({ needed_bytes, found_bytes }) =>
    `文件不完整：其设置需要 ${count(needed_bytes)} 字节，而文件只有 ${count(found_bytes)} 字节；请重新复制或导出。`,
  "too-many-layers": ({ layers, most }) => `文件声明有 ${count(layers)} 层，但最多只容得下 ${count(most)} 层；请重新复制或导出。`,
  "missing-file": ({ name }) => `zip 中缺少设置所需的 ${name}；请重新导出。`,
  "bad-file": ({ name, system }) => `无法读取 ${name}（${system}）；请重新导出文件。`,
  "too-large": ({ name, most_bytes }) => `${name} 解压后超过 ${count(most_bytes)} 字节；请重新导出文件。`,
  "bad-setting": ({ file, setting }) => `${file} 中的 ${setting} 无法读取；请重新导出文件。`,
  "too-many-pixels": ({ width, height, max_side }) => `蒙版为 ${count(width)} × ${count(height)} 像素，而每边最多 ${count(max_side)} 像素。`,
  layer: ({ layer }, fault) => `无法读取第 ${count(layer)} 层：${fault}；请重新导出文件。`,
  "file-unreadable": () => "无法读取文件。它是否已被移动或删除？请重新选择。",
  crash: ({ system }) => `读取意外中断（${system}）。请重试。`,
});
