import { beforeEach, expect, test } from "vitest";
import { SCHEMA, type OrientCall, type OrientationReport } from "../../api/index.js";
import { SlicerError } from "../../api/error.js";
import type { Candidate, Options, SearchOptions } from "../../api/wire.js";
import { AIMS, type Aims, isPose, OrientationSearch, type Subject } from "./orientation.js";
import { coloursOf, energyRange } from "../panels/orientation-sphere.js";
import { metricRows } from "../panels/orientation-panel.js";
import { moved, stepped } from "../parts/sphere-steps.js";
import { languageOf } from "../../texts/index.js";
import { colourAt } from "../../view/legend/palette.js";
import type { Triple } from "../../view/scene/pose.js";

const candidate = (energy: number | null, patch: Partial<Candidate> = {}): Candidate => ({
  direction: [0, 0, 1],
  rotation: [0, 0, 0, 1],
  size_mm: [1, 2, 3],
  excluded: null,
  metrics: { layers: 1200, print_time_s: 3600, max_error: 0.06, roughness_mm: 0.0123, overhang_mm2: 50, islands: 0, cups_mm2: 0, support_ml: 0, contact_mm2: 0 },
  energy,
  ...patch,
});

interface Asked {
  options: Options;
  search: SearchOptions;
  call: OrientCall;
  answer(candidates: Candidate[], best?: Candidate[]): Promise<void>;
  refuse(error: unknown): Promise<void>;
}

let asked: Asked[];
/** Directions to measure, each with a function that settles it. */
let measuring: { direction: readonly number[]; answer(candidate: Candidate): Promise<void> }[];
let subject: Subject | null;
let failures: unknown[];
let directions: OrientationSearch;

const settle = (): Promise<unknown> => new Promise((resolve) => setTimeout(resolve));
const last = (): Asked => {
  const call = asked.at(-1);
  if (call === undefined) throw new Error("no search was asked for");
  return call;
};

beforeEach(() => {
  asked = [];
  measuring = [];
  failures = [];
  subject = { name: "a.stl", options: { tolerance: 0.05 }, weights: null };
  const orient = (options: Options = {}, search: SearchOptions = {}, call: OrientCall = {}): Promise<OrientationReport> =>
    new Promise((resolve, reject) => {
      call.signal?.addEventListener("abort", () => reject(call.signal?.reason));
      asked.push({
        ...{ options, search, call },
        answer: async (candidates, best = candidates.slice(0, 3)) => {
          resolve({ schema: SCHEMA, candidates, best });
          await settle();
        },
        refuse: async (error) => {
          reject(error);
          await settle();
        },
      });
    });
  const host = {
    subject: () => subject,
    changed: () => undefined,
    progressed: () => undefined,
    failed: (error: unknown) => void failures.push(error),
  };
  const measure = (_: Options, direction: readonly number[]): Promise<Candidate> =>
    new Promise((resolve) => {
      const answer = async (candidate: Candidate): Promise<void> => {
        resolve(candidate);
        await settle();
      };
      measuring.push({ direction, answer });
    });
  directions = new OrientationSearch(host, { orient, measure });
});

test("a search shows measured candidates, its progress, and finally the best", async () => {
  void directions.start();
  expect(directions.busy).toMatchObject({ task: "orient", stage: "orientation" });
  last().call.onProgress?.("orientation", 0.5, 0.5);
  const found = { directions: new Float64Array(6), candidates: [candidate(1), null] };
  last().call.onCandidates?.(found);
  expect(directions.busy).toMatchObject({ fraction: 0.5 });
  expect(directions.found).toBe(found);
  await last().answer([candidate(1), candidate(2)]);
  expect(directions.busy).toBeNull();
  expect(directions.best).toHaveLength(2);
  expect(directions.isCurrent).toBe(true);
});

test("without a model, or with invalid settings, no search starts", () => {
  subject = null;
  void directions.start();
  expect(asked).toEqual([]);
});

test("new aims rate the measured candidates again; aims changed during a search are rated once, at its end", async () => {
  void directions.start();
  const measured = [candidate(1), candidate(2)];
  const ranked = (islands: number): Aims["ranking"] => ({ ...AIMS.ranking, islands });
  directions.aim({ ranking: ranked(2) });
  directions.aim({ ranking: ranked(1) });
  await last().answer(measured);
  expect(asked.map(({ search }) => search.ranking?.islands)).toEqual([3, 1]);
  expect(last().call.measured).toBe(measured);
  await last().answer(measured);
  expect(directions.busy).toBeNull();
  directions.aim({ most_islands: 2 });
  expect(last().search).toEqual({ ...AIMS, ranking: ranked(1), most_islands: 2 });
  expect(last().call.measured).toBe(measured);
});

