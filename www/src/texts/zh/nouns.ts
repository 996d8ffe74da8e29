import type { ModelUnit, PartKind } from "../../api/wire.js";
import type { GpuFaults } from "../sentences.js";

export const UNITS: Readonly<Record<ModelUnit, string>> = {
  ...{ micron: "微米", millimeter: "毫米", centimeter: "厘米" },
  ...{ inch: "英寸", foot: "英尺", meter: "米" },
};

export const FAULTS: GpuFaults = {
  error: "系统报告错误",
  "device-lost": "设备丢失",
  "too-many-hits": "模型的表面点超出其缓冲区",
  "bad-offsets": "返回的偏移量不一致",
  "out-of-memory": "内存不足",
};

export const PART_KINDS: Readonly<Record<PartKind, string>> = {
  negative: "负零件",
  modifier: "修改器",
  "support-blocker": "支撑屏蔽器",
  "support-enforcer": "支撑添加器",
};
