#!/usr/bin/env python3
"""Replaces each attribute of each element of VTK's XML files by hostile values, and has the tool
check them. Each run must end by itself with code 0 or 1, and 1 with a sentence.
    hostile_attributes.py QTET MESHES SCRATCH [--every N] [--seconds S] [--table]
MESHES: the folder of files. --every: one of N cases, another value at each attribute. --table: that
of tests/bench/HOSTILE.md."""

import argparse
import collections
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

MOST_BYTES = 256 << 20

FILES = ["p_0.vtu", "p.pvtu", "m.vtm", "run.pvd", "s.vts", "r.vtr", "i.vti", "ps.pvts", "pr.pvtr",
         "pi.pvti"]
VALUES = {
    "negative": ["-1", "-2", "-4", "-128", "-65536", "-2147483648", "-2147483649",
                 "-9223372036854775808", "-9223372036854775809"],
    "2^31": ["2147483646", "2147483647", "2147483648", "2147483649"],
    "2^32": ["4294967294", "4294967295", "4294967296", "4294967297"],
    "2^62": ["4611686018427387903", "4611686018427387904", "4611686018427387905"],
    "2^63 and more": ["9223372036854775807", "9223372036854775808", "18446744073709551615",
                      "18446744073709551616", "1" + "0" * 40],
    "small": ["0", "1", "2", "255", "65536", "1000000"],
    "no integer": ["1.5", "1e300", "1e-300", "NaN", "inf", "0x7fffffff"],
    "words": ["", " ", "x", "Float99", "../../p_0.vtu"],
}
CASES = [(kind, value) for kind, values in VALUES.items() for value in values]
ATTRIBUTE = re.compile(rb'([A-Za-z_]+)="([^"]*)"')


def cases_of(path, every):
    """(attribute, its place, kind, value, the file's bytes then)"""
    whole = path.read_bytes()
    end = whole.find(b"<AppendedData")
    number = 0
    for match in ATTRIBUTE.finditer(whole, 0, len(whole) if end < 0 else end):
        for kind, value in CASES:
            number += 1
            if number % every == 0:
                bytes_ = whole[: match.start(2)] + value.encode() + whole[match.end(2) :]
                yield match.group(1).decode(), match.start(), kind, value, bytes_


def run(qtet, path):
    """(exit code, seconds, bytes of the largest process, what it said)"""
    start = time.monotonic()
    child = subprocess.Popen(
        [qtet, "check", path], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    said = child.stdout.read()
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = 0
    code = os.waitstatus_to_exitcode(status)
    return code, time.monotonic() - start, usage.ru_maxrss * 1024, said


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("qtet", type=pathlib.Path)
    parser.add_argument("meshes", type=pathlib.Path)
    parser.add_argument("scratch", type=pathlib.Path)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=5, help="a run may take at most")
    parser.add_argument("--table", action="store_true")
    options = parser.parse_args()
    shutil.rmtree(options.scratch, ignore_errors=True)
    wrong = []
    sums = collections.defaultdict(lambda: [0, 0, 0, 0])

    def one(job):
        number, name, attribute, place, kind, value, bytes_ = job
        folder = options.scratch / str(number)
        shutil.copytree(options.meshes, folder)
        (folder / name).write_bytes(bytes_)
        result = run(options.qtet, folder / name)
        shutil.rmtree(folder)
        return name, attribute, place, kind, value, result

    jobs = [
        (number, name, *case)
        for name in FILES
        for number, case in enumerate(cases_of(options.meshes / name, options.every))
    ]
    jobs = [(number, *job[1:]) for number, job in enumerate(jobs)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for name, attribute, place, kind, value, result in pool.map(one, jobs):
            code, seconds, bytes_, said = result
            sum_ = sums[name.partition(".")[2], kind]
            sum_[code == 1] += 1
            sum_[2], sum_[3] = max(sum_[2], seconds), max(sum_[3], bytes_)
            if (code not in (0, 1) or (code == 1 and "refused" not in said)
                    or seconds > options.seconds or bytes_ > MOST_BYTES):
                wrong.append(f'{name}: {attribute}="{value}" at byte {place}: code {code}, '
                             f"{seconds:.1f} s, {bytes_ >> 20} MB: {said[:200]}")
    if options.table:
        print("| file |", " | ".join(VALUES), "| most s | most MB |")
        print("|---" * (len(VALUES) + 3) + "|")
        for ending in dict.fromkeys(ending for ending, _ in sums):
            row = [sums[ending, kind] for kind in VALUES]
            cells = " | ".join(f"{refused} of {refused + taken}" for taken, refused, _, _ in row)
            seconds, bytes_ = max(s[2] for s in row), max(s[3] for s in row)
            print(f"| .{ending} | {cells} | {seconds:.1f} | {bytes_ >> 20} |")
    print(f"{len(jobs)} files, {len(wrong)} wrong", *wrong, sep="\n")
    return 1 if wrong or not jobs else 0


if __name__ == "__main__":
    sys.exit(main())
