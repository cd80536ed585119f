#!/usr/bin/env python3
"""A changed view takes effect soon on a slow line, whatever fills the line's queue. Counts bytes:
how many come between the wish and the first frame of the new order does not depend on how busy the
machine is.

  slow_line_test.py FOLDER_OF_PROGRAMS SCRATCH     exit code 77: namespaces are not allowed here
"""
import pathlib, shutil, statistics, subprocess, sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support" / "line"))
import line as lines
from server import running
from stream import BINARY, Stream

RATE, DELAY, QUEUE = 250_000, 0.025, 1000  # 2 Mbit/s, a round trip of 50 ms, 6 s of packets
AHEAD = 0.15  # seconds of data that may be ahead of the new order
VIEWS = 5

lines.inNamespaces()
programs, scratch = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
shutil.rmtree(scratch, ignore_errors=True)
logs = scratch / "logs"
logs.mkdir(parents=True)
for command in (
    ["sample", "fin", "--cells", "200000", "-o", scratch / "fin.vtu"],
    ["simplify", scratch / "fin.vtu", "-o", logs / "fin.qtet"],
):
    subprocess.run([programs / "qtet", *command], check=True, capture_output=True)

with lines.Line(RATE, DELAY, QUEUE, "reno") as line, running(programs / "qtet-server", logs) as (
    port,
    mesh,
):
    with line.client():
        stream = Stream(lines.SERVER, port)
    ahead = []
    for _ in range(VIEWS):
        begun = stream.received
        stream.open(*mesh)
        stream.until(lambda f: f.kind == BINARY and f.first > begun + RATE / 2, 120)
        had = stream.received
        stream.say(type="view", view={"point": [1, 0, 0]})
        stream.until(lambda f: f.text and f.text.get("view") == 1, 60)
        # `done` where the whole log was on its way already
        first = stream.until(lambda f: f.kind == BINARY or f.text and f.text["type"] == "done", 60)
        ahead.append(first.first - had)
    stream.close()

bound = RATE * (2 * DELAY + AHEAD)
median = statistics.median(ahead)
print(f"bytes ahead of the new order: {ahead}, at most {bound:.0f}")
sys.exit(0 if median <= bound else 1)
