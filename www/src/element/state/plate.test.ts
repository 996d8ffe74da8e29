import { beforeEach, expect, test } from "vitest";
import { fakeWorkers } from "../../api/fake-worker.js";
import { createSlicer } from "../../api/index.js";
import type { ArrangeError, JobOptions, Placement } from "../../api/wire.js";
import { MOST_COPIES, Plate, type Added, type Entry, type Own } from "./plate.js";
import type { Pose } from "./snapshot.js";

/** Calls to the fake worker, and its answers. */
let log: string[];
let jobs: JobOptions[];
let answers: ArrangeError[];
/** Reports of the plate to its host. */
let told: string[];
/** Kinds of its undo steps. */
let steps: string[];
let plate: Plate;
/** Options from settings for a model in a pose. */
let owned: (pose: Pose) => Own | null;

const POSE: Pose = { rotation: "", height: "", points: "", fill: "off", drains: "", drain: "auto" };

beforeEach(async () => {
  log = [];
  jobs = [];
  answers = [];
  told = [];
  steps = [];
  owned = () => null;
  const spawn = fakeWorkers(log);
  const watched = (): ReturnType<typeof spawn> => {
    const handle = spawn();
    const { plan } = handle.remote;
    handle.remote.plan = (options, progress) => {
      jobs.push(options);
      return plan(options, progress);
    };
    handle.remote.problems = () => answers;
    return handle;
  };
  const host = {
    changed: () => undefined,
    changing: (kind: string | null) => void (kind !== null && steps.push(kind)),
    replate: () => told.push("replate"),
    show: () => told.push("show"),
    selected: ({ model }: Entry) => told.push(`selected ${model.name}`),
    own: (pose: Pose) => owned(pose),
  };
  plate = new Plate(host, createSlicer({ spawn: watched }));
  await plate.open(new Blob(["cup"]), { name: "a.stl" });
});

const added = (name: string): Added => ({ source: new File([name], `${name}.stl`), own: {} });

const ring = added("ring");

test("a single copy is planned with all of its options", async () => {
  plate.keep({ own: { height_mm: 5 } });
  await plate.plan({ tolerance: 1, height_mm: 5 }, {});
  expect(jobs).toEqual([{ options: { tolerance: 1, height_mm: 5 }, models: [{}], placements: [] }]);
  expect(plate.planned).toBeNull();
});

test("several are planned on the plate, each in its own pose", async () => {
  plate.keep({ own: { height_mm: 5 } });
  await plate.add([ring], {});
  plate.setCopies(1, 3);
  await plate.plan({ tolerance: 1, height_mm: 5, rotation: [0, 0, 1, 0] }, {});
  expect(jobs[0]?.options).toEqual({ tolerance: 1, pixels: [3840, 2400], pitch_mm: 0.05 });
  expect(jobs[0]?.models).toEqual([{ copies: 1, height_mm: 5 }, { copies: 3 }]);
  expect(log).toEqual(["1: add cup", "1: add ring", "1: plan 1 of cup ring×3"]);
});

test("each of several models has its own void and supports, with its own points", async () => {
  const supports = { strength: "light", points: [{ at_mm: [1, 2, 3] as [number, number, number] }] } as const;
  owned = ({ points }) => (points === "" ? { hollow: { wall_mm: 2 } } : { hollow: { wall_mm: 2 }, supports: { ...supports, points: [...supports.points] } });
  plate.keep({ pose: { ...POSE, points: "1,2,3,,1" } });
  await plate.add([ring], {});
  await plate.plan({ tolerance: 1, hollow: { wall_mm: 2 }, supports: { strength: "light" } }, {});
  expect(jobs[0]?.options).toEqual({ tolerance: 1, pixels: [3840, 2400], pitch_mm: 0.05 });
  expect(jobs[0]?.models).toEqual([
    { copies: 1, hollow: { wall_mm: 2 }, supports },
    { copies: 1, hollow: { wall_mm: 2 } },
  ]);
});

test("a file that cannot be read leaves the models as they were, also those read before it", async () => {
  const adding = plate.add([ring, added("bad")], {});
  await expect(adding).rejects.toMatchObject({ code: "empty-file" });
  expect(plate.entries).toHaveLength(1);
  plate.setCopies(0, 2);
  await plate.plan({ tolerance: 1 }, {});
  expect(log.at(-1)).toBe("1: plan 1 of cup×2");
});