test("a cancelled search keeps what it measured, and ignores late results", async () => {
  void directions.start();
  const { call } = last();
  const found = { directions: new Float64Array(3), candidates: [candidate(1)] };
  call.onCandidates?.(found);
  directions.cancel();
  expect(call.signal?.aborted).toBe(true);
  call.onCandidates?.({ directions: new Float64Array(3), candidates: [null] });
  call.onProgress?.("orientation", 1, 1);
  await settle();
  expect(directions.found).toBe(found);
  expect(directions.busy).toBeNull();
  expect(failures).toEqual([]);
});

test("an error ends the search and is reported", async () => {
  void directions.start();
  const error = new SlicerError("crash", "no", { system: "no" });
  await last().refuse(error);
  expect(failures).toEqual([error]);
  expect(directions.busy).toBeNull();
});

test("a search is outdated when something changes that it depends on, and only then", async () => {
  void directions.start();
  await last().answer([candidate(1)]);
  const given = subject;
  if (given === null) throw new Error("there is a subject");
  const isCurrent = (change: Partial<Options>, weights: Float32Array | null = null): boolean => {
    subject = { ...given, options: { ...given.options, ...change }, weights };
    return directions.isCurrent;
  };
  expect(isCurrent({ rotation: [1, 0, 0, 0], rays: 512, backend: "cpu", format: "uvj" })).toBe(true);
  expect(isCurrent({ tolerance: 0.06 })).toBe(false);
  expect(isCurrent({ layer_max_mm: 0.2 })).toBe(false);
  expect(isCurrent({ printer: "mars-4-ultra" })).toBe(false);
  expect(isCurrent({}, new Float32Array(1))).toBe(false);
  // Without supports, medium ones are estimated; the places of points do not matter.
  expect(isCurrent({ supports: {} })).toBe(true);
  expect(isCurrent({ supports: { strength: "medium", points: [{ at_mm: [0, 0, 1] }], fill: true, protect: true } })).toBe(true);
  expect(isCurrent({ supports: { strength: "heavy" } })).toBe(false);
  expect(isCurrent({ supports: { profile: { contact_mm: 0.5 } } })).toBe(false);
  directions.aim({ most_islands: 9 });
  expect(asked).toHaveLength(1);
  expect(isCurrent({})).toBe(true);
});

test("a height belongs to the pose: the search is outdated by another rotation, not by applying a candidate", async () => {
  const options: Options = { height_mm: 50, rotation: [0, 0, 0, 1] };
  subject = { name: "a.stl", options, weights: null };
  void directions.start();
  await last().answer([candidate(1)]);
  subject = { name: "a.stl", options: { ...options, rotation: [1, 0, 0, 0] }, weights: null };
  expect(directions.isCurrent).toBe(false);
  const applied: Options = { height_mm: 30, rotation: [0, 1, 0, 0] };
  directions.applied(applied);
  subject = { name: "a.stl", options: applied, weights: null };
  expect(directions.isCurrent).toBe(true);
});

/** Changes the pose of the model, as a user does. */
function pose(rotation: Options["rotation"]): void {
  if (subject !== null) subject = { ...subject, options: { ...subject.options, rotation } };
}

test("the pose now is that of a candidate, if there is one, and else it is measured once", async () => {
  const [upright, over] = [candidate(1), candidate(2, { rotation: [1, 0, 0, 0] })];
  void directions.start();
  await directions.measure();
  expect(directions.now).toBeNull();
  await last().answer([upright, over]);
  expect(directions.now).toEqual({ rotation: [0, 0, 0, 1], candidate: upright });
  pose([1, 0, 0, 0]);
  await directions.measure();
  expect(directions.now).toEqual({ rotation: [1, 0, 0, 0], candidate: over });
  expect(measuring).toEqual([]);

  // Lying on its side: the file's −y is up.
  const turned = [Math.SQRT1_2, 0, 0, -Math.SQRT1_2] as [number, number, number, number];
  pose(turned);
  void directions.measure();
  expect(measuring[0]?.direction.map((part) => Math.round(part * 1e6) / 1e6 + 0)).toEqual([0, -1, 0]);
  const third = candidate(null, { rotation: turned });
  await measuring[0]?.answer(third);
  expect(directions.now).toEqual({ rotation: turned, candidate: third });
  void directions.measure();
  expect(measuring).toHaveLength(1);
});

