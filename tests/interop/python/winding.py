"""Prints the generalised winding number of points, by libigl: a list for each STL and list of points in a folder."""

import json
import sys
from pathlib import Path

import igl
import numpy
import trimesh

out = {}
for path in sorted(Path(sys.argv[1]).glob("*.stl")):
    mesh = trimesh.load(path)
    points = numpy.loadtxt(path.with_suffix(".txt"))
    out[path.stem] = igl.winding_number(mesh.vertices.astype(float), mesh.faces.astype("int64"), points).tolist()
print(json.dumps(out))
