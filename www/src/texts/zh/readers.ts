import type { ThreeMfFeature, XmlFault } from "../../api/wire.js";
import type { Format } from "../format.js";
import type { ErrorSentences } from "../sentences.js";

const XML: Readonly<Record<XmlFault, string>> = {
  "cut-short": "文件在元素结束之前中断",
  "not-xml": "不是 UTF-8 编码的 XML",
  "wrong-end-tag": "结束标签与开始标签不符",
  attribute: "属性不是名称加引号中的值",
  "long-tag": "标签过长",
  deep: "元素嵌套过多",
  doctype: "含有 3MF 禁止的文档类型",
};

const FEATURES: Readonly<Record<ThreeMfFeature, string>> = {
  "beam-lattice": "杆件晶格",
  slices: "切片",
  displacement: "位移三角面",
  booleans: "布尔运算",
  volumetric: "体数据",
};

export const readers = ({ count }: Pick<Format, "count">) =>
  ({
    "threemf-no-directory": () => "3MF 文件已损坏或不完整：缺少目录；请重新复制或导出。",
    "threemf-no-part": ({ part }) => `3MF 文件缺少部件 ${part}；请重新导出模型。`,
    "threemf-damaged-part": ({ part }) => `3MF 文件的部件 ${part} 已损坏；请重新复制或导出。`,
    "threemf-packed": ({ part, method }) =>
      `3MF 文件的部件 ${part} 以方法 ${count(method)} 压缩，或已加密；3MF 只用 0 和 8；请重新导出模型。`,
    "threemf-too-large": ({ part, most_bytes }) =>
      `3MF 文件的部件 ${part} 解压后超过 ${count(most_bytes)} 字节，与其大小不符；请重新导出模型。`,
    "threemf-xml": ({ part, line, fault }) => `${part} 第 ${count(line)} 行：${XML[fault]}；请重新导出模型。`,
    "threemf-bad-attribute": ({ part, line, attribute, found }) =>
      `${part} 第 ${count(line)} 行：\`${found}\` 不能作为 ${attribute} 的值；请重新导出模型。`,
    "threemf-no-vertex": ({ part, line, vertex, vertices }) =>
      `${part} 第 ${count(line)} 行：没有顶点 ${count(vertex)}：网格从 0 起有 ${count(vertices)} 个；请重新导出模型。`,
    "threemf-no-object": ({ part, line, object }) =>
      `${part} 第 ${count(line)} 行：没有对象 ${count(object)}；请重新导出模型。`,
    "threemf-nested": ({ part, line, object, most_levels }) =>
      `${part} 第 ${count(line)} 行：对象 ${count(object)} 嵌套超过 ${count(most_levels)} 层，或包含自身；请重新导出模型。`,
    "threemf-too-many": ({ most_facets }) =>
      `3MF 文件的对象相互重复，超过 ${count(most_facets)} 个三角面；请减少份数。`,
    "threemf-overflow": ({ part, object }) => `${part}：对象 ${count(object)} 的坐标过大，无法计算；请重新导出模型。`,
    "threemf-feature": ({ part, object, feature }) =>
      `${part}：对象 ${count(object)} 由${FEATURES[feature]}构成，Cusp 无法读取；请将模型导出为网格。`,
    "threemf-encrypted": ({ part }) => `${part}：模型已加密；请不加密导出。`,
    "threemf-extension": ({ part, extension }) =>
      `${part}：模型需要扩展 ${extension}，Cusp 不认识；请不用该扩展导出。`,
    "threemf-no-facets": ({ skipped }) =>
      `3MF 文件没有可打印的三角面：其中 ${count(skipped)} 个对象是支撑、曲面或不打印；请重新导出模型。`,
    "obj-bad-vertex": ({ line, found }) =>
      `第 ${count(line)} 行：顶点需要三个有限的数，此处为 \`${found}\`；请重新导出模型。`,
    "obj-bad-corner": ({ line, found, vertices }) =>
      `第 ${count(line)} 行：\`${found}\` 不是顶点编号：文件有 ${count(vertices)} 个；请重新导出模型。`,
    "obj-few-corners": ({ line, corners }) =>
      `第 ${count(line)} 行：面至少需要三个角，此处有 ${count(corners)} 个；请重新导出模型。`,
    "obj-free-form": ({ line, keyword }) =>
      `第 ${count(line)} 行：\`${keyword}\` 是没有三角面的自由曲面；请将模型导出为多边形。`,
    "obj-too-many": ({ line, most_facets }) =>
      `第 ${count(line)} 行：这些面共有超过 ${count(most_facets)} 个三角面，与文件大小不符；请重新导出模型。`,
    "obj-no-faces": () => "OBJ 中没有面；请重新导出模型。",
  }) satisfies Partial<ErrorSentences>;
