/** Nouns in the sentences of warnings, and of errors. */
import type { GpuFault, PartKind } from "../api/wire.js";
import { room } from "./messages.js";

room("nouns", {
  gpuFaults: {
    error: "the system reports an error",
    "device-lost": "the device was lost",
    "too-many-hits": "the model has more surface points than its buffers hold",
    "bad-offsets": "it returned offsets that do not add up",
    "out-of-memory": "there was not enough memory",
  },
  partKinds: {
    negative: "negative part",
    modifier: "modifier",
    "support-blocker": "support blocker",
    "support-enforcer": "support enforcer",
  },
  /** A size of the model for another unit of its file, within a sentence. */
  reading: "in {unit|settings.units} it would be {size_mm|mm}; ",
} satisfies { gpuFaults: Record<GpuFault, string>; partKinds: Record<PartKind, string>; reading: string });
