#!/usr/bin/env python3
"""What a log takes, to the byte: writes SIZES.md, or compares the tool with it. `make sizes` runs
the one, ctest the other.

  sizes.py                  makes the table anew: the samples, and where QTET_DATA names a folder
                            the data sets in it; without, their old rows are kept
  sizes.py --check samples  0 if the tool's logs of the samples have exactly the sizes of the
                            table, else 1 and what to do
  sizes.py --check data     the same for the data sets; 77 (skipped) where QTET_DATA is not set

A log here has the tool's default options, with the first point field alone. Standard library only.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
OPTIONS = ["--position-bits", "16", "--field-bits", "12"]
SAMPLES = ["box", "fin"]
# Data sets, each with two reference figures in bits a cell. They were measured elsewhere on the
# same mesh, and nothing here recomputes them. The first is for cells and points in Hilbert order,
# differences, zstd -19; the second for a single-rate coder guided by the geometry. None: not known.
DATA = {
    "spx-welded": (28, 10.7),
    "aneurysm": (24, 8.0),
    "bracket-mfem": (25, 7.7),
    "fea-kiefer": (30, 13.3),
    "liver": (26, 8.8),
    "bluntfin-welded": (23, 7.9),
    "comb": (27, 9.0),
    "post-welded": (23, 6.8),
    "linkrods-1m": (None, 7.2),
    "wing-potential": (None, 5.5),
}
BAR = 1.33  # what streaming coarse-first may cost beside the single-rate coder
EXACT = [
    "tetrahedra",
    "levels",
    "chunks",
    "bytes",
    "head",
    "connectivity",
    "positions",
    "field",
    "vertex",
]
COLUMNS = ["mesh", "field name", *EXACT, ".vtu"]
SKIPPED = 77
OLD = " (old)"  # behind the name of a mesh whose row comes from an earlier run

HEAD = f"""# Sizes

Made by `make sizes`; do not edit. A test compares the byte counts with what the tool makes. The
same command makes a change of them; [CHANGELOG.md](../../CHANGELOG.md) has its reason.

Logs with the default options of `qtet simplify` (16-bit lattice, 12-bit fields) and the first point
field alone.

## Bits a tetrahedron of the original

*Head*: header, manifest (with the known errors) and chunk table. *.vtu*: as VTK writes it by
default, with the same field (`vtu_size`). Two figures for the same meshes were measured elsewhere
and are not recomputed here. *zstd*: Hilbert order, differences and zstd -19. *Single-rate*: a
geometry-guided coder without levels. *Ratio*: the log's total over the latter; the bar is {BAR}.
*Vertex*: the same with `--placement vertex`, fused vertices only where vertices were, whose levels
have larger errors (RATE.md); the whole mesh is the same.
"""
EXACT_HEAD = """
## Bytes

