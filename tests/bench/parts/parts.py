#!/usr/bin/env python3
"""Meshes of parts that nobody tuned to, made with Gmsh's Python module (Debian: python3-gmsh).

    tests/bench/parts/parts.py FOLDER [NAME...]

It writes FOLDER/NAME.vtu: the tetrahedra, a scalar point field `potential` (smooth, steep in few
places) and a vector point field `flow`. The same Gmsh gives the same mesh.
"""

import math
import pathlib
import sys

import meshio
import numpy

AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def housing(occ):
    """A box with thin walls, and 17 x 9 + 2 x 5 x 9 holes in them."""
    outer = occ.addBox(0, 0, 0, 9, 5, 3)
    inner = occ.addBox(0.25, 0.25, 0.25, 8.5, 4.5, 2.5)
    holes = [
        (3, occ.addCylinder(0.5 + 0.5 * i, 0.5 + 0.5 * j, -1, 0, 0, 5, 0.13))
        for i in range(17)
        for j in range(9)
    ]
    holes += [
        (3, occ.addCylinder(0.9 + 0.8 * i, -1, 0.6 + 0.45 * j, 0, 7, 0, 0.12))
        for i in range(10)
        for j in range(5)
    ]
    occ.cut([(3, outer)], [(3, inner), *holes])
    return 0.095


def shell(occ):
    """A spherical cap, 1/50 of its radius thick."""
    outer, inner = occ.addSphere(0, 0, 0, 1), occ.addSphere(0, 0, 0, 0.98)
    cap, _ = occ.cut([(3, outer)], [(3, inner)])
    occ.cut(cap, [(3, occ.addBox(-2, -2, -2, 4, 4, 2.3))])
    return 0.014


def tubes(occ):
    """A tree of tubes that fork four times, each fork thinner."""
    parts = []

    def grow(start, direction, side, length, radius, forks):
        end = [start[a] + length * direction[a] for a in range(3)]
        parts.append((3, occ.addCylinder(*start, *(length * d for d in direction), radius)))
        parts.append((3, occ.addSphere(*end, radius * 1.02)))
        if forks == 0:
            return
        third = numpy.cross(direction, side)
        for sign in (1, -1):
            angle = sign * 0.62
            turned = math.cos(angle) * numpy.array(direction) + math.sin(angle) * numpy.array(side)
            grow(end, turned.tolist(), third.tolist(), 0.78 * length, 0.72 * radius, forks - 1)

    grow((0.0, 0.0, 0.0), AXES[2], AXES[0], 2.0, 0.3, 4)
    occ.fuse(parts[:1], parts[1:])
    return 0.05


def nested(occ):
    """Two balls in a block, one within the other, and a block that touches it."""
    block = occ.addBox(-1, -1, -1, 2, 2, 2)
    ball, core = occ.addSphere(0, 0, 0, 0.8), occ.addSphere(0.1, 0, 0, 0.4)
    touching = occ.addBox(1, -0.5, -0.5, 0.8, 1, 1)
    occ.fragment([(3, block)], [(3, ball), (3, core), (3, touching)])
    return 0.062


def turbine(occ):
    """A hub with eleven twisted blades in a ring."""
    hub = occ.addCylinder(0, 0, 0, 0, 0, 1.2, 1)
    bore = occ.addCylinder(0, 0, -1, 0, 0, 4, 0.45)
    ring, inside = occ.addCylinder(0, 0, 0.1, 0, 0, 1, 2.6), occ.addCylinder(
        0, 0, -1, 0, 0, 4, 2.45
    )
    rim, _ = occ.cut([(3, ring)], [(3, inside)])
    blades = []
    for i in range(11):
        loops = []
        for radius, twist, chord in ((0.8, 0.3, 0.9), (1.6, 0.75, 0.8), (2.5, 1.1, 0.75)):
            corners = [
                occ.addPoint(
                    radius,
                    chord * u * math.sin(twist) - v * math.cos(twist),
                    0.6 + chord * u * math.cos(twist) + v * math.sin(twist),
                )
                for u, v in ((-0.5, 0), (0, 0.06), (0.5, 0), (0, -0.06))
            ]
            lines = [occ.addLine(corners[k], corners[(k + 1) % 4]) for k in range(4)]
            loops.append(occ.addCurveLoop(lines))
        blade = occ.addThruSections(loops, makeSolid=True)
        occ.rotate(blade, 0, 0, 0, 0, 0, 1, 2 * math.pi * i / 11)
        blades += blade
    whole, _ = occ.fuse([(3, hub)], [*blades, *rim])
    occ.cut(whole, [(3, bore)])
    return 0.055


