#!/usr/bin/env python3
"""Compares the figures of README.md, and the viewer's weight in other documents, with the programs.

  readme.py --tool qtet [--viewer DIR]   what the samples and the built viewer say
  readme.py --tool qtet --check data     the meshes of QTET_DATA; 77 (skipped) where it is not set

0: all are true. 1: each that is not is named, with the right one. Standard library only."""

import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_WORDS = 1100
# How far a weight may be off: compressors differ between versions, and the viewer changes daily.
WEIGHT_TOLERANCE = 0.01
# The rows of the table "Measured", by their beginning, and the meshes of QTET_DATA.
FIN = "fin ("
DATA = {"NASA blunt fin": "bluntfin", "CAD part": "linkrods-1m"}
COLUMNS = ["tetrahedra", "log", "connectivity", "positions", "all fields", "log in all", ".vtu"]
PICTURES = "node tests/browser/readme_pictures.mjs makes the pictures and prints their captions"
SKIPPED = 77


class Failure(Exception):
    """Why a figure cannot be compared, for people."""


def run(*words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Failure(f"{' '.join(map(str, words))}: {(done.stderr or done.stdout).strip()}")
    return done.stdout


def size(count):
    """As the README writes bytes: 6.2 kB, 434 kB, 2.2 MB."""
    if count >= 999_500:
        return f"{count / 1e6:.1f} MB"
    return f"{count / 1e3:.1f} kB" if count < 9_950 else f"{count / 1e3:.0f} kB"


class Page:
    """A document, and what is wrong with it."""

    def __init__(self, path):
        self.name = path.name
        self.text = path.read_text(encoding="utf-8")
        self.wrong = []

    def compare(self, what, said, right, advice=""):
        if said != right:
            self.fault(f"{what}: it says {said}, right is {right}" + (advice and f"; {advice}"))

    def fault(self, sentence):
        self.wrong.append(f"{self.name}: {sentence}")

    def search(self, what, pattern):
        """The groups of the one place with the pattern, in which blanks may be line ends."""
        found = re.findall(pattern.replace(" ", r"\s+"), self.text)
        if len(found) == 1:
            return found[0]
        self.fault(f"{what}: {len(found)} places are like '{pattern}' instead of one")
        return None

    def row(self, name):
        """{column: cell} of the row of the table "Measured" that begins with the name."""
        rows = [line for line in self.text.split("\n") if line.startswith("| ")]
        lines = [line.strip("| ").split(" | ") for line in rows]
        heads = [cells for cells in lines if cells[0] == "mesh"]
        rows = [cells for cells in lines if cells[0].startswith(name)]
        if len(heads) == len(rows) == 1 and len(heads[0]) == len(rows[0]):
            return dict(zip((head.strip("`") for head in heads[0]), rows[0]))
        self.fault(f"the table 'Measured' has no row {name.strip(' (')}")
        return None


def simplified(tool, mesh, log, *options):
    return json.loads(run(tool, "simplify", mesh, "-o", log, *options, "--json", "--quiet"))


def check_row(page, name, report, mesh):
    row = page.row(name)
    if row is None:
        return
    cells = report["tetrahedra"]["full"]
    of = report["bytesOf"]

    def bits(count):
        return f"{8 * count / cells:.1f} bits"

    right = [
        f"{cells:,}",
        size(report["bytes"]),
        bits(of["connectivity"]),
        bits(of["positions"]),
        bits(sum(of["fields"].values())),
        bits(report["bytes"]),
        f"{8 * mesh.stat().st_size / cells:.0f} bits",
    ]
    for column, figure in zip(COLUMNS, right):
        said = row.get(column, "").removesuffix(" (raw)")
        page.compare(f"{name.strip(' (')}, {column}", said, figure)


def check_words(page):
    count = len(page.text.split())
    if count > MOST_WORDS:
        page.fault(f"it has {count} words, at most {MOST_WORDS} are allowed")


def check_captions(page, levels):
    """The figures of the pictures, by the levels of a log of fin's density alone."""
    whole = levels[-1]
    place = r"([\d.]+ kB) \((?:all )?([\d,]+) cells\)"
    shown = page.search("first picture", f"after {place}, {place} and {place}")
    for said, cells in zip(shown[::2], shown[1::2]) if shown else []:
        count = int(cells.replace(",", ""))
        near = min(levels, key=lambda level: abs(level["tetrahedra"] - count))
        page.compare("first picture, cells", cells, f"{near['tetrahedra']:,}", PICTURES)
        what = f"first picture, {cells} cells"
        page.compare(what, said, size(near["cumulativeBytes"]), PICTURES)
    if shown:
        page.compare("first picture, all cells", shown[-1], f"{whole['tetrahedra']:,}")
    shown = page.search("second picture", r"after ([\d.]+) of ([\d.]+ kB)")
    if shown:
        sizes = {size(level["cumulativeBytes"]) for level in levels}
        if f"{shown[0]} kB" not in sizes:
            page.fault(f"second picture: no level takes {shown[0]} kB; {PICTURES}")
        page.compare("second picture, all", shown[1], size(whole["cumulativeBytes"]), PICTURES)


def weigh(viewer):
    """(kB before the first picture, kB of the whole viewer), compressed by gzip."""

    def weight(path):
        return pathlib.Path(f"{path}.gz").stat().st_size / 1000

    page = (viewer / "index.html").read_text(encoding="utf-8")
    first = {viewer / "index.html"}
    # Files, the workers that start_graphics.ts loads, and what decodes a base mesh.
    waiting = [viewer / path for path in re.findall(r'[" ]\./([^" ]+)', page)]
    waiting += viewer.glob("assets/qtet-base-*.wasm")
    while waiting:
        path = waiting.pop().resolve()
        if path in first or path.suffix == ".svg" or not path.exists():
            continue
        first.add(path)
        if path.suffix == ".js":
            code = path.read_text(encoding="utf-8")
            imports = re.findall(r'(?:\bfrom|\bimport)\s*"(\.[^"]+\.js)"', code)
            waiting += [path.parent / name for name in imports]
    every = [path.with_suffix("") for path in viewer.rglob("*.gz")]
    # compress.mjs leaves out the same.
    every = [p for p in every if not re.match(r"qtet-simplify", p.name) and p.suffix != ".txt"]
    return sum(map(weight, first)), sum(map(weight, every))


def check_weight(page, what, pattern, right):
    said = page.search(what, pattern)
    if said and abs(int(said) - right) > max(WEIGHT_TOLERANCE * right, 0.5):
        page.fault(f"{what}: it says {said} kB, right is {right:.0f} kB")


def check_samples(args, page):
    pages = [page]
    check_words(page)
    with tempfile.TemporaryDirectory(prefix="qtet-readme-") as folder:
        mesh, log = pathlib.Path(folder) / "fin.vtu", pathlib.Path(folder) / "fin.qtet"
        run(args.tool, "sample", "fin", "-o", mesh)
        check_row(page, FIN, simplified(args.tool, mesh, log), mesh)
        simplified(args.tool, mesh, log, "--fields", "point:Density")
        check_captions(page, json.loads(run(args.tool, "info", log, "--json"))["levels"])
    check_sizes(page)
    if args.viewer:
        first, every = weigh(args.viewer.resolve())
        check_weight(page, "before the first picture", r"(\d+) kB \(gzip\)", first)
        for path, pattern in [
            ("web-client/docs/PACKAGE.md", r"weigh (\d+) kB \(gzip\)"),
            ("tests/bench/PEERS.md", r"\| page weight \(gzip\) \| (\d+) kB"),
        ]:
            pages.append(Page(ROOT / path))
            check_weight(pages[-1], "the viewer", pattern, every)
    return [sentence for its in pages for sentence in its.wrong]


def check_sizes(page):
    """The cells of a mesh that SIZES.md has."""
    sizes = (ROOT / "tests/bench/SIZES.md").read_text(encoding="utf-8")
    for name, mesh in DATA.items():
        row, known = page.row(name), re.search(rf"^\| {mesh} \| \w+ \| (\d+) \|", sizes, re.M)
        if row and known:
            page.compare(f"{name}, tetrahedra", row["tetrahedra"], f"{int(known[1]):,}")


def check_data(args, page):
    for name, mesh in DATA.items():
        path = pathlib.Path(os.environ["QTET_DATA"]) / f"{mesh}.vtu"
        if not path.is_file():
            raise Failure(f"{path} is missing; QTET_DATA names the folder that has it")
        with tempfile.TemporaryDirectory(prefix="qtet-readme-") as folder:
            report = simplified(args.tool, path, pathlib.Path(folder) / "out.qtet")
        check_row(page, name, report, path)
    return page.wrong


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--tool", type=pathlib.Path, required=True)
    parser.add_argument("--viewer", type=pathlib.Path, help="the folder of the built viewer")
    parser.add_argument("--readme", type=pathlib.Path, default=ROOT / "README.md")
    parser.add_argument("--check", choices=["samples", "data"], default="samples")
    args = parser.parse_args()
    if args.check == "data" and not os.environ.get("QTET_DATA"):
        print("readme: skipped, QTET_DATA is not set")
        return SKIPPED
    page = Page(args.readme)
    try:
        wrong = (check_data if args.check == "data" else check_samples)(args, page)
    except Failure as failure:
        print(f"readme: {failure}", file=sys.stderr)
        return 1
    print("\n".join(wrong) or "readme: its figures are true")
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main())