"""


class Failure(Exception):
    """What went wrong and what to do, for people."""


def run(words):
    done = subprocess.run(
        [str(word) for word in words], capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        raise Failure(
            (done.stderr or done.stdout).strip() or f"{words[0]} ended with {done.returncode}"
        )
    return json.loads(done.stdout)


def simplified(tool, mesh, field, *options):
    with tempfile.TemporaryDirectory(prefix="qtet-sizes-") as folder:
        return run(
            [
                tool,
                "simplify",
                mesh,
                "-o",
                pathlib.Path(folder) / "out.qtet",
                "--fields",
                f"point:{field}",
                *OPTIONS,
                *options,
                "--json",
            ]
        )


def measured(tool, mesh, field):
    """The row of a mesh but for its .vtu column."""
    report = simplified(tool, mesh, field)
    of = report["bytesOf"]
    return {
        "mesh": mesh.stem,
        "field name": field,
        "tetrahedra": report["tetrahedra"]["full"],
        "levels": report["levels"],
        "chunks": report["chunks"],
        "bytes": report["bytes"],
        "head": of["head"],
        "connectivity": of["connectivity"],
        "positions": of["positions"],
        "field": sum(of["fields"].values()),
        "vertex": simplified(tool, mesh, field, "--placement", "vertex")["bytes"],
    }


def table(columns, rows):
    return (
        "\n".join(
            "| " + " | ".join(cells) + " |" for cells in [columns, ["---"] * len(columns), *rows]
        )
        + "\n"
    )


def read_table(path):
    """The rows of the table of bytes, by mesh."""
    try:
        text = path.read_text(encoding="utf-8").split(EXACT_HEAD)[-1]
    except OSError as error:
        raise Failure(f"{path} cannot be read ({error.strerror}); `make sizes` makes it") from error
    lines = [
        [cell.strip() for cell in line.strip("|\n ").split("|")]
        for line in text.splitlines()
        if line.startswith("|")
    ]
    if not lines or lines[0] != COLUMNS:
        raise Failure(
            f"{path} has no table with the columns {', '.join(COLUMNS)}; `make sizes` makes it"
        )
    out = {}
    for cells in lines[2:]:
        row = dict(
            zip(
                COLUMNS,
                [cell.removesuffix(OLD) if i < 2 else int(cell) for i, cell in enumerate(cells)],
                strict=True,
            )
        )
        out[row["mesh"]] = row
    return out


def bits_row(name, row):
    def bits(size):
        return 8 * size / row["tetrahedra"]

    zstd, single_rate = DATA.get(row["mesh"], (None, None))
    return [
        name,
        *(
            f"{bits(row[key]):.2f}"
            for key in ("bytes", "connectivity", "positions", "field", "head")
        ),
        f"{bits(row['.vtu']):.0f}",
        "" if zstd is None else str(zstd),
        "" if single_rate is None else f"{single_rate:.1f}",
        "" if single_rate is None else f"{bits(row['bytes']) / single_rate:.2f}",
        f"{bits(row['vertex']):.2f}",
        "" if single_rate is None else f"{bits(row['vertex']) / single_rate:.2f}",
    ]


def document(rows, old):
    names = [row["mesh"] + OLD * (row["mesh"] in old) for row in rows]
    note = (
        "\n*(old)*: not measured again when this table was made, because `QTET_DATA` was not set.\n"
        if old
        else ""
    )
    columns = [
        "mesh",
        "total",
        "connectivity",
        "positions",
        "field",
        "head",
        ".vtu",
        "zstd",
        "single-rate",
        "ratio",
        "vertex",
        "its ratio",
    ]
    exact = [[name, *(str(row[key]) for key in COLUMNS[1:])] for name, row in zip(names, rows)]
    return (
        HEAD
        + note
        + "\n"
        + table(columns, [bits_row(name, row) for name, row in zip(names, rows)])
        + EXACT_HEAD
        + table(COLUMNS, exact)
    )


def sample(tool, name, folder):
    path = pathlib.Path(folder) / f"{name}.vtu"
    done = subprocess.run(
        [tool, "sample", name, "-o", path], capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        raise Failure(done.stderr.strip())
    return path


def data_set(name):
    path = pathlib.Path(os.environ["QTET_DATA"]) / f"{name}.vtu"
    if not path.is_file():
        raise Failure(
            f"{path.parent} has no {path.name};"
            " QTET_DATA names the folder that has the data sets of this table"
        )
    return path


def each_mesh(args, names, folder):
    for name in names:
        yield sample(args.tool, name, folder) if name in SAMPLES else data_set(name)


def make(args):
    has_data = bool(os.environ.get("QTET_DATA"))
    rows, old = [], {}
    if not has_data:
        old = {
            name: row
            for name, row in (read_table(args.table) if args.table.exists() else {}).items()
            if name in DATA
        }
        print(
            f"sizes: QTET_DATA is not set: the rows of {len(old)} data sets are kept as they are",
            file=sys.stderr,
        )
    with tempfile.TemporaryDirectory(prefix="qtet-sizes-") as folder:
        for mesh in each_mesh(args, [*SAMPLES, *(DATA if has_data else [])], folder):
            vtu = run([args.vtu_size, mesh])
            rows.append({**measured(args.tool, mesh, vtu["field"]), ".vtu": vtu["bytes"]})
            print(f"sizes: {mesh.stem}: {rows[-1]['bytes']} bytes", file=sys.stderr)
    args.table.write_text(document([*rows, *old.values()], old), encoding="utf-8")
    print(args.table)
    return 0


def differences(row, now):
    return [
        f"{key} {row[key]} -> {now[key]} ({100 * (now[key] / row[key] - 1):+.2f} %)"
        for key in EXACT
        if row[key] != now[key]
    ]


def check(args):
    if args.check == "data" and not os.environ.get("QTET_DATA"):
        print("sizes: skipped, QTET_DATA is not set")
        return SKIPPED
    rows = read_table(args.table)
    changed = False
    with tempfile.TemporaryDirectory(prefix="qtet-sizes-") as folder:
        names = SAMPLES if args.check == "samples" else list(DATA)
        for mesh in each_mesh(args, names, folder):
            if mesh.stem not in rows:
                raise Failure(f"{args.table} has no row for {mesh.stem}; `make sizes` makes it")
            differ = differences(
                rows[mesh.stem], measured(args.tool, mesh, rows[mesh.stem]["field name"])
            )
            changed = changed or bool(differ)
            print(f"sizes: {mesh.stem}: " + ("; ".join(differ) if differ else "as in the table"))
    if changed:
        print(
            f"sizes: the logs differ from {args.table}. If that is meant: `make sizes` makes the"
            " table anew (with QTET_DATA set also that of the data sets); commit it, and tell in"
            " CHANGELOG.md what became larger or smaller, and why. If it is not meant, the change"
            " before has done it."
        )
    return int(changed)


def main():
    built = HERE.parent.parent / "build" / "release" / "bin"
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--check", choices=["samples", "data"], help="compare instead of making")
    parser.add_argument("--table", type=pathlib.Path, default=HERE / "SIZES.md")
    parser.add_argument("--tool", type=pathlib.Path, default=built / "qtet")
    parser.add_argument("--vtu-size", type=pathlib.Path, default=built / "vtu_size")
    args = parser.parse_args()
    for program in [args.tool] if args.check else [args.tool, args.vtu_size]:
        if not os.access(program, os.X_OK):
            parser.error(f"{program} is no program that can be run; `make sizes` builds it")
    try:
        return check(args) if args.check else make(args)
    except Failure as failure:
        print(f"sizes: {failure}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
