#!/usr/bin/env python3
"""Every figure of the judge for qtet and for VTK's decimation, data set by data set.

It writes RESULTS.md; `make results` runs it.

  QTET_DATA=/folder/of/meshes QTET_JUDGE=/path/to/judge tests/bench/results.py --cache build/results

The judge is a program of its own that prints its figures as JSON:
`judge ORIGINAL.vtu SIMPLIFIED.vtu [--field NAME] [--envelope-tol F]`.
Each result is kept in the cache folder and not computed again, so that the run may be stopped and
started. A result of qtet counts only for the tool, byte for byte, that it was made with; one of VTK
counts until it is deleted. Standard library only.
"""

import argparse
import concurrent.futures
import datetime
import hashlib
import json
import math
import os
import pathlib
import platform
import subprocess
import sys
import tempfile
import threading

# The settings to compare: name in the table, program, and for qtet its options, for VTK the scale
# (vtk_decimation.h). In the options {field} is the field that is judged, and --position-bits here
# goes before the one below.
SETTINGS = [
    ("qtet", "qtet", ["--measure", "none"]),
    ("qtet, one field", "qtet", ["--fields", "{field}", "--measure", "none"]),
    (
        "qtet, one field, optimal",
        "qtet",
        [
            "--fields",
            "{field}",
            "--field-bits",
            "16",
            "--measure",
            "none",
            "--placement",
            "optimal",
        ],
    ),
    ("VTK", "vtk", "1"),
    ("VTK x 1000", "vtk", "1000"),
]
REDUCTIONS = [80, 90, 95, 99]  # per cent of the cells
POSITION_BITS = "16"
# How far a boundary may leave the original solid, over the diagonal, beside a lattice step: what
# the tool allows by default.
ENVELOPE_TOLERANCE = 0.005
# Meshes whose parts removed differ by at most this have equally many cells.
EQUAL_CELLS = 0.005
# One log for all reductions (--levels): it goes a little beyond the last, since levels seldom end
# where a reduction does.
LEVELS_TARGET_RATIO = "0.009"

VERDICTS = [
    ("V", "valid"),
    ("T", "topology_preserved"),
    ("E", "inside_envelope"),
    ("S", "no_new_self_intersections"),
    ("P", "no_new_pinches"),
]
COLUMNS = [
    "program",
    "removed %",
    "verdicts",
    "rms %",
    "p99 %",
    "max %",
    "Hausdorff",
    "outside",
    "volume kept",
    "dihedral p1",
    "median",
    "boundary triangles",
    "records",
    "levels",
    "s",
    "k cells/s",
]


class Failure(Exception):
    """A program failed; the text is the last line that says why."""


def run_timed(words):
    """A program's standard output, and the user CPU seconds that it took."""
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        process = subprocess.Popen([str(word) for word in words], stdout=out, stderr=err, text=True)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0), err.seek(0)
        if process.returncode == 0:
            return out.read(), usage.ru_utime
        lines = (err.read() or out.read()).strip().splitlines()
    named = [
        line for line in lines if "qtet: see " not in line and "qtet: usage" not in line
    ] or lines
    raise Failure(
        named[-1] if named else f"{pathlib.Path(words[0]).name}: ended with {process.returncode}"
    )


def run(words):
    return run_timed(words)[0]