test("a pose is not measured for settings that the search was not for, and a late answer is not that of another pose", async () => {
  void directions.start();
  await last().answer([candidate(1)]);
  const before = directions.now;
  pose([0, 0.6, 0, 0.8]);
  const given = subject;
  if (given === null) throw new Error("there is a subject");
  subject = { ...given, options: { ...given.options, tolerance: 0.1 } };
  await directions.measure();
  expect(measuring).toEqual([]);

  subject = given;
  void directions.measure();
  pose([0.6, 0, 0, 0.8]);
  await measuring[0]?.answer(candidate(9));
  expect(directions.now).toBe(before);
  void directions.start();
  expect(directions.now).toBeNull();
});

test("poses are the same to the digits that settings keep", () => {
  expect(isPose([0, 0, 1e-7, 1], [0, 0, 0, 1])).toBe(true);
  expect(isPose([0, 0, 1e-5, 1], [0, 0, 0, 1])).toBe(false);
  expect(isPose(undefined, [0, 0, 0, 1])).toBe(false);
});

test("energies have the colours of the scale, the lowest that of the thickest layer, excluded directions grey, unknown ones clear", () => {
  const candidates = [candidate(0.4), candidate(0.8), candidate(0.6), candidate(null, { excluded: "too-high" }), null, candidate(null)];
  expect(energyRange(candidates)).toEqual([0.4, 0.8]);
  expect(energyRange([null])).toBeNull();
  const [least, greatest, middle, excluded, unknown, unrated] = coloursOf(candidates);
  expect(least).toEqual(colourAt(1));
  expect(greatest).toEqual(colourAt(0));
  expect(middle).toEqual(colourAt(0.5));
  if (excluded == null) throw new Error("what does not fit has a colour");
  expect(Math.max(...excluded) - Math.min(...excluded)).toBeLessThan(20);
  expect([unknown, unrated]).toEqual([null, null]);
  expect(coloursOf([candidate(1)])).toEqual([colourAt(1)]);
});

test("metrics are written in the language; an excluded candidate has only its size", () => {
  const { format } = languageOf("en");
  const rows = Object.fromEntries(metricRows(candidate(0.5), "cusp", languageOf("en")).map(([name, value]) => [name, value]));
  expect(rows).toEqual({
    Layers: "1,200",
    "Print time": format.time(3600),
    "Largest step": "0.06\u00a0mm",
    Roughness: "12.3\u00a0µm",
    Overhang: "50\u00a0mm²",
    Islands: "0",
    "Suction areas": "0\u00a0mm²",
    Supports: "0\u00a0ml",
    Contacts: "0\u00a0mm²",
    Size: "1.0 × 2.0 × 3.0\u00a0mm",
    Score: "0.5",
  });
  const out = candidate(null, { metrics: null, excluded: "too-large" });
  expect(metricRows(out, "cusp", languageOf("en")).map(([name]) => name)).toEqual(["Size"]);
});

test("arrow keys go where they point, on either side, and around the rim", () => {
  const front: Triple = [0, 0, 1];
  expect(moved(front, "right", 30)[0]).toBeCloseTo(0.5, 12);
  expect(moved(front, "left", 30)[0]).toBeCloseTo(-0.5, 12);
  expect(moved(front, "up", 30)[1]).toBeCloseTo(0.5, 12);
  expect(moved(front, "down", 30)[1]).toBeCloseTo(-0.5, 12);
  // In the rear view, right is to the left of the front view.
  expect(moved([0, 0, -1], "right", 30)[0]).toBeCloseTo(-0.5, 12);
  expect(moved([0, 0, -1], "up", 30)[1]).toBeCloseTo(0.5, 12);
  expect(moved(front, "right", 120)[2]).toBeCloseTo(-0.5, 12);
  // Steps end at the top.
  expect(moved([0, Math.sin(1.5), Math.cos(1.5)], "up", 30)[1]).toBeCloseTo(1, 12);
});

test("a step goes to the first other direction, and stays if there is none", () => {
  const byLongitude = ([x, , z]: Triple): number => Math.floor((Math.atan2(x, z) / Math.PI) * 18 + 18.5);
  const start = byLongitude([0, 0, 1]);
  expect(stepped([0, 0, 1], "right", byLongitude)).toBe(start + 1);
  expect(stepped([0, 0, 1], "left", byLongitude)).toBe(start - 1);
  expect(stepped([0, 0, 1], "up", byLongitude)).toBe(start);
  // At the top, left and right lead to the two sides.
  const bySide = ([x, y]: Triple): number => (y > 0.9 ? 0 : Math.sign(x));
  expect(stepped([0, 1, 0], "right", bySide)).toBe(1);
  expect(stepped([0, 1, 0], "left", bySide)).toBe(-1);
});
