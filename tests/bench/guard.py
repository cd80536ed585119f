#!/usr/bin/env python3
"""Whether the present tree is slower than another commit: both are built on this machine, run in
turns, and the least times are compared. `make guard BASE=COMMIT`.

  guard.py --base COMMIT [--jobs N]     builds COMMIT below build/guard first
  guard.py --trees BASE PRESENT         two trees that are built already, each in its build/release

Fails with 1 where the present one takes more than 1.2 times as long and 50 ms more: small figures
are all noise, and a large one that grew by a few percent is no accident to stop for. Programs count
by processor time, so other work on the machine disturbs little. Standard library only.
"""

import argparse
import contextlib
import os
import pathlib
import re
import resource
import subprocess
import sys
import tempfile
import time
import urllib.request

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
TARGETS = ["qtet", "qtet-server", "web-client/qtet-codec.wasm"]
TURNS = 3
RATIO = 1.2
SECONDS = 0.050


def slower(base, present):
    """Whether a figure in seconds has become too slow: by both limits, not at them."""
    # To the microsecond, so that sums of decimal fractions are at the limits where they should be.
    more, allowed = round(present - base, 6), round(present - RATIO * base, 6)
    return more > SECONDS and allowed > 0


def table(figures):
    """Lines of text, and whether all is well. `figures`: name -> (base's times, present's)."""
    lines = ["| least of each, ms | base | present | ratio | |", "|---|---|---|---|---|"]
    well = True
    for name, (base, present) in figures.items():
        before, now = min(base), min(present)
        bad = slower(before, now)
        well = well and not bad
        lines.append(
            f"| {name} | {1e3 * before:.1f} | {1e3 * now:.1f} | {now / before:.2f} "
            f"| {'slower' if bad else ''} |"
        )
    return lines, well


def build_base(commit, jobs):
    tree = ROOT / "build" / "guard" / "tree"

    def run(*command, cwd=tree):
        subprocess.run([str(word) for word in command], cwd=cwd, check=True)

    run("git", "worktree", "prune", cwd=ROOT)
    if (tree / ".git").exists():
        run("git", "checkout", "--quiet", "--detach", commit)
    else:
        run("git", "worktree", "add", "--quiet", "--detach", tree, commit, cwd=ROOT)
    # The preset has neither tests nor the browser's simplifier, which nothing here runs.
    run("cmake", "--preset", "demo")
    run("cmake", "--build", "build/release", "--parallel", jobs, "--target", *TARGETS)
    return tree


def processor_seconds(*command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([str(word) for word in command], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def reply_seconds(program, folder, name):
    """From the start of the server to the end of its first JSON reply."""
    begin = time.perf_counter()
    server = subprocess.Popen(
        [program, folder, "--host", "127.0.0.1", "--port", "0"],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
    )
    with contextlib.ExitStack() as stack:
        stack.callback(server.wait)
        stack.callback(server.terminate)
        port = re.search(r":(\d+)/", server.stdout.readline())[1]
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/v1/meshes/{name}") as reply:
            assert reply.read()
        return time.perf_counter() - begin


def measure(tree, folder, mesh):
    """Name -> seconds of one turn."""
    build = tree / "build" / "release"
    folder.mkdir(exist_ok=True)
    tool, log = build / "bin" / "qtet", folder / "fin.qtet"
    out = {"qtet simplify": processor_seconds(tool, "simplify", mesh, "-o", log, "-q")}
    out["qtet verify"] = processor_seconds(tool, "verify", log)
    decode = ["node", HERE / "codec_in_node.mjs", "--wasm", build / "web-client/qtet-codec.wasm"]
    decode += ["--core", tree / "web-client/core", log]
    text = subprocess.run(decode, check=True, capture_output=True, text=True).stdout
    out["decoding in node"] = 1e-3 * float(text)
    out["a server's start and JSON reply"] = reply_seconds(build / "bin/qtet-server", folder, "fin")
    return out


def compare(trees):
    figures = {}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        mesh = folder / "fin.vtu"
        tool = trees[1] / "build/release/bin/qtet"
        subprocess.run([tool, "sample", "fin", "-o", mesh], check=True, stdout=subprocess.DEVNULL)
        for turn in range(TURNS):
            for which in (0, 1) if turn % 2 == 0 else (1, 0):
                for key, seconds in measure(trees[which], folder / str(which), mesh).items():
                    figures.setdefault(key, ([], []))[which].append(seconds)
    return figures


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--base", metavar="COMMIT")
    what.add_argument("--trees", nargs=2, type=pathlib.Path, metavar=("BASE", "PRESENT"))
    parser.add_argument("--jobs", default=os.cpu_count())
    options = parser.parse_args()
    trees = options.trees or (build_base(options.base, options.jobs), ROOT)
    lines, well = table(compare([tree.resolve() for tree in trees]))
    print("\n".join(lines))
    if not well:
        print(f"guard: slower than {RATIO} times, and by more than {1e3 * SECONDS:.0f} ms")
    return 0 if well else 1


if __name__ == "__main__":
    sys.exit(main())