def fieldsAt(points):
    low, high = points.min(0), points.max(0)
    q = (points - low) / (high - low).max()
    potential, flow = numpy.zeros(len(q)), numpy.zeros(q.shape)
    for place, strength, width in (
        ((0.2, 0.3, -0.1), 1.0, 0.3),
        ((0.8, 0.5, 0.4), -0.7, 0.2),
        ((0.4, 0.9, 0.2), 0.5, 0.15),
    ):
        away = q - numpy.array(place)
        distance = numpy.sqrt((away**2).sum(1) + width**2)
        potential += strength / distance
        flow += (strength / distance**3)[:, None] * numpy.cross(away, (0.3, 0.5, 0.8))
    return {"potential": potential.astype("f4"), "flow": flow.astype("f4")}


def layer():
    """An O-grid round a cylinder whose first cells are 10,000 times as long as high."""
    around, up, out = 96, 16, 26
    heights = numpy.concatenate([[0], numpy.cumsum(1e-5 * 1.55 ** numpy.arange(out))])
    radii = 1 + heights
    angles = 2 * math.pi * numpy.arange(around) / around
    points = [
        (r * math.cos(a), r * math.sin(a), 0.1 * k)
        for k in range(up + 1)
        for r in radii
        for a in angles
    ]

    def at(k, r, a):
        return (k * (out + 1) + r) * around + a % around

    cells = []
    for k in range(up):
        for r in range(out):
            for a in range(around):
                low = [at(k, r, a), at(k, r + 1, a), at(k, r + 1, a + 1), at(k, r, a + 1)]
                high = [
                    at(k + 1, r, a),
                    at(k + 1, r + 1, a),
                    at(k + 1, r + 1, a + 1),
                    at(k + 1, r, a + 1),
                ]
                corners = low + high
                # six tetrahedra round the diagonal from corner 0 to corner 6
                for x, y in ((1, 2), (2, 3), (3, 7), (7, 4), (4, 5), (5, 1)):
                    cells.append((corners[0], corners[x], corners[y], corners[6]))
    points = numpy.array(points)
    wall = numpy.hypot(points[:, 0], points[:, 1]) - 1
    fields = fieldsAt(points)
    fields["potential"] = (fields["potential"] * 0.1 + numpy.tanh(wall / 3e-3)).astype("f4")
    return points, numpy.array(cells), fields


SOLIDS = {"housing": housing, "shell": shell, "tubes": tubes, "nested": nested, "turbine": turbine}


def solid(name):
    import gmsh

    gmsh.initialize(["", "-v", "1"])
    gmsh.option.setNumber("General.NumThreads", 1)
    size = SOLIDS[name](gmsh.model.occ)
    gmsh.model.occ.synchronize()
    gmsh.option.setNumber("Mesh.MeshSizeMin", size)
    gmsh.option.setNumber("Mesh.MeshSizeMax", size)
    gmsh.model.mesh.generate(3)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    _, corners = gmsh.model.mesh.getElementsByType(4)
    gmsh.finalize()
    used, cells = numpy.unique(corners, return_inverse=True)
    order = numpy.argsort(tags)
    points = coordinates.reshape(-1, 3)[order[numpy.searchsorted(tags[order], used)]]
    return points, cells.reshape(-1, 4), fieldsAt(points)


def main(folder, *names):
    for name in names or [*SOLIDS, "layer"]:
        points, cells, fields = layer() if name == "layer" else solid(name)
        path = pathlib.Path(folder) / f"{name}.vtu"
        meshio.write(path, meshio.Mesh(points, [("tetra", cells)], point_data=fields))
        print(f"{path}: {len(cells)} tetrahedra, {len(points)} points")


if __name__ == "__main__":
    main(*sys.argv[1:])
