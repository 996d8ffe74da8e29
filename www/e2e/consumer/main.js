import { createSlicer } from "cusp-slicer";
import "cusp-slicer/element";

const { dataset } = document.body;
const element = document.querySelector("cusp-slicer");
element.addEventListener("cusp-plan", ({ detail }) => (dataset.element = String(detail.report.layers)));
element.addEventListener("cusp-error", ({ detail }) => (dataset.error = detail.code));

const slicer = createSlicer();
const model = await slicer.load("ball.stl");
const { schema, report } = await slicer.plan({ tolerance: 0.065 });
const file = await slicer.export();
dataset.headless = [schema, model.name, report.layers, report.backend, file.size > 1000].join(" ");
slicer.dispose();