test("two copies of one model are a plate; taking one away goes back to a copy in the middle", async () => {
  plate.setCopies(0, 2);
  expect(plate.isSeveral).toBe(true);
  await plate.plan({}, {});
  expect(plate.planned).not.toBeNull();
  plate.setCopies(0, 1);
  expect(plate.isSeveral).toBe(false);
  await plate.plan({}, {});
  expect(jobs.at(-1)?.models).toEqual([{}]);
  expect(plate.planned).toBeNull();
  expect(told).toEqual(["replate", "replate"]);
});

test("the number of copies stays within bounds, and what is no number changes nothing", () => {
  plate.setCopies(0, 0);
  expect(plate.entries[0]?.copies).toBe(1);
  plate.setCopies(0, 1e9);
  expect(plate.entries[0]?.copies).toBe(MOST_COPIES);
  plate.setCopies(0, Number.NaN);
  expect(plate.entries[0]?.copies).toBe(MOST_COPIES);
});

test("what is typed as a number of copies and is none stays on show with its fault; the copies stay as they are", () => {
  plate.typeCopies(0, " 3 ");
  expect([plate.entries[0]?.copies, plate.misread]).toEqual([3, null]);
  const told_ = told.length;
  for (const [text, fault] of [["many", "number"], ["", "number"], ["2.5", "whole"], ["0", "range"], ["1001", "range"], ["1.000", "grouped"]] as const) {
    plate.typeCopies(0, text, ",");
    expect([plate.entries[0]?.copies, plate.misread]).toMatchObject([3, { key: plate.entries[0]?.key, text, fault: { kind: fault } }]);
  }
  expect(told.slice(told_)).toEqual([]);
  plate.setCopies(0, 3);
  expect(plate.misread).toBeNull();
});

test("removing the selected model selects another; the last one stays", async () => {
  await plate.add([ring], {});
  plate.select(1);
  plate.remove(1);
  expect(told).toEqual(["selected ring.stl", "selected a.stl"]);
  expect(plate.selected).toBe(0);
  plate.remove(0);
  expect(plate.entries).toHaveLength(1);
});

test("removing a model before the selected one keeps that selected", async () => {
  await plate.add([ring, added("pin")], {});
  plate.select(2);
  plate.remove(0);
  expect(plate.entries[plate.selected]?.model.name).toBe("pin.stl");
  await plate.plan({ tolerance: 1 }, {});
  expect(log.at(-1)).toBe("1: plan 1 of ring pin");
});

const placements: Placement[] = [
  { model: 0, plate: 0, x_mm: 0, y_mm: 0, turn_deg: 0 },
  { model: 0, plate: 0, x_mm: 5, y_mm: 0, turn_deg: 0 },
  { model: 0, plate: 1, x_mm: 0, y_mm: 0, turn_deg: 0 },
];

test("a moved copy stays where it is put until the plate is arranged again", async () => {
  plate.setCopies(0, 3);
  plate.placements = placements;
  plate.move([{ place: 1, x_mm: 9 }], false);
  expect(told).toEqual(["replate"]);
  plate.move([{ place: 1, turn_deg: 45 }], true);
  expect(told).toEqual(["replate", "replate"]);
  expect(plate.copies.map(({ x_mm, turn_deg }) => [x_mm, turn_deg])).toEqual([[0, 0], [9, 45]]);
  await plate.plan({}, {});
  expect(jobs[0]?.placements?.[1]).toMatchObject({ x_mm: 9, turn_deg: 45 });
  plate.arrange({ spacing_mm: 4 });
  await plate.plan({}, {});
  expect(jobs[1]).toMatchObject({ placements: [], arranging: { spacing_mm: 4, turn_deg: 45 } });
});

test("what is wrong with the places is asked while a copy is moved", async () => {
  plate.setCopies(0, 3);
  plate.placements = placements;
  answers = [{ code: "plate-collision", detail: { model_numbers: [1, 1], copy_numbers: [1, 3], plate_number: 1 } }];
  plate.move([{ place: 1, x_mm: 1 }], false);
  await expect.poll(() => plate.problems).toEqual(answers);
  expect([...plate.colliding]).toEqual([0, 2]);
});

