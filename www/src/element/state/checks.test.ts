import { expect, test, vi } from "vitest";
import { SlicerError } from "../../api/error.js";
import { SCHEMA, type Check } from "../../api/index.js";
import type { Finding } from "../../api/wire.js";
import { kindsOf } from "./checked.js";
import { planOf } from "./fake-slicer.js";
import { planned, session, settle, slicer } from "./session-fixture.js";

const finding = (code: Finding["code"], layers: [number, number] = [3, 5]): Finding => ({
  ...{ code, severity: "review", at_mm: [0, 0, 1], layers, area_mm2: 2, volume_mm3: 3, joins_layer: undefined, limit: 1 },
  bounds_mm: [
    [-1, -1, 0],
    [1, 1, 2],
  ],
});

const peel = { area_mm2: [], pull_n: [0.5, 2], largest_layer: 0, jump_layer: 0, jump_mm2: 0, contact: 1 };

function checkOf(...codes: Finding["code"][]): Check {
  const findings = codes.map((code) => finding(code));
  const counts = codes.map((code) => ({ code, found: 1 }));
  const verdict = codes.length > 0 ? "review" : "ok";
  return { schema: SCHEMA, verdict, models: [{ model: 0, turn_deg: 0, verdict, findings, counts, bodies: 1, peel }] };
}

const asked = (): number => slicer.calls.filter(({ what }) => what === "check").length;

async function open(): Promise<void> {
  session.checks.isOpen = true;
  await settle();
}

async function answer(check: Check): Promise<void> {
  slicer.last.resolve(check);
  await settle();
}

/** Plans again with another tolerance. */
async function replanned(tolerance: string): Promise<void> {
  session.change({ tolerances: { ...session.settings.tolerances, volume: tolerance } });
  await settle();
  slicer.last.resolve(planOf(8));
  await settle();
}

test("nothing is checked before somebody wants to know", async () => {
  await planned();
  expect(asked()).toBe(0);
  await open();
  expect(asked()).toBe(1);
  await answer(checkOf("cup"));
  expect(session.checks.models[0]?.found.findings).toHaveLength(1);
});

test("if watched, a plan is checked once it has been shown for a while, and nothing is outlined until a panel shows the findings", async () => {
  session.checks.isWatching = true;
  await planned();
  expect(asked()).toBe(0);
  await vi.waitFor(() => expect(asked()).toBe(1), 5000);
  await answer(checkOf("cup", "island"));
  expect(session.checks.check?.verdict).toBe("review");
  expect(kindsOf(checkOf("cup", "cup", "island"))).toBe(2);
  expect(session.checks.places).toEqual([]);
  await open();
  expect(session.checks.places.map(({ code }) => code)).toEqual(["cup", "island"]);
});

test("each new plan is checked again while the panel is open, and the earlier check counts no more", async () => {
  await planned();
  await open();
  await answer(checkOf("cup"));
  session.turn([0, 1, 0, 0], true);
  await settle();
  expect(session.checks.check).not.toBeNull();
  slicer.last.resolve(planOf(8));
  await settle();
  expect(slicer.last.what).toBe("check");
  expect(session.checks.check).toBeNull();
  expect(session.checks.models[0]?.found.findings).toHaveLength(1);
  await answer(checkOf());
  expect(session.checks.check?.verdict).toBe("ok");
  session.checks.isOpen = false;
  session.turn([1, 0, 0, 0], true);
  await settle();
  slicer.last.resolve(planOf(9));
  await settle();
  expect(asked()).toBe(2);
});

test("a check that is overtaken by a plan is dropped, and made again for that plan", async () => {
  await planned();
  await open();
  const overtaken = slicer.last;
  await replanned("20");
  overtaken.resolve(checkOf("cup"));
  await settle();
  expect(session.checks.last).toBeNull();
  expect(slicer.last.what).toBe("check");
  await answer(checkOf("trap", "speck"));
  expect(session.checks.models[0]?.found.findings).toHaveLength(2);
  expect(asked()).toBe(2);
});

test("limits are a wish of their own, and other limits check again", async () => {
  await planned();
  session.checks.limits = {};
  await settle();
  expect(asked()).toBe(1);
  await answer(checkOf("cup"));
  session.checks.limits = { cup_mm2: 100 };
  await settle();
  expect(session.checks.check).toBeNull();
  await answer(checkOf());
  expect(session.checks.check?.verdict).toBe("ok");
  session.checks.limits = null;
  await settle();
  expect(asked()).toBe(2);
});

