#!/usr/bin/env python3
"""A changed target takes effect soon on a slow line, whatever fills the line's queue. Counts bytes:
how many come between the wish and the end of the new plan's first frame does not depend on how
busy the machine is.

  slow_line_test.py FOLDER_OF_PROGRAMS SCRATCH     exit code 77: namespaces are not allowed here
"""
import pathlib, shutil, subprocess, sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support" / "line"))
import line as lines
from server import running
from stream import BINARY, Stream

RATE, DELAY, QUEUE = 50_000, 0.025, 1000  # 0.4 Mbit/s, a round trip of 50 ms, 30 s of packets
AHEAD = 0.25  # seconds of data until the new plan's first frame is here
TARGETS = 6

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
    for target in range(TARGETS):
        begun, before = stream.received, RATE * (1 + target / TARGETS)  # in different blocks
        stream.open(*mesh)
        stream.until(lambda f: f.kind == BINARY and f.first > begun + before, 120)
        had = stream.received
        stream.say(type="target", target=None)
        stream.until(lambda f: f.text and f.text["type"] == "planned", 60)
        # `done` where the whole log was on its way already
        first = stream.until(lambda f: f.kind == BINARY or f.text and f.text["type"] == "done", 60)
        ahead.append(first.first + first.size - had)
    stream.close()

bound = RATE * (2 * DELAY + AHEAD)
print(f"bytes until the new plan's first frame is here: {ahead}, at most {bound:.0f}")
sys.exit(0 if max(ahead) <= bound else 1)
