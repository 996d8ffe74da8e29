import type { UniformLayers } from "../../api/wire.js";
import type { Format } from "../format.js";
import { adviceOn, ended, FILE_KINDS, flatKind, STL_KEYWORDS, type ErrorSentences, type QuantityNouns, type StlNouns, type WorkWords } from "../sentences.js";
import { FAULTS } from "./nouns.js";
import { readers } from "./readers.js";

const QUANTITIES: QuantityNouns = {
  pitch: "像素间距",
  bin: "区间高度",
  step: "电机步距",
  layer: "层厚",
  "first-layer": "首层",
  "layer-min": "最小层厚",
  "layer-max": "最大层厚",
  tolerance: "公差",
  "resin-layer": "树脂的层厚",
  penetration: "透射深度",
  exposure: "曝光时间",
  "bottom-exposure": "底层曝光时间",
  wait: "层间等待时间",
  lift: "抬升高度",
  "lift-speed": "抬升速度",
  "return-speed": "回程速度",
  density: "树脂密度",
};

const WORK: WorkWords = {
  hits: ["对模型采样", "，或选用更大的像素"],
  layers: ["规划", "，或选择更大的高度区间或更少的层厚"],
  saliency: ["找出显眼之处", "，或不用它，或减少模型的三角形"],
  all: ["这", ""],
};

const EXPECTED: StlNouns = {
  ...STL_KEYWORDS,
  "facet-or-endsolid": "`facet` 或 `endsolid`",
  "normal-number": "法线的一个数",
  coordinate: "一个坐标",
};

const inPlace = (best: UniformLayers | null | undefined, { count, mm }: Pick<Format, "count" | "mm">): string =>
  best ? `使用 ${count(best.layers)} 个 ${mm(best.layer_mm)} 的均匀层，误差在公差以内` : "使用均匀分层";