test("on a plate each model is checked, its findings are where its first copy stands, and marked on each that stands alike", async () => {
  await planned();
  session.change({ tolerances: { ...session.settings.tolerances, volume: "20" } });
  await settle();
  const plan = planOf(8);
  const placements = [
    { model: 0, x_mm: 1, y_mm: 2 },
    { model: 1, x_mm: -20, y_mm: 5, turn_deg: 45 },
    { model: 1, x_mm: 20, y_mm: 5, turn_deg: 45 },
  ];
  slicer.last.resolve({ ...plan, report: { ...plan.report, plate: 3, placements } });
  await settle();
  const { findings = [], counts = [] } = checkOf("cup").models[0] ?? {};
  const found = { findings: [], counts: [], verdict: "ok", bodies: 1, peel } as const;
  const check: Check = {
    schema: SCHEMA,
    verdict: "review",
    models: [{ ...found, findings: [], counts: [], model: 0, turn_deg: 0 }, { ...found, verdict: "review", findings, counts, model: 1, turn_deg: 45 }],
  };
  const asked: unknown[] = [];
  Object.assign(slicer, { check: async (...given: unknown[]) => (asked.push(given), check) });
  await open();
  expect(asked).toEqual([[{}, { plate: 3 }]]);
  expect(session.checks.check).toBe(check);
  const [sound, cup] = session.checks.models;
  expect(sound).toMatchObject({ model: 0, copies_mm: [[0, 0]], found: { findings: [] } });
  expect(cup).toMatchObject({ model: 1, copies_mm: [[0, 0], [40, 0]], found: { counts, findings: [{ at_mm: [-20, 5, 1], bounds_mm: [[-21, 4, 0], [-19, 6, 2]] }] } });
  // Three copies of half a newton and of two.
  expect(session.checks.pull_n).toEqual([1.5, 6]);
  expect(session.checks.marks).toEqual([]);
  session.checks.choose(cup?.found.findings[0] ?? null);
  expect(session.checks.marks).toMatchObject([{ bounds_mm: [[-21, 4, 0], [-19, 6, 2]], isHollow: true }, { bounds_mm: [[19, 4, 0], [21, 6, 2]] }]);
  session.checks.choose(null);
  expect(session.checks.marks).toEqual([]);
});

test("a copy that is alone on one of several plates has its findings where it stands, and its model's name", async () => {
  await planned();
  session.change({ tolerances: { ...session.settings.tolerances, volume: "20" } });
  await settle();
  const plan = planOf(8);
  slicer.last.resolve({ ...plan, report: { ...plan.report, plate: 1, plate_count: 2, placements: [{ model: 0, plate: 1, x_mm: 30, y_mm: 0 }] } });
  await settle();
  await open();
  await answer(checkOf("cup"));
  expect(session.checks.models).toMatchObject([{ model: 0, copies_mm: [[0, 0]], found: { findings: [{ at_mm: [30, 0, 1] }] } }]);
});

test("a failure is the panel's alone, and stays until there is another plan", async () => {
  await planned();
  await open();
  slicer.last.reject(new SlicerError("bad-options", "unknown field", { system: "unknown field" }));
  await settle();
  expect(session.checks.error?.code).toBe("bad-options");
  expect(session.failure).toBeNull();
  expect(asked()).toBe(1);
  await replanned("20");
  expect(session.checks.error).toBeNull();
  await answer(checkOf());
  expect(session.checks.check?.verdict).toBe("ok");
});

test("a finding that is chosen shows its first layer; again, null and another plan end the choice", async () => {
  await planned();
  await open();
  await answer(checkOf("cup", "trap"));
  const [cup, trap] = session.checks.models[0]?.found.findings ?? [];
  if (cup === undefined || trap === undefined) throw new Error("there are no findings");
  session.checks.choose(cup);
  expect(session.layer).toBe(3);
  expect(session.checks.chosen).toBe(cup);
  session.checks.choose(trap);
  expect(session.checks.chosen).toBe(trap);
  session.checks.choose(trap);
  expect(session.checks.chosen).toBeNull();
  session.checks.choose(trap);
  session.checks.choose(null);
  expect(session.checks.chosen).toBeNull();
  session.checks.choose(cup);
  await replanned("20");
  session.checks.choose(cup);
  expect(session.checks.chosen).toBeNull();
});

test("thin walls are those of the shop, or the usual ones, and showing them checks nothing", async () => {
  await planned();
  expect(session.checks.wall_mm).toBe(0.4);
  session.checks.showsWalls = true;
  expect(session.checks.showsWalls).toBe(true);
  expect(asked()).toBe(0);
  session.checks.limits = { wall_mm: 1.5 };
  expect(session.checks.wall_mm).toBe(1.5);
});
