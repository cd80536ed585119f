#!/usr/bin/env python3
"""What a change in a header costs: the objects that include it, and the seconds they took to compile.
    reach.py BUILD... [--most N]     BUILD: a folder that ninja has built without a cache
Seconds are those of ninja's log; with no more jobs than cores they are a core's."""

import argparse
import collections
import pathlib
import subprocess


def seconds_of(build):
    took = {}
    for line in (build / ".ninja_log").read_text().splitlines():
        if not line.startswith("#"):
            start, end, _, output, _ = line.split("\t")
            took[output] = (int(end) - int(start)) / 1000
    return took


def dependencies(build):
    """Object -> the files of the repository that it was compiled from."""
    text = subprocess.run(
        ["ninja", "-C", build, "-t", "deps"], capture_output=True, text=True, check=True
    ).stdout
    for block in text.split("\n\n"):
        first, *files = block.splitlines() or [""]
        name = first.split(":")[0]
        if name.endswith(".o"):
            yield name, [file.strip() for file in files]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", nargs="+", type=pathlib.Path)
    parser.add_argument("--most", type=int, default=30)
    options = parser.parse_args()
    objects, seconds = collections.Counter(), collections.Counter()
    for build in options.build:
        took = seconds_of(build)
        root = str(build.resolve().parents[1]) + "/"
        for name, files in dependencies(build):
            for file in files:
                path = str((build / file).resolve())
                if path.startswith(root) and path.endswith(".h") and name in took:
                    objects[path[len(root) :]] += 1
                    seconds[path[len(root) :]] += took[name]
    print("| header | objects | seconds |\n|---|---|---|")
    for path, sum_of in seconds.most_common(options.most):
        print(f"| {path} | {objects[path]} | {sum_of:.0f} |")


if __name__ == "__main__":
    main()
