/** What a server does with the package: imports all of it, and now and then calls what only a browser can do. */
const before = Object.getOwnPropertyNames(globalThis);
const { createSlicer, SlicerError } = await import("cusp-slicer");
const { CuspSlicer } = await import("cusp-slicer/element-class");
const entries = ["element", "react", "preact", "solid", "vue", "svelte", "worker.js"];
for (const entry of entries) await import(`cusp-slicer/${entry}`);

class ShopSlicer extends CuspSlicer {}
const slicer = createSlicer();
const quiet = ["warm", "rest", "dispose"];
for (const name of quiet) slicer[name]();

const codes = {};
for (const [name, call] of Object.entries(slicer)) {
  if (quiet.includes(name)) continue;
  const given = call("https://shop.example/model.stl");
  const answer = given instanceof ReadableStream ? given.getReader().read() : given;
  codes[name] = await answer.then(
    () => "answered",
    (error) => (error instanceof SlicerError ? error.code : String(error)),
  );
}
const globals = Object.getOwnPropertyNames(globalThis).filter((name) => !before.includes(name));
console.log(JSON.stringify({ class: ShopSlicer.name, codes, globals }));
