#!/usr/bin/env python3
"""Streamlines of the viewer's worker beside VTK's tracer, from the same seeds in the same mesh.

    streamlines.py BIN MODULE.wasm MESH.vtu FIELD [MESH.vtu FIELD ...]

BIN has qtet, MODULE.wasm is the decoder. Prints the rows of STREAMLINES.md. Each mesh is simplified
with default options. The worker's lines are those of the last level; VTK takes the file itself. The
distance is from the worker's places to VTK's line, over the first half of each line by length.
Needs python3-vtk9 and python3-numpy.
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

HERE = pathlib.Path(__file__).resolve().parent
SEEDS = 300
STEPS = 1000
# The part of a line that is compared, and the distance over the diagonal that counts as equal.
HALF = 0.5
NEAR = 0.01


def read(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def seeds_in(grid, count):
    """Centres of cells at equal distances in their order, which lie inside for certain."""
    out = []
    step = max(1, grid.GetNumberOfCells() // count)
    for cell in range(step // 2, grid.GetNumberOfCells(), step):
        points = vtk_to_numpy(grid.GetCell(cell).GetPoints().GetData())
        out.append([float(x) for x in points.mean(axis=0)])
    return out[:count]


def vtk_lines(grid, field, seeds):
    """By seed its line forwards, and the seconds of all."""
    grid.GetPointData().SetActiveVectors(field)
    points = vtk.vtkPoints()
    points.SetData(numpy_to_vtk(numpy.array(seeds), deep=True))
    source = vtk.vtkPolyData()
    source.SetPoints(points)
    tracer = vtk.vtkStreamTracer()
    tracer.SetInputData(grid)
    tracer.SetSourceData(source)
    tracer.SetIntegratorTypeToRungeKutta45()
    tracer.SetIntegrationDirectionToForward()
    tracer.SetMaximumNumberOfSteps(STEPS)
    box = numpy.array(grid.GetBounds()).reshape(3, 2)
    diagonal = float(numpy.linalg.norm(box[:, 1] - box[:, 0]))
    tracer.SetMaximumPropagation(3 * diagonal)
    tracer.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_POINTS, field)
    start = time.process_time()
    tracer.Update()
    seconds = time.process_time() - start
    out = tracer.GetOutput()
    places = vtk_to_numpy(out.GetPoints().GetData())
    ids = vtk_to_numpy(out.GetCellData().GetArray("SeedIds"))
    lines = {}
    for i in range(out.GetNumberOfCells()):
        cell = out.GetCell(i).GetPointIds()
        its = places[[cell.GetId(k) for k in range(cell.GetNumberOfIds())]]
        lines[int(ids[i])] = its
    return lines, seconds, len(places), diagonal


def lengths(line):
    return numpy.concatenate(
        [[0.0], numpy.cumsum(numpy.linalg.norm(numpy.diff(line, axis=0), axis=1))]
    )


def distance_to(line, place):
    a, b = line[:-1], line[1:]
    way = b - a
    square = numpy.maximum((way * way).sum(axis=1), 1e-300)
    share = numpy.clip(((place - a) * way).sum(axis=1) / square, 0, 1)
    return float(numpy.linalg.norm(a + share[:, None] * way - place, axis=1).min())


def largest_distance(ours, theirs):
    along = lengths(ours)
    half = ours[along <= HALF * min(along[-1], lengths(theirs)[-1])]
    return max(distance_to(theirs, place) for place in half)


def compare(qtet, module, mesh, field):
    grid = read(mesh)
    seeds = seeds_in(grid, SEEDS)
    theirs, seconds, steps, diagonal = vtk_lines(grid, field, seeds)
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder) / "mesh.qtet"
        subprocess.run([qtet, "simplify", mesh, "-o", log, "-q"], check=True)
        limits = {"steps": STEPS, "length": 3, "time": 1e300}
        job = {"field": field, "seeds": seeds, "limits": limits}
        script = HERE / "parts" / "streamlines.mjs"
        done = subprocess.run(
            ["node", script, module, log],
            input=json.dumps(job),
            capture_output=True,
            text=True,
            check=True,
        )
    answer = json.loads(done.stdout)
    distances = [
        largest_distance(numpy.array(line), theirs[seed]) / diagonal
        for seed, line in enumerate(answer["lines"])
        if len(line) > 1 and len(theirs.get(seed, [])) > 1
    ]
    even = answer["even"]
    row = [
        pathlib.Path(mesh).stem,
        f"{answer['cells']:,}",
        f"{len(distances)}",
        f"{100 * numpy.mean(numpy.array(distances) <= NEAR):.1f}",
        f"{100 * numpy.median(distances):.4f}, {100 * numpy.quantile(distances, 0.95):.3f}",
        f"{answer['firstMs']:.0f}",
        f"{even['lines']}, {even['steps']:,}, {even['ms']:.0f}",
        f"{even['steps'] / even['ms'] / 1000:.2f}",
        f"{steps / seconds / 1e6:.3f}",
    ]
    print("| " + " | ".join(row) + " |", flush=True)


def main():
    if len(sys.argv) < 5 or len(sys.argv) % 2 == 0:
        sys.exit(__doc__)
    binaries, module = pathlib.Path(sys.argv[1]), sys.argv[2]
    for mesh, field in zip(sys.argv[3::2], sys.argv[4::2]):
        compare(binaries / "qtet", module, mesh, field)


if __name__ == "__main__":
    main()
