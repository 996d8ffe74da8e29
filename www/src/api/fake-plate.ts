/**
 * The plate of fake workers, for tests: it keeps the texts of its files, and reports each model's copies as those that it has. The
 * supports of a model are its number.
 */
import type { MeshInfo, ModelPrintability, Placement, PlateWorker, Report } from "./wire.js";

/** @param work hears of each call, and may hang or throw */
export function fakePlate(work: (what: string) => Promise<void> = async () => undefined): PlateWorker {
  const models: { file: string; weights: string }[] = [];
  const all = (): string => models.map(({ file, weights }) => file + weights).join(" ") || "nothing";
  return {
    addToPlate: async (file) => {
      const text = await file.text();
      await work(`add ${text}`);
      if (text === "bad") throw { code: "empty-file", message: "no", detail: null };
      models.push({ file: text, weights: "" });
      return { facets: 1 } as MeshInfo;
    },
    removeFromPlate: (model) => {
      void work(`remove ${models[model]?.file}`);
      models.splice(model, 1);
    },
    platePositions: (model) => Float32Array.of(model),
    setPlateWeights: (model, weights) => {
      if (weights?.some((weight) => weight > 1)) throw { code: "weights-out-of-range", message: "no", detail: null };
      const there = models[model];
      if (there !== undefined) there.weights = weights === null ? "" : `*${weights.join()}`;
    },
    arrangePlate: (options) => options.models?.map((_, model): Placement => ({ model, plate: 0, x_mm: 0, y_mm: 0, turn_deg: 0 })) ?? [],
    plateProblems: () => [],
    planPlate: async ({ options, models: own = [] }, progress) => {
      progress("ldi", 0.5, 0.4);
      await work(`plan ${options?.tolerance} of ${all()}, ${own.map(({ copies = 1 }) => copies).join(" ")} copies`);
      const report = (plate: number): Report =>
        ({
          mask: { width: 8, height: 2 },
          print_file: { format: "uvj", extension: "uvj", media_type: "application/octet-stream" },
          warnings: [],
          plate: { plate, plates: 2, models: own.map(({ copies }, model) => ({ model, copies, size_mm: [1, 1, 1], resin_ml: 1.5, print_time_s: 15 })) },
        }) as unknown as Report;
      return {
        report: { schema: 2, print_time_s: 60, resin_ml: 3, plates: [report(0), report(1)] },
        profiles: [Float32Array.of(1), Float32Array.of(2)],
        ...(options?.supports !== undefined && { supports: own.map((_, model) => Float32Array.of(model)) }),
      };
    },
    tradeoffPlate: () => ({ points: [] }),
    inspectPlate: (plate) => ({ verdict: "ok", models: [{ model: plate, turn_deg: 0 } as ModelPrintability] }),
    plateMask: (plate, layer) => {
      void work(`mask ${layer} of plate ${plate}`);
      return new Uint8Array(2);
    },
    archivePlate: (plate) => {
      void work(`archive ${plate}`);
      return new Blob(["zip"]);
    },
  };
}
