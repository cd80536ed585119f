#!/usr/bin/env python3
"""How many bytes a series takes beside its instants one by one (TIME.md):

    series.py LIBQTET.so MESH.qtet [--instants 50]

The mesh is that of a log at its last level. Its fields are synthetic: blobs that move, a wave that
travels, a shock, and sixty random waves that drift (turbulence); the same with four times as many
instants in the same time (finer), and standing still (equal). A log with series has these instead.
Each is simplified as a series, and as fields of other names, which are coded each by itself.

The second table has what others take for the same values at the same greatest error, half a step of
12 bits: zfp, where Debian's program is there (blocks of 4 points by 4 instants, `-a`); and, of the
integers' differences in time, zlib at level 9 and the least that a plain coder of one symbol after
the other takes (the entropy of each instant's differences, tables not counted). Their points lie
along a Z-order curve, and they have no coarse levels. Needs numpy."""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import zlib

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


def along_a_curve(points):
    """The points' order by the bits of their coordinates in turns."""
    low, high = points.min(0), points.max(0)
    cells = ((points - low) / (high - low).max() * 1023).astype("uint64")
    key = numpy.zeros(len(points), "uint64")
    for bit in range(10):
        for axis in range(3):
            key |= (cells[:, axis] >> numpy.uint64(bit) & numpy.uint64(1)) << numpy.uint64(
                3 * bit + axis
            )
    return numpy.argsort(key, kind="stable")


def zfp_bytes(values, tolerance):
    """None: the program is not there."""
    program = shutil.which("zfp")
    if not program:
        return None
    instants, points = values.shape
    with tempfile.TemporaryDirectory() as folder:
        raw, packed = os.path.join(folder, "raw"), os.path.join(folder, "packed")
        values.astype("float32").tofile(raw)
        shape = ["-2", str(points), str(instants)]
        options = ["-q", "-f", *shape, "-a", repr(tolerance), "-i", raw, "-z", packed]
        subprocess.run([program, *options], check=True)
        return os.path.getsize(packed)


def entropy_bytes(integers):
    total = 0
    for instant in integers:
        counts = numpy.unique(instant, return_counts=True)[1]
        total -= (counts * numpy.log2(counts / counts.sum())).sum() / 8
    return int(total)


def peers(values):
    """zfp, zlib and a plain coder's least bytes."""
    step = (values.max() - values.min()) / 4095
    integers = numpy.rint((values - values.min()) / step).astype("int32")
    differences = numpy.diff(integers, axis=0, prepend=0)
    packed = zlib.compress(differences.astype("int16").tobytes(), 9)
    return zfp_bytes(values, float(step / 2)), len(packed), entropy_bytes(differences)


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
    order, others = along_a_curve(points), []
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
        values = numpy.array(fields, "float64")
        if values.ndim == 2:
            others.append((name, series[0], *peers(values[:, order])))
    print("\n| series | bytes | zfp | zlib of differences | plain coder of differences |")
    print("|---|---|---|---|---|")
    for name, *figures in others:
        print(f"| {name} | " + " | ".join("-" if x is None else f"{x:,}" for x in figures) + " |")


main()
