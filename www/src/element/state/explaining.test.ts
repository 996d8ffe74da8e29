import { expect, test, vi } from "vitest";
import { SlicerError } from "../../api/error.js";
import { languageOf } from "../../texts/index.js";
import { Explaining } from "./explaining.js";
import type { Failure } from "./problem.js";
import { DEFAULT_SETTINGS } from "./settings.js";

const [english, german] = [languageOf("en"), languageOf("de")];
const fixed = new Set<never>();

const failed = (name: string): Failure => ({ error: new SlicerError("file-empty", "the core's sentence", null), task: "open", name, settings: DEFAULT_SETTINGS, height_mm: null });

test("a failure is in words once these are fetched, and keeps them until those of another language are", async () => {
  const changed = vi.fn<() => void>();
  const explaining = new Explaining(changed);
  const failure = failed("a.stl");
  expect(explaining.of(null, english, fixed)).toBeNull();
  expect(explaining.of(failure, english, fixed)).toBeNull();
  await vi.waitFor(() => expect(changed).toHaveBeenCalledOnce());
  expect(explaining.of(failure, english, fixed)?.title).toBe("a.stl is empty");
  expect(explaining.of(failure, german, fixed)?.title).toBe("a.stl is empty");
  await vi.waitFor(() => expect(changed).toHaveBeenCalledTimes(2));
  expect(explaining.of(failure, german, fixed)?.title).toBe("a.stl ist leer");
  expect(changed).toHaveBeenCalledTimes(2);
});

test("words that come too late are of no failure", async () => {
  const changed = vi.fn<() => void>();
  const explaining = new Explaining(changed);
  explaining.of(failed("a.stl"), english, fixed);
  expect(explaining.of(null, english, fixed)).toBeNull();
  expect(explaining.of(failed("b.stl"), english, fixed)).toBeNull();
  await vi.waitFor(() => expect(changed).toHaveBeenCalled());
  expect(changed).toHaveBeenCalledOnce();
});

test("without a connection the core's sentence stands in", async () => {
  vi.doMock("./problem.js", () => {
    throw new Error("offline");
  });
  const changed = vi.fn<() => void>();
  const explaining = new Explaining(changed);
  const failure = failed("a.stl");
  explaining.of(failure, english, fixed);
  await vi.waitFor(() => expect(changed).toHaveBeenCalled());
  expect(explaining.of(failure, english, fixed)).toMatchObject({ code: "file-empty", title: "the core's sentence", offers: [] });
  vi.doUnmock("./problem.js");
});
