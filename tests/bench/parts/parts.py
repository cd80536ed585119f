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


def gaps(occ):
    """Six tubes, one in the other, with narrow gaps between them."""
    for i in range(6):
        outer = occ.addCylinder(0, 0, 0, 0, 0, 2, 1.02 - 0.13 * i)
        inner = occ.addCylinder(0, 0, -1, 0, 0, 4, 0.92 - 0.13 * i)
        occ.cut([(3, outer)], [(3, inner)])
    return 0.052


def crowd(occ):
    """216 balls, blocks and rods that touch nowhere."""
    for i in range(216):
        x, y, z = i % 6, i // 6 % 6, i // 36
        kind = (x + 2 * y + 3 * z) % 3
        if kind == 0:
            occ.addSphere(x, y, z, 0.42)
        elif kind == 1:
            occ.addBox(x - 0.36, y - 0.36, z - 0.36, 0.72, 0.66, 0.6)
        else:
            occ.addCylinder(x, y, z - 0.45, 0.1, 0.05, 0.9, 0.3)
    return 0.125


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


class Corners:
    """The corners of a grid of hexahedra, numbered x first; an axis may close on itself."""

    def __init__(self, nx, ny, nz, closed_x=False):
        self.nx, self.ny, self.nz, self.closed_x = nx, ny, nz, closed_x
        self.row = nx if closed_x else nx + 1

    def at(self, i, j, k):
        return (k * (self.ny + 1) + j) * self.row + (i % self.nx if self.closed_x else i)

    def tetrahedra(self):
        """Six a hexahedron, round the diagonal from its corner 0 to its corner 6."""
        cells = []
        for k in range(self.nz):
            for j in range(self.ny):
                for i in range(self.nx):
                    square = ((i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j))
                    corners = [self.at(a, b, k + up) for up in (0, 1) for a, b in square]
                    for x, y in ((1, 2), (2, 3), (3, 7), (7, 4), (4, 5), (5, 1)):
                        cells.append((corners[0], corners[x], corners[y], corners[6]))
        return cells


def layer():
    """An O-grid round a cylinder whose first cells are 10,000 times as long as high."""
    around, out, up = 96, 26, 16
    heights = numpy.concatenate([[0], numpy.cumsum(1e-5 * 1.55 ** numpy.arange(out))])
    angles = 2 * math.pi * numpy.arange(around) / around
    points = [
        ((1 + h) * math.cos(a), (1 + h) * math.sin(a), 0.1 * k)
        for k in range(up + 1)
        for h in heights
        for a in angles
    ]
    cells = Corners(around, out, up, closed_x=True).tetrahedra()
    points = numpy.array(points)
    wall = numpy.hypot(points[:, 0], points[:, 1]) - 1
    fields = fieldsAt(points)
    fields["potential"] = (fields["potential"] * 0.1 + numpy.tanh(wall / 3e-3)).astype("f4")
    return points, numpy.array(cells), fields


def spring():
    """A wire of round section in eight turns."""
    across, along = 6, 640
    points = []
    for k in range(along + 1):
        angle = 2 * math.pi * 8 * k / along
        for j in range(across + 1):
            for i in range(across + 1):
                u, v = 2 * i / across - 1, 2 * j / across - 1
                # the square onto the disc
                r = 0.16 * max(abs(u), abs(v)) / max(math.hypot(u, v), 1e-12)
                radius, height = 1 + r * u, 0.075 * angle + r * v
                points.append((radius * math.cos(angle), radius * math.sin(angle), height))
    points = numpy.array(points)
    cells = Corners(across, across, along).tetrahedra()
    return points, numpy.array(cells), fieldsAt(points)


def gyroid():
    """A wall along the gyroid, cut out of a grid."""
    n = 44
    grid = Corners(n, n, n)
    axis = numpy.arange(n + 1) / n
    z, y, x = numpy.meshgrid(axis, axis, axis, indexing="ij")
    points = numpy.stack([x, y, z], -1).reshape(-1, 3)
    t = 4 * math.pi * points
    value = (
        numpy.sin(t[:, 0]) * numpy.cos(t[:, 1])
        + numpy.sin(t[:, 1]) * numpy.cos(t[:, 2])
        + numpy.sin(t[:, 2]) * numpy.cos(t[:, 0])
    )
    points, cells = inside(points, grid.tetrahedra(), abs(value) - 0.62)
    return points, cells, fieldsAt(points)


def inside(points, cells, value):
    """The part of a mesh where a value at its points is negative. Points near 0 count as on it."""
    value = numpy.where(abs(value) < 0.06, 0, value)
    points, cuts, out = [tuple(p) for p in points], {}, []

    def cut(a, b):
        if value[b] == 0:
            return b
        if (a, b) not in cuts:
            share = value[a] / (value[a] - value[b])
            at = tuple(p + share * (q - p) for p, q in zip(points[a], points[b]))
            cuts[a, b] = len(points)
            points.append(at)
        return cuts[a, b]

    def prism(low, high):
        # the vertex with the least number has the diagonals of its two sides
        turn = min(range(6), key=lambda i: (low + high)[i])
        if turn > 2:
            low, high = high, low
        low, high = low[turn % 3 :] + low[: turn % 3], high[turn % 3 :] + high[: turn % 3]
        out.append((low[0], *high))
        if min(low[1], high[2]) < min(low[2], high[1]):
            out.extend([(low[0], low[1], low[2], high[2]), (low[0], low[1], high[2], high[1])])
        else:
            out.extend([(low[0], low[1], low[2], high[1]), (low[0], low[2], high[2], high[1])])

    for cell in cells:
        ins = [v for v in cell if value[v] < 0]
        outs = [v for v in cell if value[v] >= 0]
        if not ins:
            continue
        if len(ins) == 4:
            out.append(tuple(cell))
        elif len(ins) == 1:
            out.append((ins[0], *(cut(ins[0], b) for b in outs)))
        elif len(ins) == 2:
            prism(*([a, cut(a, outs[0]), cut(a, outs[1])] for a in ins))
        else:
            prism(ins, [cut(a, outs[0]) for a in ins])
    used, cells = numpy.unique(
        numpy.array([c for c in out if len(set(c)) == 4]), return_inverse=True
    )
    return numpy.array(points)[used], cells.reshape(-1, 4)


SOLIDS = {
    "housing": housing,
    "shell": shell,
    "tubes": tubes,
    "nested": nested,
    "turbine": turbine,
    "gaps": gaps,
    "crowd": crowd,
}
GRIDS = {"layer": layer, "spring": spring, "gyroid": gyroid}


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
    for name in names or [*SOLIDS, *GRIDS]:
        points, cells, fields = GRIDS[name]() if name in GRIDS else solid(name)
        path = pathlib.Path(folder) / f"{name}.vtu"
        meshio.write(path, meshio.Mesh(points, [("tetra", cells)], point_data=fields))
        print(f"{path}: {len(cells)} tetrahedra, {len(points)} points")


if __name__ == "__main__":
    main(*sys.argv[1:])
