#!/usr/bin/env python3
"""How many bytes a series takes beside its instants one by one (TIME.md):

    series.py LIBQTET.so MESH.qtet [--instants 50]

The mesh is that of a log at its last level. Its fields are synthetic: blobs that move, a wave that
travels, a shock, and sixty random waves that drift (turbulence); the same with four times as many
instants in the same time (finer), and standing still (equal). A log with series has these instead.
Each is simplified as a series, and as fields of other names, which are coded each by itself. Needs
numpy."""
import argparse
import os
import pathlib
import sys
import tempfile
import time

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("library")
parser.add_argument("mesh")
parser.add_argument("--instants", type=int, default=50)
arguments = parser.parse_args()
os.environ["QTET_LIBRARY"] = arguments.library
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "codec" / "python"))

import numpy  # noqa: E402

import qtet  # noqa: E402


def series_of(points, count):
    """{name: function of the instant}"""
    low, high = points.min(0), points.max(0)
    length, middle = (high - low).max(), (low + high) / 2
    x, y = (points - low)[:, :2].T / length
    random = numpy.random.default_rng(7)
    waves = [
        (random.normal(size=3) * 40, random.uniform(0, 6), random.normal() * 3) for _ in range(60)
    ]
    shares = (points - low) / length

    def blobs(i):
        out = 0
        for j in range(3):
            angle = 2 * numpy.pi * (i / count / 2 + j / 3)
            at = [numpy.cos(angle), 0.3 * numpy.sin(2 * angle), 0.5 * numpy.sin(angle)]
            away = points - middle - numpy.array(at) * 0.3 * length
            out = out + numpy.exp(-(away**2).sum(1) / (2 * (0.08 * length) ** 2))
        return out

    def turbulence(i, every=10):
        return sum(
            numpy.sin(shares @ k + phase + speed * i / every) / numpy.linalg.norm(k)
            for k, phase, speed in waves
        )

    return {
        "blobs": blobs,
        "wave": lambda i: numpy.sin(2 * numpy.pi * (3 * x - i / count * 2)) * numpy.cos(4 * y),
        "shock": lambda i: numpy.tanh((x - i / count) / 0.01) * (0.5 + 0.5 * numpy.cos(5 * y)),
        "turbulence": turbulence,
        "finer": lambda i: turbulence(i, 40),
        "equal": lambda i: turbulence(0),
    }


def field_bytes(points, cells, fields):
    begun = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "series.qtet")
        qtet.simplify(points, cells, fields, path=path)
        seconds = time.perf_counter() - begun
        with qtet.open(path) as log:
            return sum(info.bytes for info in log.fields), log.info.chunks, seconds


def main():
    with qtet.open(arguments.mesh) as log:
        log.refine(log.last_level)
        mesh = log.arrays(fields=[])
        own = {
            name: [log.field(name, time) for time in instants]
            for name, instants in log.series.items()
        }
    points, cells = mesh.points, mesh.cells
    print(f"{len(cells)} cells, {len(points)} points")
    print("| series | lone fields, bytes | series, bytes | ratio | bytes a chunk and instant | s |")
    print("|---|---|---|---|---|---|")
    count = arguments.instants
    made = {} if own else series_of(points, count)
    for name in own or made:
        fields = own.get(name) or [made[name](i).astype("float32") for i in range(count)]
        series = field_bytes(points, cells, {f"{name}@{i}": f for i, f in enumerate(fields)})
        lone = field_bytes(points, cells, {f"{name}_{i}": f for i, f in enumerate(fields)})
        a_block = series[0] / series[1] / len(fields)
        print(
            f"| {name} | {lone[0]:,} | {series[0]:,} | {series[0] / lone[0]:.3f} | "
            f"{a_block:,.0f} | {lone[2]:.1f}, {series[2]:.1f} |",
            flush=True,
        )


main()
