#!/usr/bin/env python3
"""What reducing a mesh in blocks costs, and how far its last level is off (SCALE.md):

    scale.py QTET FOLDER [--cells 1400000,5000000,20000000] [--whole 5000000] [--threads 1]

Makes the sample fin in each size in FOLDER, and a log of a fifth of its cells (`--finest`). Up to
`--whole` cells it also makes the log of the whole mesh. Its known errors at the same number of cells
are those of one piece; between measured levels they lie on a straight line of logarithms. Memory is
the most that the process had."""
import argparse
import json
import math
import os
import pathlib
import subprocess
import time

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("qtet")
parser.add_argument("folder", type=pathlib.Path)
parser.add_argument("--cells", default="1400000,5000000,20000000")
parser.add_argument("--whole", type=int, default=5_100_000)
parser.add_argument("--threads", default="1")
arguments = parser.parse_args()


def run(*words):
    """Processor seconds, seconds on the clock and bytes of memory."""
    start = time.monotonic()
    child = subprocess.Popen([arguments.qtet, *map(str, words), "-q"])
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        raise SystemExit(f"qtet {words[0]} failed")
    seconds = time.monotonic() - start
    return usage.ru_utime + usage.ru_stime, seconds, usage.ru_maxrss * 1024


def levels_of(log):
    info = json.loads(subprocess.check_output([arguments.qtet, "info", "--json", log]))
    return [level for level in info["levels"] if "error" in level], info


def rms_at(levels, cells, field):
    """What a log has at so many cells; None beyond its measured levels."""
    points = sorted((a["tetrahedra"], a["error"]["fields"][field]["rms"]) for a in levels)
    for (low, least), (high, most) in zip(points, points[1:]):
        if low <= cells <= high and least > 0 and most > 0:
            along = math.log(cells / low) / math.log(high / low)
            return math.exp(math.log(least) + along * math.log(most / least))
    return None


def ratios(levels, whole, level):
    """Of the known rms of all fields to those of one piece, the mean."""
    fields = range(len(level["error"]["fields"]))
    pairs = [
        (level["error"]["fields"][f]["rms"], rms_at(whole, level["tetrahedra"], f)) for f in fields
    ]
    return sum(own / other for own, other in pairs if other) / max(1, len(pairs))


def row(cells):
    mesh = arguments.folder / f"fin-{cells}.vtu"
    log = arguments.folder / f"fin-{cells}.qtet"
    if not mesh.exists():
        run("sample", "fin", "--cells", cells, "-o", mesh)
    threads = ("--threads", arguments.threads)
    used, seconds, memory = run("simplify", mesh, "-o", log, "--finest", cells // 5, *threads)
    levels, info = levels_of(log)
    original, last = info["original"]["tetrahedra"], levels[-1]["tetrahedra"]
    beside = ["", "", "", ""]
    if cells <= arguments.whole:
        whole = arguments.folder / f"fin-{cells}-whole.qtet"
        used_whole, _, memory_whole = run("simplify", mesh, "-o", whole, *threads)
        all_levels, _ = levels_of(whole)
        third = min(levels, key=lambda level: abs(level["tetrahedra"] - last / 3))
        beside = [
            f"{used / used_whole:.2f}",
            f"{memory / memory_whole:.2f}",
            f"{ratios(levels, all_levels, levels[-1]):.2f}",
            f"{ratios(levels, all_levels, third):.2f}",
        ]
    figures = [f"{original:,}", f"{last:,}", f"{1e6 * used / original:.1f}", f"{seconds:.0f}"]
    return figures + [f"{memory / original:.0f}", f"{log.stat().st_size:,}"] + beside


HEAD = ["cells", "last level", "us a cell", "s", "B a cell", "log, bytes"]
HEAD += ["CPU x", "memory x", "rms x", "rms x at a third"]
print("| " + " | ".join(HEAD) + " |\n|" + "---|" * len(HEAD))
for size in arguments.cells.split(","):
    print("| " + " | ".join(row(int(size))) + " |", flush=True)
