"""What these tests share."""

from __future__ import annotations

import os
import struct
from pathlib import Path

CUSP = os.path.abspath(os.environ["CUSP"])
# Seconds to wait before giving up.
PATIENCE = 100

Point = tuple[float, float]


def write_frustum(path: Path, base: list[Point], top: list[Point], height: float) -> None:
    """A binary STL of a solid between two polygons with the same number of corners."""
    low = [(x, y, 0.0) for x, y in base]
    high = [(x, y, height) for x, y in top]
    facets = []
    for i in range(len(base)):
        j = (i + 1) % len(base)
        facets += [(low[i], low[j], high[j]), (low[i], high[j], high[i])]
    for i in range(1, len(base) - 1):
        facets += [(low[0], low[i + 1], low[i]), (high[0], high[i], high[i + 1])]
    with path.open("wb") as file:
        file.write(bytes(80) + struct.pack("<I", len(facets)))
        for facet in facets:
            corners = [length for corner in facet for length in corner]
            file.write(struct.pack("<12fH", 0, 0, 0, *corners, 0))
