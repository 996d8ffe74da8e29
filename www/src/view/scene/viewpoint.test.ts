import { describe, expect, it } from "vitest";
import { areSame, between, eased, type Viewpoint } from "./viewpoint.js";

const far: Viewpoint = { position: [0, -100, 50], target: [0, 0, 10] };
const near: Viewpoint = { position: [6, -4, 13], target: [5, -2, 12] };
const away = ({ position, target }: Viewpoint): number => Math.hypot(...position.map((value, axis) => value - (target[axis] ?? 0)));

describe("the way between two places", () => {
  it("begins and ends there", () => {
    expect(areSame(between(far, near, 0), far)).toBe(true);
    expect(areSame(between(far, near, 1), near)).toBe(true);
    expect([eased(0), eased(0.5), eased(1)]).toEqual([0, 0.5, 1]);
  });

  it("comes nearer by equal factors, and never the other way", () => {
    const distances = [0, 0.25, 0.5, 0.75, 1].map((part) => away(between(far, near, part)));
    const factors = distances.slice(1).map((distance, i) => distance / (distances[i] ?? 1));
    for (const factor of factors) expect(factor).toBeCloseTo((away(near) / away(far)) ** 0.25, 6);
  });

  it("keeps the target in the line of sight's own scale: the way left shrinks as the distance does", () => {
    const left = (part: number): number => {
      const { target } = between(far, near, part);
      return Math.hypot(...target.map((value, axis) => value - (near.target[axis] ?? 0)));
    };
    const part = 0.6;
    const r = away(between(far, near, part));
    expect(left(part) / left(0)).toBeCloseTo((r - away(near)) / (away(far) - away(near)), 6);
  });

  it("turns about z the shorter way", () => {
    const at = (degrees: number): Viewpoint => {
      const angle = (degrees * Math.PI) / 180;
      return { position: [Math.cos(angle), Math.sin(angle), 0], target: [0, 0, 0] };
    };
    expect(areSame(between(at(170), at(-170), 0.5), at(180))).toBe(true);
  });
});

it("a place moved by more than rounding is another", () => {
  const [x, y, z] = far.position;
  expect(areSame(far, { ...far, position: [x, y, z + 1e-6] })).toBe(true);
  expect(areSame(far, { ...far, position: [x, y, z + 1] })).toBe(false);
});