export const errors = ({ count, exact, mm, measure, error, either }: Format): ErrorSentences => ({
  ...readers({ count }),
  "file-empty": () => "文件是空的；请重新导出模型。",
  "unknown-file-kind": () => "这不是 Cusp 能读取的模型；请导出为 STL、3MF 或 OBJ。",
  "no-plate": ({ plate_number, plates }) => `没有第 ${count(plate_number)} 块打印板：文件有 ${count(plates)} 块。`,
  "other-file-kind": ({ kind }) =>
    flatKind(kind, { picture: "图片", document: "文档", drawing: "图纸" }, (noun) => `这是${noun}（${FILE_KINDS[kind]}）；Cusp 可打开 STL、3MF、OBJ 和打印文件。`) ??
    `这是 ${FILE_KINDS[kind]} 文件，Cusp 无法读取；${adviceOn(kind, {
      model: "请将模型导出为 STL、3MF 或 OBJ",
      packed: "请先解压，再打开其中的模型",
      page: "请下载模型本身；该地址可能需要登录，或指向介绍模型的页面",
    })}。`,
  "stl-truncated": (detail) =>
    "line" in detail
      ? `STL 不完整：文件止于第 ${count(detail.line)} 行，其后应为${EXPECTED[detail.expected]}。`
      : `STL 不完整：文件头声明 ${count(detail.declared_facets)} 个三角面，需要 ${count(detail.expected_bytes)} 字节，` +
        `但文件止于第 ${count(detail.found_bytes)} 字节；请重新复制或导出。`,
  "stl-wrong-facet-count": ({ declared_facets, found_facets }) =>
    `三角面数有误：文件头第 80 字节处声明 ${count(declared_facets)} 个，但其后有 ${count(found_facets)} 个；请重新导出模型。`,
  "stl-not-finite": (detail) =>
    "line" in detail
      ? `第 ${count(detail.line)} 行：\`${detail.text}\` 不是有限数；请重新导出模型。`
      : `第 ${count(detail.byte)} 字节处的坐标（三角面 ${count(detail.facet)}）不是有限数；请重新导出模型。`,
  "stl-syntax": ({ line, expected, found }) =>
    `第 ${count(line)} 行：应为${EXPECTED[expected]}，却是 \`${found}\`；请重新导出模型。`,
  "stl-no-facets": () => "STL 中没有三角面；请重新导出模型。",
  "mesh-no-area": ({ facets }) => `${count(facets)} 个三角面都没有面积；请重新导出模型。`,
  "mesh-zero-height": () => "模型没有高度；它是平的，还是躺在 z = 常数的平面上？",
  "mesh-overflow": () => "模型过大：在此高度下其尺寸超过一千米；请选择其他单位或高度。",
  "bad-height": ({ height_mm }) => `高度必须大于 0，而不是 ${mm(height_mm)}。`,
  "bad-rotation": () => "旋转必须是长度不为零的四元数 x, y, z, w。",
  "bad-length": ({ quantity, value, unit, least, most }, metric) =>
    `${QUANTITIES[quantity]}必须在 ${exact(least)} 到 ${measure(most, unit, metric)} 之间，而不是 ${measure(value, unit, metric)}。`,
  "bad-time": ({ quantity, value_s, most_s }) => `${QUANTITIES[quantity]}必须在 0 到 ${measure(most_s, "s")} 之间，而不是 ${measure(value_s, "s")}。`,
  "bad-exposures": ({ previous_mm, next_mm }) =>
    `测得的曝光必须按厚度排列，后一项比前一项厚，但 ${mm(previous_mm)} 之后是 ${mm(next_mm)}。`,
  "bad-growth": ({ least_mm, most_mm, value_mm }) =>
    `打印件的膨胀量必须在 ${exact(least_mm)} 到 ${mm(most_mm)} 之间，而不是 ${mm(value_mm)}。`,
  "bad-options": ({ system }) => `无法读取选项：${ended(system)}`,
  "unknown-printer": ({ printer, similar, known }) =>
    `已知的 ${count(known)} 种打印机中没有 ${printer}${similar.length === 0 ? "" : `；相近的有 ${similar.join("、")}`}。`,
  "bad-printer": ({ printer, field }) => `打印机 ${printer} 的 ${field} 不能取此值；请更正其描述。`,
  "printer-not-json": ({ system }) => `此文件没有以 JSON 描述打印机：${ended(system)}`,
  "printer-too-long": ({ bytes, most_bytes }) => `打印机描述最多 ${count(most_bytes)} 字节，而此文件有 ${count(bytes)} 字节；请选择其他文件。`,
  "pixels-without-pitch": () => "像素与其 x、y 间距须一并给出；请两者都给，或给出 x、y 共用的一个间距。",
  "bad-antialias": ({ antialias, known }) => `抗锯齿级别有 ${known.join("、")}，没有 ${exact(antialias)}。`,
  "bad-size": ({ option, value_mm, least_mm, most_mm }) => `${option} 必须在 ${mm(least_mm)} 到 ${mm(most_mm)} 之间，而不是 ${mm(value_mm)}。`,
  "bad-weight-min": ({ weight_min }) => `最小权重必须在 0 到 1 之间，而不是 ${exact(weight_min)}。`,
  "bad-directions": ({ directions, most }) => `一次搜索可查看 1 到 ${count(most)} 个方向，而不是 ${count(directions)} 个。`,
  "bad-limit": ({ limit, value, least, most }) => `${limit} 必须在 ${exact(least)} 到 ${exact(most)} 之间，而不是 ${exact(value)}。`,
  "bad-alpha": ({ alpha }) => `alpha 必须在 0 到 1 之间，而不是 ${exact(alpha)}。`,
  "bad-search-limit": ({ limit, value }) => `${limit} 必须是 0 或更大，而不是 ${exact(value)}。`,
  "search-task": ({ task }) => `任务 ${exact(task)} 的结果不属于任何未完成的任务；每个结果只应提交一次。`,
  "search-candidate": ({ place }) => `候选 ${exact(place)} 不是按其方向测量的。`,
  "several-targets": () => "请给出公差、最多层数或最长时间，且只给其中一项。",
  "contradictory-options": ({ option, other }) => `${option} 与 ${other} 不能同时使用，请去掉其中一项。`,
  "printer-layers": ({ model, printer_min_mm, printer_max_mm, layer_min_mm, layer_max_mm }) =>
    `${model} 可打印 ${exact(printer_min_mm)} 到 ${mm(printer_max_mm)} 的层，而不是 ${exact(layer_min_mm)} 到 ${mm(layer_max_mm)}；` +
    "请留在此范围内，或选择其他打印机。",
  "printer-step": ({ model, printer_step_mm, step_mm }) =>
    `${model} 的步距为 ${mm(printer_step_mm)}，${mm(step_mm)} 不是其整数倍；请使用 ${mm(printer_step_mm)} 的倍数。`,
  "resin-printer": ({ format, model }) => `${format} 文件用于丝材打印机，而 ${model} 打印树脂；请去掉打印机，或选择它能读取的格式。`,
  "nozzle-without-filament": ({ formats }) => `喷嘴只用于丝材打印机的格式：${formats.join("、")}；请选择其中之一，或去掉喷嘴。`,
  "bad-nozzle": ({ nozzle_mm, least_mm, most_mm }) => `喷嘴直径必须为 ${exact(least_mm)} 到 ${mm(most_mm)}，而不是 ${mm(nozzle_mm)}。`,
  "nozzle-layers": ({ slicers, nozzle_mm, nozzle_min_mm, nozzle_max_mm, layer_min_mm, layer_max_mm }) =>
    `用 ${mm(nozzle_mm)} 的喷嘴，${either(slicers)} 可打印 ${exact(nozzle_min_mm)} 到 ${mm(nozzle_max_mm)} 的层，` +
    `而不是 ${exact(layer_min_mm)} 到 ${mm(layer_max_mm)}；请留在此范围内，或指定其他喷嘴。`,
  "grid-bad-size": ({ width, height, max_side, max_pixels }) =>
    `不可能有 ${count(width)} × ${count(height)} 像素的掩膜：每边可有 1 到 ${count(max_side)} 个，总共至多 ${count(max_pixels)} 个。`,
  "grid-too-fine": ({ width, height, max_side, max_pixels }) =>
    `抗锯齿需要 ${count(width)} × ${count(height)} 条光线，而每边至多 ${count(max_side)} 条，总共至多 ${count(max_pixels)} 条；请选择更低的级别。`,
  "model-too-large": ({ model_mm_x, model_mm_y, grid_mm_x, grid_mm_y, fitting_scale }) =>
    `模型为 ${exact(model_mm_x)} × ${mm(model_mm_y)}，而画面只有 ${exact(grid_mm_x)} × ${mm(grid_mm_y)}；按 ${exact(fitting_scale)} 的比例可放下。`,
  "model-too-high": ({ model_mm_z, printer_mm_z, fitting_scale }) =>
    `模型高 ${mm(model_mm_z)}，而打印机只能打印 ${mm(printer_mm_z)}；按 ${exact(fitting_scale)} 的比例可放下。`,
  "plate-empty": () => "平台上没有模型；请添加一个。",
  "plate-without-size": () => "平台尺寸未知；请选择打印机，或给出像素数和像素间距。",
  "bad-spacing": ({ spacing_mm }) => `间距必须为 0 到 100 mm，而不是 ${mm(spacing_mm)}。`,
  "bad-turn": ({ turn_deg }) => `模型的旋转步长为 0、15、30、45、60、90、120 或 180°，而不是 ${exact(turn_deg)}°。`,
  "plate-too-small": ({ model_number, size_mm, plate_mm }) =>
    `模型 ${count(model_number)} 为 ${exact(size_mm[0])} × ${mm(size_mm[1])}，而平台为 ${exact(plate_mm[0])} × ${mm(plate_mm[1])}；请缩小它，或选择其他朝向或打印机。`,
  "too-many-copies": ({ copies, most_copies }) =>
    `一个任务最多 ${count(most_copies)} 个副本，${count(copies)} 个太多；请分成几个任务。`,
  "plate-other-copies": ({ model_number, copies, places }) =>
    `模型 ${count(model_number)} 要打印 ${count(copies)} 次，却有 ${count(places)} 个位置；请更正其中之一，或排列平台。`,
  "plate-gap": ({ plate_number }) => `平台 ${count(plate_number)} 上没有模型，之后的平台上却有；请连续编号。`,
  "plate-outside": ({ model_number, copy_number, plate_number }) =>
    `模型 ${count(model_number)} 的第 ${count(copy_number)} 个副本超出了平台 ${count(plate_number)}；请移动它，或排列平台。`,
  "plate-collision": ({ model_numbers, copy_numbers, plate_number }) =>
    `模型 ${count(model_numbers[0])} 的第 ${count(copy_numbers[0])} 个副本与模型 ${count(model_numbers[1])} 的第 ${count(copy_numbers[1])} 个副本在平台 ${count(plate_number)} 上重叠；请移动其中一个，或排列平台。`,
  "plate-no-model": ({ model_number, models }) => `没有模型 ${count(model_number)}；平台上有 ${count(models)} 个。`,
  "no-such-plate": ({ plate_number, plates }) => `没有平台 ${count(plate_number)}；共有 ${count(plates)} 个。`,
  "too-many-bins": ({ height_mm, bin_mm }) => `${mm(height_mm)} 按 ${mm(bin_mm)} 划分的区间过多；请选择更大的区间。`,
  "not-whole-bins": ({ quantity, length_mm, bin_mm }) =>
    `${QUANTITIES[quantity]} ${mm(length_mm)} 不是区间 ${mm(bin_mm)} 的整数倍；请选择能整除它的区间。`,
  "not-whole-steps": ({ quantity, length_mm, step_mm }) =>
    `${QUANTITIES[quantity]} ${mm(length_mm)} 不是步距 ${mm(step_mm)} 的整数倍；请选择 ${mm(step_mm)} 的倍数。`,
  "layer-range-upside-down": ({ layer_min_mm, layer_max_mm }) =>
    `最小层厚 ${mm(layer_min_mm)} 大于最大层厚 ${mm(layer_max_mm)}；请减小前者或增大后者。`,
  "layer-range-empty": ({ layer_min_mm, layer_max_mm, step_mm }) =>
    `层厚 ${exact(layer_min_mm)} 与 ${mm(layer_max_mm)} 之间没有整数个 ${mm(step_mm)} 的步距；请扩大范围，或选择更小的步距。`,
  "layer-too-thick": ({ layer_mm, height_mm }) => `${mm(layer_mm)} 的层对高 ${mm(height_mm)} 的模型来说太厚。`,
  "layers-do-not-fit": ({ from_mm, to_mm, layer_min_mm, layer_max_mm }) =>
    `${exact(layer_min_mm)} 到 ${mm(layer_max_mm)} 的层无法凑成从 ${exact(from_mm)} 到 ${mm(to_mm)} 的高度；请扩大层厚范围，或移动分层面。`,
  "thicknesses-do-not-fit": ({ from_mm, to_mm, model_number, tolerance, thicknesses_mm, least_tolerance }) =>
    `${thicknesses_mm.map(mm).join("、")} 的层无法在${model_number === null ? "" : `模型 ${count(model_number)} 的`}公差 ${exact(tolerance)} 之内从 z = ${exact(from_mm)} 到达 ${mm(to_mm)}；` +
    (least_tolerance === null
      ? "请增加一种层厚，或移动分层面。"
      : `请将公差放宽到 ${exact(least_tolerance)}，或增加一种层厚。`),
  "too-few-thicknesses": ({ thicknesses, enough }) =>
    `在公差之内，没有至多使用 ${count(thicknesses)} 种层厚的方案；请允许 ${count(enough)} 种，或放宽公差。`,
  "not-gradual": ({ change_mm, least_change_mm }) =>
    `在公差之内，没有相邻层厚变化不超过 ${mm(change_mm)} 的方案；请允许 ${mm(least_change_mm)} 的变化，或放宽公差。`,
  "bad-range": ({ from_mm, to_mm }) =>
    `从 ${exact(from_mm)} 到 ${mm(to_mm)} 的高度范围为空，或与另一范围重叠；请自下而上给出互不重叠的范围。`,
  "bad-plane": ({ z_mm, height_mm }) => `高 ${mm(height_mm)} 的模型中，${mm(z_mm)} 处不能有分层面。`,
  infeasible: ({ from_mm, to_mm, model_number, tolerance, layer_min_mm }, metric) =>
    `没有方案能使${model_number === null ? "" : `模型 ${count(model_number)} 的`}每层误差不超过 ${error(metric, tolerance)}：从 z = ${exact(from_mm)} 到 ${mm(to_mm)}，即使一层只有 ${mm(layer_min_mm)} 也会超出。`,
  "out-of-reach": (detail) =>
    "layers" in detail
      ? `没有至多 ${count(detail.layers)} 层的方案；至少需要 ${count(detail.least_layers)} 层。`
      : `没有能在 ${measure(detail.time_s, "s")} 内打印的方案；至少需要 ${measure(detail.least_time_s, "s")}。`,
  "no-plan": () => "还没有方案；请先制定一个。",
  "memory-bound": ({ needed_bytes, allowed_bytes }) =>
    `这约需 ${count(needed_bytes)} 字节内存，而只允许 ${count(allowed_bytes)} 字节；请允许更多，或选用更大的像素。`,
  "time-bound": ({ work, needed_s, allowed_s }) => {
    const [subject, way] = WORK[work];
    return `${subject}约需 ${count(needed_s)}\u00a0秒处理器时间，而允许的是 ${count(allowed_s)} 秒；请允许更多时间${way}。`;
  },
  "no-layer": ({ layer, layers }) => `没有第 ${count(layer)} 层；方案有 ${count(layers)} 层，从 0 数起。`,
  "no-hits": ({ pitch_mm }) => `没有 ${mm(pitch_mm)} 的像素碰到模型，模型对它们来说太小或太薄；请选择更小的像素。`,
  "too-many-facets": ({ facets, most }) => `${count(facets)} 个三角面过多；至多可切 ${count(most)} 个。`,
  "out-of-memory": ({ hits, needed_bytes }) =>
    `在此分辨率下，模型的 ${count(hits)} 个表面点需要 ${count(needed_bytes)} 字节，超出现有内存；请减少光线。`,
  "no-gpu": ({ system }) => `没有可用的 GPU：${ended(system)}`,
  "gpu-emulated": ({ adapter }) => `没有可用的 GPU：${adapter} 由软件模拟。`,
  "gpu-too-small": ({ facets, needed_bytes, limit_bytes }) =>
    `${count(facets)} 个三角面需要 ${count(needed_bytes)} 字节的 GPU 缓冲区，而此 GPU 只有 ${count(limit_bytes)}；请使用 CPU。`,
  "gpu-failed": ({ fault, system }) => `GPU 出错：${FAULTS[fault]}${system === null ? "" : `（${system}）`}。`,
  "all-black": () => "所有掩膜都是黑的：模型没有包围层中间所遇的任何部分；请检查模型，或选择更薄的层。",
  "uniform-only": ({ format, others, best }) =>
    `${format} 文件的所有层只有一种厚度，而本方案有多种；请选择 ${others.join("、")}，或${inPlace(best, { count, mm })}。`,
  "printer-uniform-only": ({ model, best }) => `${model} 的所有层只能用一种厚度，而本方案有多种；请${inPlace(best, { count, mm })}。`,
  "weights-not-weights": () => "这不是权重文件：开头不是 CUSPWT01，或文件不完整。",
  "weights-other-mesh": ({ weights_facets, mesh_facets }) =>
    `这些权重属于另一个有 ${count(weights_facets)} 个三角面的网格；当前网格有 ${count(mesh_facets)} 个；请重新涂绘，或打开制作权重时所用的模型。`,
  "weights-out-of-range": ({ facet, weight }) => `三角面 ${count(facet)} 的权重是 ${exact(weight)}，而权重在 0 到 1 之间。`,
  "price-out-of-bounds": ({ field, value, least, most }) =>
    `${field} 为 ${exact(value)}，但必须在 ${exact(least)} 到 ${exact(most)} 之间；请更正价格或订单。`,
  "bad-prices": ({ field }) => `价格不能有这样的 ${field}；货币是 ISO 4217 的三个大写字母，数量折扣须递增，每种后处理须有各自的名称。`,
  "no-finish": ({ finish, known }) => `没有后处理 ${finish}；${known.length > 0 ? `已知的有 ${known.join("、")}` : "价格表中没有任何后处理"}。`,
  "no-masks": ({ format }) => `${format} 文件包含模型及其分层，不含掩膜；请直接把模型切片为此格式，或选择其他格式。`,
  "other-first-layer": ({ layer_mm, first_layer_mm }) =>
    `本方案的第一层厚 ${mm(layer_mm)}，而不是所设的 ${mm(first_layer_mm)}；模型比它低，请选择更薄的第一层。`,
  "archive-write": ({ system }) => `无法写入打印文件：${ended(system)}`,
  cancelled: () => "已取消。",
  "bad-attribute": ({ attribute, value, known }) =>
    `属性 ${attribute} 不能是 ${String(value)}${known === undefined ? "" : `；已知的有 ${known.join("、")}`}。`,
  "part-failed": ({ part, system }) => `页面的一部分无法加载：${part}（${system}）。`,
  "no-browser": () => "这里没有浏览器；请在页面中调用。",
  "no-model": () => "还没有模型；请先打开一个。",
  "file-unreadable": () => "文件可能已被移动、更改或锁定。请重新选择。",
  "bad-source": ({ given }) => `无法从 ${given} 读取模型；请传入文件、其字节或字节流、地址、响应，或各三角面的坐标。`,
  "bad-facets": ({ list, numbers, multiple_of }) => `列表 ${list} 有 ${count(numbers)} 个数，应为 ${exact(multiple_of)} 的倍数。`,
  "bad-index": ({ place, index, vertices }) => `第 ${count(place)} 位的索引为 ${exact(index)}，不是顶点：从 0 起共有 ${count(vertices)} 个。`,
  "bad-number": ({ argument, value }) => `参数 ${argument} 为 ${String(value)}，必须是从 0 起的整数。`,
  "dropped-link": () => "这是链接，不是文件。请下载模型，然后将文件拖放到此处。",
  "folder-without-model": () => "文件夹中没有 STL、3MF 或 OBJ 文件。请拖放包含模型的文件夹，或直接拖放模型。",
  "fetch-failed": (detail) =>
    "status" in detail ? `该地址没有返回文件（HTTP ${detail.status}）。` : `该地址没有回应（${detail.system}）。`,
  "worker-failed": ({ system }) => `请重新加载页面。若无效，请告知网站管理员：缺少脚本，或页面的策略不允许该 worker。（${system}）`,
  "start-failed": ({ system }) => `请重新加载页面。若无效，此浏览器可能过旧，不支持 WebAssembly。（${system}）`,
  crash: ({ system }) => `可能内存不足。程序已重新启动：请再试一次，模型较大时请减少光线。（${system}）`,
});