test("copies have the supports of their model, until it has another pose", async () => {
  await plate.add([ring], {});
  const supports = (): (number | undefined)[] => plate.copies.map((copy) => copy.supports?.[0]);
  const stand = (): void => void (plate.placements = [0, 1].map((model) => ({ model, plate: 0, x_mm: 9 * model, y_mm: 0, turn_deg: 0 })));
  await plate.plan({ tolerance: 1 }, {});
  stand();
  expect(supports()).toEqual([undefined, undefined]);
  owned = () => ({ supports: {} });
  await plate.plan({ tolerance: 1 }, {});
  stand();
  expect(supports()).toEqual([0, 1]);
  plate.move([{ place: 1, x_mm: 20, turn_deg: 15 }], false);
  expect(supports()).toEqual([0, 1]);
  plate.keep({ own: { height_mm: 5, supports: {} } });
  expect(supports()).toEqual([undefined, 1]);
  plate.keep({ own: { supports: {} } });
  expect(supports()).toEqual([0, 1]);
  plate.setCopies(1, 2);
  stand();
  // Until these models are planned.
  expect(supports()).toEqual([0, 1]);
  plate.remove(0);
  plate.placements = [{ model: 0, plate: 0, x_mm: 0, y_mm: 0, turn_deg: 0 }];
  expect(supports()).toEqual([1]);
});

test("another plate is shown without planning again, and its masks and file are its own", async () => {
  plate.setCopies(0, 3);
  await plate.plan({ tolerance: 1 }, {});
  expect(plate.planned?.plates).toHaveLength(2);
  plate.show(1);
  expect(told).toEqual(["replate", "show"]);
  await plate.mask(4);
  const { name } = await plate.export({});
  expect(log.slice(-2)).toEqual(["1: mask 4 of plate 1, 1", "1: archive 1"]);
  expect(name).toBe("plate-2-cusp.uvj");
  plate.show(7);
  expect(plate.number).toBe(1);
});

test("a model that comes back between others is read again with those after it, in their order", async () => {
  await plate.add([ring, added("pin")], {});
  await plate.plan({ tolerance: 1 }, {});
  const { state } = plate;
  plate.remove(1);
  await plate.plan({ tolerance: 1 }, {});
  expect(log.at(-1)).toBe("1: plan 1 of cup pin");
  expect(plate.restore(state, { pose: POSE })).toBe(true);
  await plate.plan({ tolerance: 1 }, {});
  expect(log.at(-1)).toBe("1: plan 1 of cup ring pin");
  expect(plate.restore(state, { pose: POSE })).toBe(false);
  expect(steps).toEqual(["add", expect.stringMatching(/^remove /)]);
});

test("the copies that are selected are duplicated and removed, and the others stay where they stand", async () => {
  await plate.add([ring], {});
  plate.setCopies(0, 2);
  const stand = (): void => void (plate.placements = [[0, 0], [0, 0], [1, 2]].map(([model = 0, number = 0], place) => ({ model, plate: number, x_mm: 9 * place, y_mm: 0, turn_deg: 0 })));
  stand();
  plate.duplicate([1, 2]);
  expect(plate.entries.map(({ copies }) => copies)).toEqual([3, 2]);
  plate.setCopies(0, 2);
  plate.setCopies(1, 1);
  stand();
  plate.removeCopies([0]);
  expect(plate.entries.map(({ copies }) => copies)).toEqual([1, 1]);
  // The plate between is gone.
  expect(plate.placed).toEqual([{ model: 0, plate: 0, x_mm: 9, y_mm: 0, turn_deg: 0 }, { model: 1, plate: 1, x_mm: 18, y_mm: 0, turn_deg: 0 }]);
  plate.removeCopies([0, 1]);
  expect(plate.entries).toHaveLength(2);
  plate.removeCopies([0]);
  expect(plate.entries.map(({ model }) => model.name)).toEqual(["ring.stl"]);
  expect([plate.placed, plate.isSeveral, told.at(-1)]).toEqual([[], false, "selected ring.stl"]);
  plate.duplicate([]);
  expect(plate.entries[0]?.copies).toBe(2);
});
