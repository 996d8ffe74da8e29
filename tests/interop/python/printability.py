"""The checks of printability by SciPy: components by label(), distances by the exact Euclidean distance transform.

Reads the layers of a plan as `printability.py JOB.json LIT.raw`, one byte for each pixel, and prints for each kind of finding
[first layer, last layer, pixels times bins], by the definitions of docs/printability.md.
"""

import json
import sys

import numpy as np
from scipy import ndimage

# As in the checks: a distance that equals a limit up to rounding does not exceed it.
ROUNDING = 1 + 1e-9

SIX = ndimage.generate_binary_structure(3, 1)
FOUR = ndimage.generate_binary_structure(2, 1)


def pieces(volume, bins):
    """What hangs together: its first and last layer, its pixels times bins, and its pixels in each layer."""
    labels, _ = ndimage.label(volume, SIX)
    for label, box in enumerate(ndimage.find_objects(labels), start=1):
        first, last = box[0].start, box[0].stop - 1
        pixels = (labels[box] == label).sum(axis=(1, 2))
        yield first, last, int(pixels @ bins[first : last + 1]), pixels


def beyond(pixels, others, limit_mm, pitch_mm):
    """Those of some pixels that are farther than a limit from all others."""
    if not others.any():
        return pixels.copy()
    distance_mm = ndimage.distance_transform_edt(~others, sampling=pitch_mm)
    return pixels & (distance_mm > limit_mm * ROUNDING)


def thin(solid, limit_mm, pitch_mm):
    """The pixels of a layer within whose reach no disc fits."""
    centres = beyond(solid, ~solid, max(limit_mm - max(pitch_mm), 0) / 2, pitch_mm)
    return beyond(solid, centres, limit_mm, pitch_mm)


def regions(planes, bins, bin_mm, least_px, least_mm=0.0):
    return [
        [first, last, volume]
        for first, last, volume, pixels in pieces(planes, bins)
        if pixels.max() >= least_px and bins[first : last + 1].sum() * bin_mm * ROUNDING >= least_mm
    ]


def overhangs(lit, bins, limits, bin_mm, pitch_mm):
    found = np.zeros_like(lit)
    supported = lit[0]
    for layer in range(1, len(lit)):
        labels, _ = ndimage.label(lit[layer], FOUR)
        touching = np.unique(labels[lit[layer - 1]])
        asking = lit[layer] & np.isin(labels, touching)
        run_mm = bins[layer] * bin_mm / limits["self_supporting_slope"]
        width_mm = max(run_mm + max(pitch_mm) / 2, max(pitch_mm))
        unsupported = beyond(asking, supported, width_mm, pitch_mm)
        supported = lit[layer] & ~unsupported
        far = beyond(unsupported, supported, limits["overhang_mm"], pitch_mm)
        held = far & bridged(unsupported, supported, limits["bridge_mm"], pitch_mm)
        supported = supported | held
        found[layer] = beyond(far & ~held, held, limits["overhang_mm"], pitch_mm)
    return found


def bridged(unsupported, supported, longest_mm, pitch_mm):
    """Unsupported pixels on a line that leads over such pixels to a supported one on both sides."""
    found = np.zeros_like(unsupported)
    lines = [(0, 1), (1, 0), (1, 1), (1, -1), (1, 2), (1, -2), (2, 1), (2, -1)]
    for down, right in lines:
        one = steps(unsupported, supported, down, right)
        other = steps(unsupported, supported, -down, -right)
        step_mm = np.hypot(down * pitch_mm[0], right * pitch_mm[1])
        found |= (one + other - 1) * step_mm <= longest_mm * ROUNDING
    return found


def steps(unsupported, supported, down, right):
    """How many steps each unsupported pixel is from a supported one, with no other but unsupported ones between."""
    steps = np.full(unsupported.shape, np.inf)
    reached = supported
    for step in range(1, max(unsupported.shape)):
        padded = np.pad(reached, 2)
        rows, columns = reached.shape
        reached = padded[2 - down : 2 - down + rows, 2 - right : 2 - right + columns] & unsupported
        if not reached.any():
            break
        steps[reached] = step
    return steps


def narrow_drains(lit, dark, bins, limits, pitch_mm):
    """Hollows, none of them traps, in which no disc of a drain's width finds its way out."""
    radius_mm = (limits["drain_mm"] - max(pitch_mm)) / 2
    rooms = np.stack([beyond(~layer, layer, radius_mm, pitch_mm) for layer in lit])
    labels, _ = ndimage.label(rooms, SIX)
    out = np.union1d(labels[[0, -1]], labels[:, 0, 0])
    hollows, _ = ndimage.label(dark, SIX)
    for label, box in enumerate(ndimage.find_objects(labels), start=1):
        pixels = labels[box] == label
        first, last = box[0].start, box[0].stop - 1
        is_trap = hollows[: len(lit)][box][pixels][0] != hollows[0, 0, 0]
        if label not in out and not is_trap:
            yield [first, last, int(pixels.sum(axis=(1, 2)) @ bins[first : last + 1])]


def without_support(lit):
    """Components of layers of which nothing stands on lit pixels: islands to UVtools, whatever share of them it asks for."""
    for layer in range(1, len(lit)):
        labels, count = ndimage.label(lit[layer], FOUR)
        supporting = ndimage.sum_labels(lit[layer - 1], labels, range(1, count + 1))
        yield from ([layer, layer, 0] for pixels in supporting if pixels == 0)


def main(job, lit):
    bins, bin_mm, limits = np.array(job["bins"]), job["bin_mm"], job["limits"]
    pitch_mm = job["pitch_y_mm"], job["pitch_mm"]
    pad = job["pad"]
    # A margin of dark pixels, and a dark layer on top; the plate is below.
    lit = np.pad(lit, [(0, 0), (pad, pad), (pad, pad)])
    dark = np.pad(~lit, [(0, 1), (0, 0), (0, 0)], constant_values=True)
    bodies = list(pieces(lit, bins))
    layered = np.append(bins, 1)
    closed = [it for it in pieces(dark, layered) if it[1] < len(lit)]
    outside = ndimage.label(dark, SIX)[0]
    assert len(np.unique(outside[:, 0, 0])) == 1, "the margin is not one"
    walls = np.stack([thin(layer, limits["wall_mm"], pitch_mm) for layer in lit])
    gaps = np.stack([thin(~layer, limits["gap_mm"], pitch_mm) for layer in lit])
    gaps[:, :pad], gaps[:, -pad:], gaps[:, :, :pad], gaps[:, :, -pad:] = False, False, False, False
    least_px = limits["speck_px"]
    found = {
        "bodies": [[first, last, volume] for first, last, volume, _ in bodies],
        "loose": [[first, last, volume] for first, last, volume, _ in bodies if first > 0],
        "trap": [[first, last, volume] for first, last, volume, _ in closed],
        "narrow-drain": list(narrow_drains(lit, dark, bins, limits, pitch_mm)),
        "begins": list(without_support(lit)),
        "thin-wall": regions(walls, bins, bin_mm, least_px, limits["wall_mm"]),
        "narrow-gap": regions(gaps, bins, bin_mm, least_px, limits["gap_mm"]),
        "overhang": regions(overhangs(lit, bins, limits, bin_mm, pitch_mm), bins, bin_mm, least_px),
    }
    json.dump({code: sorted(all) for code, all in found.items()}, sys.stdout)


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        job = json.load(file)
    main(job, np.fromfile(sys.argv[2], np.uint8).reshape(job["shape"]).astype(bool))
