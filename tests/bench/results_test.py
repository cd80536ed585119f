#!/usr/bin/env python3
"""results.py against a tool, a decimator and a judge that only pretend: what it keeps, what it runs
again, and what it says of failures."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import textwrap
import unittest

RESULTS = pathlib.Path(__file__).with_name("results.py")

TOOL = """
    if sys.argv[1] == "info":
        print(json.dumps({"bytes": 5000, "fields": [{"name": "Heat"}, {"name": "Kind"}],
                          "levels": [{"tetrahedra": 60, "bytes": 700, "error": {
                              "boundary": {"toLevel": {"max": 0.01}, "toOriginal": {"max": 0.02}},
                              "volumeLost": 0.001, "volumeGained": 0,
                              "fields": [{"rms": 0.012}, {"wrong": 0.3}]}}]}))
    elif sys.argv[1] == "extract":
        pathlib.Path(sys.argv[sys.argv.index("-o") + 1]).write_text("mesh")
    elif "--placement" in sys.argv:
        sys.exit("qtet: the hull is too heavy\\nqtet: see 'qtet simplify --help'")
    else:
        pathlib.Path(sys.argv[sys.argv.index("-o") + 1]).write_text("log")
        print(json.dumps({"tetrahedra": {"full": 1000}, "lattice": {"step": 0.5}, "levels": 7,
                          "seconds": {"simplify": 1, "total": 2}}))
"""
DECIMATE = """
    out = sys.argv[2] + "_" + sys.argv[4] + ".vtu"
    pathlib.Path(out).write_text("mesh")
    print(json.dumps({"file": out, "userSeconds": 0.5}))
"""
JUDGE = """
    print(json.dumps({
        "bounding_box_diagonal": 100, "reduction_of_tets": 0.9,
        "verdict": {"valid": True, "topology_preserved": True,
                    "inside_envelope": "--envelope-tol" in sys.argv and
                    float(sys.argv[sys.argv.index("--envelope-tol") + 1]) == 0.01,
                    "no_new_self_intersections": False, "no_new_pinches": True},
        "original": {"tets": 1000},
        "simplified": {"tets": 100, "boundary_triangles": 40,
                       "quality": {"min_dihedral_deg": {"p01": 5, "median": 30}}},
        "coverage": {"original_volume_uncovered_fraction": 0.01},
        "boundary_distance_over_diagonal": {"hausdorff": 1e-3, "outside_envelope_max": 1e-5},
        "field_error_over_range": {"field": "Heat", "rms": 0.01, "p99": 0.02, "max": 0.03}}))
"""


class Results(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "data").mkdir()
        (self.folder / "data" / "part.vtu").write_text("input")
        for name, body in (("qtet", TOOL), ("vtk_decimate", DECIMATE), ("judge", JUDGE)):
            self.write_program(name, body)

    def write_program(self, name, body):
        path = self.folder / name
        path.write_text(f"#!{sys.executable}\nimport json, pathlib, sys\n{textwrap.dedent(body)}")
        path.chmod(0o755)

    def run_results(self, *words, **environment):
        env = {
            **os.environ,
            "QTET_DATA": str(self.folder / "data"),
            "QTET_JUDGE": str(self.folder / "judge"),
            **environment,
        }
        paths = [
            "--tool",
            self.folder / "qtet",
            "--vtk-decimate",
            self.folder / "vtk_decimate",
            "--cache",
            self.folder / "cache",
            "--out",
            self.folder / "RESULTS.md",
        ]
        return subprocess.run(
            [sys.executable, RESULTS, *paths, *words],
            env=env,
            capture_output=True,
            text=True,
            check=False,
        )

    def test_every_figure_stands_in_the_table(self):
        done = self.run_results("--settings", "1,4", "--reductions", "90")
        self.assertEqual(done.returncode, 0, done.stderr)
        text = (self.folder / "RESULTS.md").read_text()
        self.assertIn(
            "| qtet | 90.00 | VTE-P | 1 | 2 | 3 | 1.0e-03 | 1.0e-05 | 0.99000 | 5.00 | 30.0 | 40 |"
            "  | 7 |",
            text,
        )
        self.assertIn(
            "| VTK | 90.00 | VTE-P | 1 | 2 | 3 | 1.0e-03 | 1.0e-05 | 0.99000 | 5.00 | 30.0 | 40 |"
            "  |  | 0.50 | 2 |",
            text,
        )
        self.assertIn("| mesh | qtet, 90 % |\n|---|---|\n| part | 1.00 |", text)
        self.assertIn("| part | 5,000 | 60 | 700 | 2.00 | 0.10 | 0.00 | Heat 1.2, Kind 30 |", text)

    def test_what_is_known_is_not_run_again_until_the_tool_changes(self):
        self.run_results("--settings", "1,4", "--reductions", "50,90")
        again = self.run_results("--settings", "1,4", "--reductions", "50,90").stderr
        self.assertEqual(again.count(": known"), 4, again)
        self.write_program("qtet", TOOL + "# another build\n")
        changed = self.run_results("--settings", "1,4", "--reductions", "50,90").stderr
        self.assertEqual(changed.count(": known"), 2, changed)

    def test_a_failure_is_a_row_with_its_reason_and_is_tried_again(self):
        for _ in range(2):
            done = self.run_results("--settings", "3", "--reductions", "90")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertNotIn(": known", done.stderr)
        self.assertIn(
            "| qtet, one field, optimal | qtet: the hull is too heavy |",
            (self.folder / "RESULTS.md").read_text(),
        )

    def test_a_cache_file_that_is_cut_off_counts_for_nothing(self):
        self.run_results("--settings", "4", "--reductions", "90")
        path = self.folder / "cache" / "part" / "VTK_90.json"
        path.write_text(path.read_text()[:-9])
        self.assertNotIn(
            ": known", self.run_results("--settings", "4", "--reductions", "90").stderr
        )
        self.assertIn("result", json.loads(path.read_text()))

    def test_what_is_missing_is_named(self):
        self.assertIn("QTET_JUDGE is not set", self.run_results(QTET_JUDGE="").stderr)
        self.assertIn("QTET_DATA is not set", self.run_results(QTET_DATA="").stderr)
        self.assertIn("has no other.vtu; it has: part", self.run_results("--sets", "other").stderr)
        (self.folder / "vtk_decimate").unlink()
        self.assertIn("built by `make results`", self.run_results().stderr)


if __name__ == "__main__":
    unittest.main()
