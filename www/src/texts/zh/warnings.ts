import type { Format } from "../format.js";
import type { WarningSentences } from "../sentences.js";
import { FAULTS, PART_KINDS, UNITS } from "./nouns.js";

export const warnings = ({ count, exact, mm, tick, height, volume, error, either }: Format): WarningSentences => ({
  "degenerate-facets": ({ facets }) => `已略去 ${count(facets)} 个没有面积的三角面。`,
  "inside-out": () => "网格内外颠倒，已翻转。",
  "turned-facets": ({ facets }) => `${count(facets)} 个面朝向错误，已翻转。`,
  unorientable: ({ edges }) => `有 ${count(edges)} 条边两侧的面无法朝向一致：该处的内外只是推测。请查看掩膜。`,
  "open-mesh": ({ open_edges, holes }) =>
    `网格不封闭：${count(open_edges)} 条边没有对边，${count(holes)} 个孔洞已封上。请查看掩膜。`,
  "skipped-objects": ({ objects }) => `文件中略去 ${count(objects)} 个对象：支撑、曲面或不打印的对象。`,
  "subtracted-part": ({ name }) => `零件“${name}”被减去。`,
  "skipped-part": ({ name, kind }) => `${PART_KINDS[kind]}“${name}”未打印。`,
  "other-plates": ({ plate_number, plates }) => `读取第 ${count(plate_number)} 块打印板，共 ${count(plates)} 块。`,
  "odd-size": ({ size_mm, readings }) =>
    `文件没有说明单位，按毫米计模型长 ${mm(size_mm)}；` +
    readings.map(({ unit, size_mm }) => `按${UNITS[unit]}计则为 ${mm(size_mm)}；`).join("") +
    "若是其他单位，请指定。",
  "unit-stated": ({ stated, given }) => `文件说明其单位为${UNITS[stated]}，而非${UNITS[given]}。`,
  "nothing-hollowed": ({ wall_mm, cavity_mm }) =>
    `模型保持实心：没有任何一处厚到能容下 ${mm(wall_mm)} 的壁和 ${mm(cavity_mm)} 的空腔。`,
  "nothing-to-drain": () => "模型没有封闭的空腔，因此未开排液孔。请先将其挖空。",
  "drain-astray": ({ drain_number }) => `第 ${count(drain_number)} 个排液孔没有通到空腔，已略去。请把它放在模型空心之处，或使其朝内。`,
  undrained: ({ basins }) => `空腔有 ${count(basins)} 处会滞留树脂：没有孔能水平或向下引出。请在该处开孔，或转动模型。`,
  "closed-cavities": ({ cavities, volume_mm3, at_mm }) =>
    `模型有 ${count(cavities)} 个空腔仍然封闭，内含 ${volume(volume_mm3)} 树脂，最大的位于 ${at_mm.map(tick).join("、")}。请向其开孔，或将其填实。`,
  "support-astray": ({ point_number }) => `第 ${count(point_number)} 个支撑不在模型上，已略去。请把它放在表面上。`,
  unsupported: ({ points }) => `有 ${count(points)} 处无法支撑：没有支撑能到达。请转动模型，或选用更轻的支撑。`,
  "unclosed-rays": ({ unclosed, rays }) => `${count(rays)} 条光线中有 ${count(unclosed)} 条穿过已封上的孔洞。请查看掩膜。`,
  "missed-bodies": ({ bodies, at_mm }) =>
    `模型有 ${count(bodies)} 个部件不在任何掩膜中，最大的位于 ${at_mm.map(tick).join("、")}：比像素还窄，没有射线穿过。请加厚，或选用更小的像素。`,
  "tolerance-exceeded": ({ metric, tolerance, max_error }) =>
    `误差达到 ${error(metric, max_error)}，超过公差 ${error(metric, tolerance)}。`,
  "tolerance-exceeded-on-mesh": ({ metric, tolerance, max_error }) =>
    `网格上的误差达到 ${error(metric, max_error)}，超过公差 ${error(metric, tolerance)}：光线未见到部分表面。`,
  "sampled-sections": () => "表面自相交；截面沿光线计数。",
  "top-moved": ({ top_mm, height_mm }) => `打印止于 ${mm(top_mm)}，因为各层无法恰好凑成 ${mm(height_mm)}。`,
  "black-layers": ({ layers, from_mm }) =>
    `方案中自 ${height(from_mm)} 起有 ${count(layers)} 层没有任何曝光像素：部分结构悬空，或比像素还薄。请查看该处的掩膜。`,
  "erased-parts": ({ layers, from_mm, area_mm2 }) =>
    `自 ${height(from_mm)} 起，补偿在 ${count(layers)} 层中抹去了部分结构，单层最多 ${tick(area_mm2)}\u00a0mm²：它们不比补偿减去的更厚。请加厚，或设定补偿须保留的最小宽度。`,
  "one-thickness": ({ taker, best }) =>
    `${taker} 的所有层只能用一种厚度，而本方案有多种；` +
    (best === null ? "请使用均匀分层。" : `${count(best.layers)} 个 ${mm(best.layer_mm)} 的均匀层，误差在公差以内。`),
  "extrapolated-exposures": ({ layers, thinnest_mm, thickest_mm }) =>
    `${count(layers)} 层的曝光时间为外推值，因为只测量了 ${exact(thinnest_mm)} 至 ${mm(thickest_mm)} 层厚的曝光；请补测这些厚度，或将最小和最大层厚保持在该范围内。`,
  "untried-thicknesses": ({ model }) =>
    `尚无人验证 ${model} 能否打印不同厚度的层；请打印测试塔，或使用均匀分层。`,
  "untried-slicer": ({ slicers }) =>
    `尚无人验证 ${either(slicers)} 是否按方案打印此类文件的各层；打印前请在其预览中核对层数和各层高度。`,
  "gpu-too-small": ({ needed_bytes, limit_bytes }) =>
    `由 CPU 代替 GPU 计算：网格需要 ${count(needed_bytes)} 字节的缓冲区，而 GPU 只有 ${count(limit_bytes)}。`,
  "gpu-failed": ({ fault, system }) => `GPU 出错，由 CPU 代为计算：${FAULTS[fault]}${system === null ? "" : `（${system}）`}。`,
});
