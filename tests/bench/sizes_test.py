#!/usr/bin/env python3
"""sizes.py against a tool that only pretends: what it compares, to the byte, and what it says of a
difference."""

import os
import pathlib
import subprocess
import sys
import tempfile
import textwrap
import unittest

SIZES = pathlib.Path(__file__).with_name("sizes.py")

# The size is that of the mesh's name, and a few bytes more where the file MORE says so.
TOOL = """
    out = pathlib.Path(sys.argv[sys.argv.index("-o") + 1])
    out.write_text("file")
    if sys.argv[1] == "simplify":
        assert "point:Heat" in sys.argv
        more = int(pathlib.Path(__file__).with_name("MORE").read_text())
        size = 1000 * len(pathlib.Path(sys.argv[2]).stem) - (100 if "vertex" in sys.argv else 0)
        print(json.dumps({"tetrahedra": {"full": 800}, "levels": 7, "chunks": 3,
                          "bytes": size + more,
                          "bytesOf": {"head": 100, "connectivity": 200, "positions": 300,
                                      "fields": {"Heat": size + more - 600}}}))
"""
VTU_SIZE = """
    print(json.dumps({"field": "Heat", "cells": 800, "bytes": 8000}))
"""


class Sizes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name, body in (("qtet", TOOL), ("vtu_size", VTU_SIZE)):
            path = self.folder / name
            path.write_text(
                f"#!{sys.executable}\nimport json, pathlib, sys\n{textwrap.dedent(body)}"
            )
            path.chmod(0o755)
        (self.folder / "MORE").write_text("0")
        self.data = self.folder / "data"
        self.data.mkdir()
        for name in (
            "spx-welded",
            "aneurysm",
            "bracket-mfem",
            "fea-kiefer",
            "liver",
            "bluntfin-welded",
            "comb",
            "post-welded",
            "linkrods-1m",
            "wing-potential",
        ):
            (self.data / f"{name}.vtu").write_text("mesh")
        self.table = self.folder / "SIZES.md"

    def run_sizes(self, *words, data=""):
        env = {**os.environ, "QTET_DATA": str(data)}
        paths = [
            "--tool",
            self.folder / "qtet",
            "--vtu-size",
            self.folder / "vtu_size",
            "--table",
            self.table,
        ]
        return subprocess.run(
            [sys.executable, SIZES, *paths, *words],
            env=env,
            capture_output=True,
            text=True,
            check=False,
        )

    def test_a_table_just_made_holds(self):
        self.assertEqual(self.run_sizes(data=self.data).returncode, 0)
        text = self.table.read_text()
        self.assertIn(
            "| fin | Heat | 800 | 7 | 3 | 3000 | 100 | 200 | 300 | 2400 | 2900 | 8000 |", text
        )
        self.assertIn(
            "| comb | 40.00 | 2.00 | 3.00 | 34.00 | 1.00 | 80 | 27 | 9.0 | 4.44 | 39.00 | 4.33 |",
            text,
        )
        for which in ("samples", "data"):
            done = self.run_sizes("--check", which, data=self.data)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_one_byte_more_fails_and_says_what_to_do(self):
        self.run_sizes(data=self.data)
        (self.folder / "MORE").write_text("1")
        for which, mesh in (
            ("samples", "fin: bytes 3000 -> 3001 (+0.03 %); field 2400 -> 2401"),
            ("data", "comb: bytes 4000 -> 4001"),
        ):
            done = self.run_sizes("--check", which, data=self.data)
            self.assertEqual(done.returncode, 1)
            self.assertIn(mesh, done.stdout)
            self.assertIn("`make sizes`", done.stdout)
            self.assertIn("CHANGELOG.md", done.stdout)

    def test_without_data_the_check_is_skipped_and_old_rows_are_kept(self):
        self.run_sizes(data=self.data)
        self.assertEqual(self.run_sizes("--check", "data").returncode, 77)
        (self.folder / "MORE").write_text("1")
        self.assertEqual(self.run_sizes().returncode, 0)
        self.assertIn("| fin | Heat | 800 | 7 | 3 | 3001 |", self.table.read_text())
        self.assertIn("| comb (old) | Heat | 800 | 7 | 3 | 4000 |", self.table.read_text())
        self.assertEqual(self.run_sizes("--check", "data", data=self.data).returncode, 1)
        self.run_sizes(data=self.data)
        self.assertNotIn("(old)", self.table.read_text())

    def test_what_is_missing_is_named(self):
        self.assertIn("`make sizes` makes it", self.run_sizes("--check", "samples").stderr)
        self.run_sizes()
        self.assertIn(
            "has no row for spx-welded", self.run_sizes("--check", "data", data=self.data).stderr
        )
        (self.data / "comb.vtu").unlink()
        self.assertIn("has no comb.vtu", self.run_sizes(data=self.data).stderr)


if __name__ == "__main__":
    unittest.main()
