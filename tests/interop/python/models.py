"""Writes models with lib3mf and trimesh to a folder, and prints what a reader should find in each: bounds and volume in millimetres."""

import json
import sys

import lib3mf
import numpy
import trimesh
from lib3mf import get_wrapper

folder = sys.argv[1]
wrapper = get_wrapper()
UNITS = {"micron": ("MicroMeter", 0.001), "millimeter": ("MilliMeter", 1), "centimeter": ("CentiMeter", 10),
         "inch": ("Inch", 25.4), "foot": ("Foot", 304.8), "meter": ("Meter", 1000)}

def add(model, solid):
    positions, triangles = [], []
    for corner in solid.vertices:
        p = lib3mf.Position()
        for axis in range(3):
            p.Coordinates[axis] = float(corner[axis])
        positions.append(p)
    for corners in solid.faces:
        t = lib3mf.Triangle()
        for axis in range(3):
            t.Indices[axis] = int(corners[axis])
        triangles.append(t)
    made = model.AddMeshObject()
    made.SetGeometry(positions, triangles)
    return made

def transform(matrix):
    t = lib3mf.Transform()
    for row in range(4):
        for column in range(3):
            t.Fields[row][column] = float(matrix[column][row])
    return t

def told(name, solids, mm, unit, skipped=0):
    whole = trimesh.util.concatenate(solids)
    bounds = (whole.bounds * mm).tolist()
    volume = float(sum(solid.volume for solid in solids)) * mm**3
    facts = {"name": name, "bounds": bounds, "volume": volume, "facets": len(whole.faces)}
    return {**facts, "unit": unit, "skipped": skipped}

def write(model, name):
    model.QueryWriter("3mf").WriteToFile(f"{folder}/{name}")

out = []
ball = trimesh.creation.icosphere(subdivisions=3, radius=4.0)
box = trimesh.creation.box((1.0, 2.0, 3.0))
for unit, (constant, mm) in UNITS.items():
    model = wrapper.CreateModel()
    model.SetUnit(getattr(lib3mf.ModelUnit, constant))
    model.AddBuildItem(add(model, ball), wrapper.GetIdentityTransform())
    write(model, f"{unit}.3mf")
    out.append(told(f"{unit}.3mf", [ball], mm, unit))

# Components inside components, one of them mirrored, in two items.
turn = trimesh.transformations.rotation_matrix(0.7, (1, 2, 3), (0, 1, 0))
mirror = numpy.diag((-1.0, 1.0, 1.0, 1.0))
mirror[0, 3] = 20
lift = trimesh.transformations.translation_matrix((0, 0, 9)) @ numpy.diag((2.0, 2.0, 2.0, 1.0))
for apart in (False, True):
    model = wrapper.CreateModel()
    model.SetUnit(lib3mf.ModelUnit.MilliMeter)
    leaf, other = add(model, ball), add(model, box)
    inner = model.AddComponentsObject()
    inner.AddComponent(leaf, transform(turn))
    inner.AddComponent(other, transform(mirror @ turn))
    outer = model.AddComponentsObject()
    outer.AddComponent(inner, transform(lift))
    outer.AddComponent(other, wrapper.GetIdentityTransform())
    support = add(model, box)
    support.SetType(lib3mf.ObjectType.Support)
    model.AddBuildItem(outer, transform(mirror))
    model.AddBuildItem(leaf, transform(turn))
    model.AddBuildItem(support, wrapper.GetIdentityTransform())
    if apart:
        part = model.FindOrCreatePackagePart("/3D/Objects/object_1.model")
        leaf.SetPackagePart(part)
        other.SetPackagePart(part)
    solids = [solid.copy().apply_transform(matrix) for solid, matrix in [
        (ball, mirror @ lift @ turn), (box, mirror @ lift @ mirror @ turn), (box, mirror), (ball, turn)]]
    name = "apart.3mf" if apart else "nested.3mf"
    write(model, name)
    out.append(told(name, solids, 1, "millimeter", 1))

# trimesh's own writers.
scene = trimesh.Scene()
scene.add_geometry(ball, node_name="a", transform=turn)
scene.add_geometry(box, node_name="b", transform=lift)
scene.add_geometry(box, node_name="c", transform=lift @ turn)
solids = [ball.copy().apply_transform(turn), box.copy().apply_transform(lift), box.copy().apply_transform(lift @ turn)]
scene.export(f"{folder}/trimesh.3mf")
out.append(told("trimesh.3mf", solids, 1, "millimeter"))
trimesh.util.concatenate(solids).export(f"{folder}/trimesh.obj")
out.append(told("trimesh.obj", solids, 1, None))
ball.export(f"{folder}/ball.stl")
out.append(told("ball.stl", [ball], 1, None))
print(json.dumps(out))
