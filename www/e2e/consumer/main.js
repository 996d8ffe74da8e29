import { createSlicer } from "cusp-slicer";
import "cusp-slicer/element";

const slicer = createSlicer();
const model = await slicer.load("ball.stl");
const { schema, report } = await slicer.plan({ tolerance: 0.065 });
const file = await slicer.export();
document.body.dataset.headless = [schema, model.name, report.layers, report.backend, file.blob.size > 1000].join(" ");
slicer.dispose();