def write_whole(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.{threading.get_ident()}.part")
    part.write_text(text, encoding="utf-8")
    part.replace(path)


class Cache:
    """JSON results by data set, setting and reduction, each stamped with what it was made with."""

    def __init__(self, folder):
        self.folder = folder

    def path(self, data_set, setting, what):
        return (
            self.folder
            / data_set
            / f"{''.join(c if c.isalnum() else '-' for c in setting)}_{what}.json"
        )

    def get(self, data_set, setting, what, stamp):
        try:
            entry = json.loads(self.path(data_set, setting, what).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            return None
        return entry["result"] if entry["stamp"] == stamp else None

    def put(self, data_set, setting, what, stamp, result):
        write_whole(
            self.path(data_set, setting, what),
            json.dumps({"stamp": stamp, "result": result}, indent=1),
        )


class Qtet:
    """The tool with one setting's options on one data set: a run for each reduction, so that the
    counts are met, or one log for all of them."""

    def __init__(self, args, path, options, facts, scratch):
        self.args, self.path, self.diagonal, self.scratch = args, path, facts["diagonal"], scratch
        self.options = [option.replace("{field}", facts["field"]) for option in options]
        self.report, self.user_seconds = None, None

    def simplify(self, ratio):
        bits = [] if "--position-bits" in self.options else ["--position-bits", POSITION_BITS]
        words = [
            self.args.tool,
            "simplify",
            self.path,
            "-o",
            self.scratch / "out.qtet",
            "--target-ratio",
            ratio,
            "--json",
        ]
        text, user = run_timed([*words, *bits, *self.options])
        self.report = json.loads(text)
        # The tool tells wall times, which other work on the machine stretches: its CPU time in the
        # same proportions.
        self.user_seconds = (
            user * self.report["seconds"]["simplify"] / self.report["seconds"]["total"]
        )

    def simplified(self, reduction):
        ratio = f"{1 - reduction / 100:.6g}"
        if not self.args.levels:
            self.simplify(ratio)
        elif self.report is None:
            self.simplify(LEVELS_TARGET_RATIO)
        mesh = self.scratch / "out.vtu"
        run(
            [
                self.args.tool,
                "extract",
                self.scratch / "out.qtet",
                *(["--ratio", ratio] if self.args.levels else ["--level", "0"]),
                "-o",
                mesh,
            ]
        )
        # The time of a log is that of all its levels: no level of it has one of its own.
        seconds = None if self.args.levels else self.user_seconds
        tolerance = ENVELOPE_TOLERANCE + self.report["lattice"]["step"] / self.diagonal
        return mesh, {
            "seconds": seconds,
            "records": self.report.get("records"),
            "levels": self.report["levels"],
            "tolerance": tolerance,
        }


class Vtk:
    def __init__(self, args, path, scale, facts, scratch):
        self.words = [args.vtk_decimate, path, scratch / "out", scale]
        self.tolerance = ENVELOPE_TOLERANCE + facts["tolerance"]

    def simplified(self, reduction):
        report = json.loads(run([*self.words, f"{reduction / 100:.6g}"]))
        return pathlib.Path(report["file"]), {
            "seconds": report["userSeconds"],
            "records": None,
            "levels": None,
            "tolerance": self.tolerance,
        }


class Runner:
    def __init__(self, args):
        self.args = args
        self.cache = Cache(args.cache)
        self.tool_stamp = hashlib.sha256(args.tool.read_bytes()).hexdigest()
        self.lock = threading.Lock()
        self.done, self.total = 0, len(args.sets) * len(args.settings) * len(args.reductions)

    def say(self, data_set, setting, reduction, text):
        with self.lock:
            self.done += 1
            print(
                f"[{self.done}/{self.total}] {data_set}, {setting}, {reduction} %: {text}",
                file=sys.stderr,
                flush=True,
            )

    def facts(self, path):
        """Of a data set: the field that is judged, and one lattice step over the diagonal, by which
        rounding may move a boundary."""
        stamp = [path.stat().st_size, POSITION_BITS]
        known = self.cache.get(path.stem, "original", "facts", stamp)
        if known:
            return known
        with tempfile.TemporaryDirectory(prefix="qtet-results-") as folder:
            words = [
                "-o",
                pathlib.Path(folder) / "whole.qtet",
                "--position-bits",
                POSITION_BITS,
                "--target-ratio",
                "1",
                "--fields",
                "none",
                "--json",
            ]
            report = json.loads(run([self.args.tool, "simplify", path, *words]))
        itself = json.loads(
            run(
                [
                    self.args.judge,
                    path,
                    path,
                    "--surface-samples",
                    "1",
                    "--volume-samples",
                    "1",
                    "--no-self-intersections",
                ]
            )
        )
        diagonal = itself["bounding_box_diagonal"]
        known = {
            "field": itself["field_error_over_range"]["field"],
            "cells": report["tetrahedra"]["full"],
            "diagonal": diagonal,
            "tolerance": report["lattice"]["step"] / diagonal,
        }
        self.cache.put(path.stem, "original", "facts", stamp, known)
        return known

    def base_mesh(self, path):
        """What a log by the tool's defaults opens with, by its own measuring."""
        stamp = [path.stat().st_size, self.tool_stamp]
        known = self.cache.get(path.stem, "defaults", "base", stamp)
        if known:
            return known
        with tempfile.TemporaryDirectory(prefix="qtet-results-") as folder:
            log = pathlib.Path(folder) / "whole.qtet"
            run([self.args.tool, "simplify", path, "-o", log, "--quiet"])
            info = json.loads(run([self.args.tool, "info", log, "--json"]))
        known = {
            "base": info["levels"][0],
            "bytes": info["bytes"],
            "fields": [field["name"] for field in info["fields"]],
        }
        self.cache.put(path.stem, "defaults", "base", stamp, known)
        return known

    def judged(self, path, simplified, field, tolerance):
        judge = json.loads(
            run(
                [
                    self.args.judge,
                    path,
                    simplified,
                    "--field",
                    field,
                    "--envelope-tol",
                    repr(tolerance),
                ]
            )
        )
        simplified.unlink()
        return judge

    def setting_on(self, path, setting, facts):
        """All reductions of one setting on one data set: {reduction: result or Failure}."""
        name, program, options = setting
        stamp = [
            path.stat().st_size,
            options,
            *([self.tool_stamp, self.args.levels] if program == "qtet" else []),
        ]
        out = {}
        with tempfile.TemporaryDirectory(prefix="qtet-results-") as folder:
            side = {"qtet": Qtet, "vtk": Vtk}[program](
                self.args, path, options, facts, pathlib.Path(folder)
            )
            for reduction in self.args.reductions:
                out[reduction] = self.cache.get(path.stem, name, reduction, stamp)
                if out[reduction]:
                    self.say(path.stem, name, reduction, "known")
                    continue
                try:
                    mesh, ran = side.simplified(reduction)
                    out[reduction] = {
                        "ran": ran,
                        "judge": self.judged(path, mesh, facts["field"], ran["tolerance"]),
                    }
                    self.cache.put(path.stem, name, reduction, stamp, out[reduction])
                    self.say(path.stem, name, reduction, verdicts(out[reduction]["judge"]))
                except Failure as failure:
                    out[reduction] = failure
                    self.say(path.stem, name, reduction, str(failure))
        return out


def verdicts(judge):
    return "".join(letter if judge["verdict"][key] else "-" for letter, key in VERDICTS)


def figure(value, form):
    return (
        ""
        if value is None or (isinstance(value, float) and math.isnan(value))
        else format(value, form)
    )


def row(name, result):
    if isinstance(result, Failure):
        return [name, str(result)] + [""] * (len(COLUMNS) - 2)
    judge, ran = result["judge"], result["ran"]
    field, distance = judge["field_error_over_range"], judge["boundary_distance_over_diagonal"]
    quality = judge["simplified"]["quality"]["min_dihedral_deg"]
    removed = judge["original"]["tets"] - judge["simplified"]["tets"]
    rate = None if not ran["seconds"] else removed / ran["seconds"] / 1000
    return [
        name,
        figure(100 * judge["reduction_of_tets"], ".2f"),
        verdicts(judge),
        *(figure(100 * field[key], ".4g") for key in ("rms", "p99", "max")),
        figure(distance["hausdorff"], ".1e"),
        figure(distance["outside_envelope_max"], ".1e"),
        figure(1 - judge["coverage"]["original_volume_uncovered_fraction"], ".5f"),
        figure(quality["p01"], ".2f"),
        figure(quality["median"], ".1f"),
        figure(judge["simplified"]["boundary_triangles"], "d"),
        figure(ran["records"], "d"),
        figure(ran["levels"], "d"),
        figure(ran["seconds"], ".2f"),
        figure(rate, ".0f"),
    ]


def table(rows):
    lines = ["| " + " | ".join(COLUMNS) + " |", "|" + "---|" * len(COLUMNS)]
    return lines + ["| " + " | ".join(cells) + " |" for cells in rows]


def processor():
    try:
        for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.machine()


def summary(args, results):
    """How often each verdict held, by setting: the row to look at first."""
    lines = [
        "| program | runs | "
        + " | ".join(key.replace("_", " ") for _, key in VERDICTS)
        + " | every verdict |",
        "|" + "---|" * (len(VERDICTS) + 3),
    ]
    for name, _, _ in args.settings:
        judged = [
            r["judge"]["verdict"]
            for (_, setting), by in results.items()
            if setting == name
            for r in by.values()
            if not isinstance(r, Failure)
        ]
        counts = [sum(v[key] for v in judged) for _, key in VERDICTS] + [
            sum(all(v[key] for _, key in VERDICTS) for v in judged)
        ]
        lines.append(f"| {name} | {len(judged)} | " + " | ".join(map(str, counts)) + " |")
    return lines


def against_vtk(args, facts, results):
    """rms of each setting of qtet over that of VTK's better valid mesh of as many cells."""
    ours = [name for name, program, _ in args.settings if program == "qtet"]
    theirs = [name for name, program, _ in args.settings if program == "vtk"]
    heads = [f"{name}, {reduction} %" for name in ours for reduction in args.reductions]
    lines = ["| mesh | " + " | ".join(heads) + " |", "|" + "---|" * (len(heads) + 1)]

    def judged(path, name, reduction):
        result = results.get((path, name), {}).get(reduction)
        return None if result is None or isinstance(result, Failure) else result["judge"]

    def ratio(path, name, reduction):
        own = judged(path, name, reduction)
        best = [
            judge["field_error_over_range"]["rms"]
            for other in theirs
            if own
            and (judge := judged(path, other, reduction))
            and judge["verdict"]["valid"]
            and abs(judge["reduction_of_tets"] - own["reduction_of_tets"]) <= EQUAL_CELLS
        ]
        return figure(own["field_error_over_range"]["rms"] / min(best), ".2f") if best else ""

    for path in args.sets:
        if isinstance(facts[path], Failure):
            continue
        cells = [ratio(path, name, reduction) for name in ours for reduction in args.reductions]
        lines.append(f"| {path.stem} | " + " | ".join(cells) + " |")
    return lines


def base_meshes(bases):
    """Rows of base_mesh, by data set."""
    lines = [
        "| mesh | log, bytes | base: cells | bytes | Hausdorff % | volume lost % | gained % |"
        " rms of each field % |",
        "|" + "---|" * 8,
    ]
    for path, known in bases.items():
        if isinstance(known, Failure):
            lines.append(f"| {path.stem} | {known} |" + " |" * 6)
            continue
        base, error = known["base"], known["base"]["error"]
        sides = [error["boundary"][side]["max"] for side in ("toLevel", "toOriginal")]
        rms = [
            f"{name} {100 * next(iter(field.values())):.2g}"
            for name, field in zip(known["fields"], error["fields"])
        ]
        cells = [
            path.stem,
            figure(known["bytes"], ",d"),
            figure(base["tetrahedra"], ",d"),
            figure(base["bytes"], ",d"),
            *(
                figure(100 * value, ".2f")
                for value in (max(sides), error["volumeLost"], error["volumeGained"])
            ),
            ", ".join(rms),
        ]
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def document(args, facts, results, bases):
    how = (
        "one log a setting, its finest level within each reduction"
        if args.levels
        else "one run a reduction"
    )
    lines = [
        "# Results",
        "",
        f"Written by `make results` on {datetime.date.today()}: {processor()},"
        f" {args.jobs} job{'s' * (args.jobs > 1)} at a time; times are rough,"
        " `simplify_bench` measures them. Do not edit.",
        "",
        "Judged against the original mesh by a program that shares nothing with qtet."
        f" qtet: its defaults, which keep all fields; with the first scalar alone; and with that,"
        f" `--placement optimal` and `--field-bits 16`. {how.capitalize()}, lattice of"
        f" {POSITION_BITS} bits an axis. VTK: `vtkUnstructuredGridQuadricDecimation`, as it is and"
        " with points, scalar and boundary weight times 1000; it keeps one scalar.",
        "",
        "*Verdicts*: V valid, T topology preserved, E envelope kept, S no new self-intersections,"
        f" P no new pinches. A dash: it does not hold. E allows {ENVELOPE_TOLERANCE:g} of the"
        " diagonal, the tool's default, and one lattice step."
        " *rms*, *p99*, *max*: error of the first scalar in per cent of its range. *Hausdorff*,"
        " *outside*: of the boundary, over the diagonal. *Volume kept*: fraction of the original"
        " volume still covered. *Dihedral*: 1st percentile and median of the cells' smallest angle,"
        " degrees. *s*: user CPU seconds of the simplification alone.",
        "",
    ]
    lines += [*summary(args, results), ""]
    lines += [
        "rms over that of VTK's better mesh; empty where VTK has no valid mesh of as many cells:",
        "",
        *against_vtk(args, facts, results),
        "",
    ]
    lines += [
        "The base mesh by the tool's defaults, which a viewer shows first. Its errors are the known"
        " ones of the log; the distance is a bound. A label's error is the share of the volume that"
        " has another one.",
        "",
        *base_meshes(bases),
        "",
    ]
    for path in args.sets:
        lines += [f"## {path.stem}", ""]
        if isinstance(facts[path], Failure):
            lines += [str(facts[path]), ""]
            continue
        lines += [
            f"{facts[path]['cells']:,} tetrahedra; field {facts[path]['field']};"
            f" one lattice step is {facts[path]['tolerance']:.2e} of the diagonal.",
            "",
        ]
        for reduction in args.reductions:
            rows = [row(name, results[path, name][reduction]) for name, _, _ in args.settings]
            lines += [f"### {reduction} %", "", *table(rows), ""]
    return "\n".join(lines).rstrip() + "\n"


def arguments():
    here = pathlib.Path(__file__).resolve().parent
    built = here.parent.parent / "build" / "release" / "bin"
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=pathlib.Path, default=here / "RESULTS.md")
    parser.add_argument(
        "--cache",
        type=pathlib.Path,
        required=True,
        help="folder that keeps the results between runs",
    )
    parser.add_argument("--tool", type=pathlib.Path, default=built / "qtet")
    parser.add_argument("--vtk-decimate", type=pathlib.Path, default=built / "vtk_decimate")
    parser.add_argument(
        "--jobs",
        type=int,
        default=1,
        help="settings computed at a time; times are less exact with more than one",
    )
    parser.add_argument(
        "--levels",
        action="store_true",
        help="one log a setting instead of one run a reduction: faster, the counts within a level",
    )
    parser.add_argument("--sets", help="only these data sets, names between commas")
    parser.add_argument(
        "--settings",
        help="only these settings, numbers from 1 between commas: "
        + "; ".join(f"{i + 1} {name}" for i, (name, _, _) in enumerate(SETTINGS)),
    )
    parser.add_argument(
        "--reductions", help=f"per cent between commas instead of {','.join(map(str, REDUCTIONS))}"
    )
    args = parser.parse_args()

    args.judge = pathlib.Path(
        os.environ.get("QTET_JUDGE")
        or parser.error("QTET_JUDGE is not set; it names the program that judges a simplified mesh")
    )
    data = pathlib.Path(
        os.environ.get("QTET_DATA")
        or parser.error("QTET_DATA is not set; it names a folder with .vtu files")
    )
    for program in (args.judge, args.tool, args.vtk_decimate):
        if not os.access(program, os.X_OK):
            parser.error(
                f"{program} is no program that can be run;"
                " qtet and vtk_decimate are built by `make results`"
            )
    found = {path.stem: path for path in sorted(data.glob("*.vtu"))}
    wanted = args.sets.split(",") if args.sets else list(found)
    missing = [name for name in wanted if name not in found]
    if missing or not wanted:
        parser.error(
            f"{data} has no {', '.join(missing) or 'mesh'}.vtu;"
            f" it has: {', '.join(found) or 'nothing'}"
        )
    args.sets = [found[name] for name in wanted]
    try:
        args.settings = (
            [SETTINGS[int(number) - 1] for number in args.settings.split(",")]
            if args.settings
            else SETTINGS
        )
        args.reductions = (
            [float(r) if "." in r else int(r) for r in args.reductions.split(",")]
            if args.reductions
            else REDUCTIONS
        )
    except (ValueError, IndexError):
        parser.error(
            f"--settings takes numbers from 1 to {len(SETTINGS)}, --reductions per cent,"
            " both between commas"
        )
    return args


def main():
    args = arguments()
    runner = Runner(args)
    facts, jobs, bases = {}, {}, {}
    with concurrent.futures.ThreadPoolExecutor(max_workers=max(1, args.jobs)) as pool:
        for path in args.sets:
            try:
                facts[path] = runner.facts(path)
            except Failure as failure:
                facts[path] = failure
                print(f"{path.stem}: {failure}", file=sys.stderr, flush=True)
                continue
            for setting in args.settings:
                jobs[path, setting[0]] = pool.submit(runner.setting_on, path, setting, facts[path])
        results = {key: job.result() for key, job in jobs.items()}
    for path in args.sets:
        try:
            bases[path] = runner.base_mesh(path)
        except Failure as failure:
            bases[path] = failure
    write_whole(args.out, document(args, facts, results, bases))
    print(args.out)


if __name__ == "__main__":
    main()
