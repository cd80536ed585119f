#!/usr/bin/env python3
"""Judges the golden files by the second decoder, and the golden files by its misreadings:

    judge.py [--all]

Every valid file must decode to its digests, and the chunk of trace.txt to its decisions. Then each
sentence of the documents is misread on purpose, and some file must notice. --all names every file
that notices, not only the first.
"""
import hashlib
import re
import sys
from pathlib import Path

sys.dont_write_bytecode = True  # the sources' folder stays as it is

import closing  # noqa: E402
import decoder  # noqa: E402

SOURCES = Path(__file__).resolve().parent
HERE = SOURCES.parent
EXAMPLE = HERE.parents[1] / "codec" / "EXAMPLE.md"


def digests_in(name):
    """{NAME: DIGEST} of a file as sha256sum writes."""
    lines = (HERE / name).read_text().splitlines()
    return {line.split()[1]: line.split()[0] for line in lines}


def worked_example():
    """The bytes of the page, and the digest that it names."""
    page = EXAMPLE.read_text().split("## A lifted block")[0]
    lines = re.findall(r"^[0-9a-f]{4}  ((?:[0-9a-f]{2} ?)+)$", page, re.M)
    digest = re.search(r"Mesh digest: `([0-9a-f]{64})`", page).group(1)
    return bytes.fromhex("".join(lines)), digest


class Vectors:
    def __init__(self):
        self.meshes = digests_in("digests.txt")
        self.fields = digests_in("field-digests.txt")
        self.levels = digests_in("level-digests.txt")
        self.closing = digests_in("closing-digests.txt")
        self.files = {name: (HERE / "valid" / name).read_bytes() for name in self.meshes}
        self.files["EXAMPLE.md"], self.meshes["EXAMPLE.md"] = worked_example()

    def wrongs(self, name, misreading=""):
        """What differs from the digests, one text each."""
        mesh, fields = decoder.decode(self.files[name], misreading)
        out = []
        if mesh.digest() != self.meshes[name]:
            out.append("mesh")
        for i, field in enumerate(fields):
            if field.digest() != self.fields[f"{name}/{i}"]:
                out.append(f"field {i}")
        for level, digest in mesh.digests.items():
            if name in self.files and self.levels.get(f"{name}@{level}", digest) != digest:
                out.append(f"level {level}")
        for (kind, field), data in closing.closing_blocks(mesh, fields).items():
            if hashlib.sha256(data).hexdigest() != self.closing[f"{name}#{kind}/{field}"]:
                out.append(f"closing block of kind {kind}")
        return out

    def notices(self, name, misreading):
        try:
            return bool(self.wrongs(name, misreading))
        except Exception:  # pylint: disable=broad-except
            return True  # refused, or led astray


def check_digests(vectors):
    for name in vectors.files:
        wrongs = vectors.wrongs(name)
        if wrongs:
            sys.exit(f"{name}: {', '.join(wrongs)} differ")
    covered = {f"{name}@" for name in vectors.files} - {"EXAMPLE.md@"}
    missing = covered - {name.split("@")[0] + "@" for name in vectors.levels}
    if missing:
        sys.exit(f"no digest of a level: {missing}")
    print(f"{len(vectors.files)} logs decode to their digests")


def trace_of_chunk_1(data):
    trace = []
    decoder.decode(data, trace=trace)
    return [f"{i} {p} {bit} {low} {high}" for i, (p, bit, low, high) in enumerate(trace)]


def check_trace(vectors):
    lines = (HERE / "trace.txt").read_text().splitlines()
    expected = [line for line in lines if not line.startswith("#")]
    if trace_of_chunk_1(vectors.files["dice-traced.qtet"]) != expected:
        sys.exit("trace.txt: other decisions")
    print(f"trace.txt: {len(expected)} decisions are the same")


def misreadings():
    """All that the decoder's sources know."""
    text = "".join(path.read_text() for path in SOURCES.glob("*.py"))
    return sorted(set(re.findall(r'(?:wrong|misreading) [!=]= "([^"]+)"', text)))


def check_misreadings(vectors, name_all):
    order = sorted(vectors.files, key=lambda name: len(vectors.files[name]))
    unnoticed = []
    for misreading in misreadings():
        noticing = []
        for name in order:
            if vectors.notices(name, misreading):
                noticing.append(name.removesuffix(".qtet"))
                if not name_all:
                    break
        print(f"  {misreading}: {', '.join(noticing) or 'NOBODY NOTICES'}")
        if not noticing:
            unnoticed.append(misreading)
    if unnoticed:
        sys.exit(f"no golden file notices: {'; '.join(unnoticed)}")


def main():
    vectors = Vectors()
    check_digests(vectors)
    check_trace(vectors)
    check_misreadings(vectors, "--all" in sys.argv)


if __name__ == "__main__":
    main()
