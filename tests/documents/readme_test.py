#!/usr/bin/env python3
"""readme.py with reports of no real mesh: which false figures it finds, and what it says."""

import pathlib
import tempfile
import textwrap
import unittest
from unittest import mock

import readme

# Every log takes 50,000 bytes at 80,000 cells, in three levels.
REPORT = {
    "tetrahedra": {"full": 80_000},
    "bytes": 50_000,
    "bytesOf": {
        "head": 1_000,
        "connectivity": 20_000,
        "positions": 16_000,
        "fields": {"Heat": 8_000, "Flow": 5_000},
    },
}
LEVELS = [
    {"tetrahedra": 800, "cumulativeBytes": 1_250},
    {"tetrahedra": 4_000, "cumulativeBytes": 9_400},
    {"tetrahedra": 80_000, "cumulativeBytes": 50_000},
]
TRUE = """
    ![A mesh after 1.2 kB (800 cells), 9.4 kB (4,000 cells) and 50 kB (all 80,000 cells)](a.png)
    ![A mesh after 9.4 of 50 kB](b.png)

    The page has 2 kB (gzip).

    | mesh | tetrahedra | s | log | connectivity | positions | all fields | log in all | `.vtu` |
    |---|---|---|---|---|---|---|---|---|
    | fin (built) | 80,000 | 1 | 50 kB | 2.0 bits | 1.6 bits | 1.3 bits | 5.0 bits | 10 bits (raw) |
    | NASA blunt fin | 80,000 | 1 | 50 kB | 2.0 bits | 1.6 bits | 1.3 bits | 5.0 bits | 10 bits |
    | CAD part | 1,324,890 | 1 | 50 kB | 2.0 bits | 1.6 bits | 1.3 bits | 5.0 bits | 10 bits |
"""


class Readme(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def page(self, text):
        path = self.folder / "README.md"
        path.write_text(textwrap.dedent(text))
        return readme.Page(path)

    def faults(self, text):
        page = self.page(text)
        mesh = self.folder / "fin.vtu"
        mesh.write_bytes(bytes(100_000))
        readme.check_words(page)
        readme.check_row(page, readme.FIN, REPORT, mesh)
        readme.check_captions(page, LEVELS)
        readme.check_sizes(page)
        return page.wrong

    def test_true_figures_pass(self):
        self.assertEqual(self.faults(TRUE), [])

    def test_each_false_figure_is_named_with_the_right_one(self):
        for said, false, expected in [
            ("80,000 | 1", "80,001 | 1", "tetrahedra: it says 80,001, right is 80,000"),
            ("50 kB | 2.0", "51 kB | 2.0", "log: it says 51 kB, right is 50 kB"),
            ("2.0 bits", "2.1 bits", "connectivity: it says 2.1 bits, right is 2.0 bits"),
            ("1.6 bits", "1.7 bits", "positions: it says 1.7 bits, right is 1.6 bits"),
            ("1.3 bits", "1.2 bits", "all fields: it says 1.2 bits, right is 1.3 bits"),
            ("5.0 bits", "5.1 bits", "log in all: it says 5.1 bits, right is 5.0 bits"),
            ("10 bits (raw)", "11 bits (raw)", ".vtu: it says 11 bits, right is 10 bits"),
            ("1.2 kB (800", "1.3 kB (800", "it says 1.3 kB, right is 1.2 kB; node tests/browser/"),
            ("(4,000 cells)", "(4,100 cells)", "it says 4,100, right is 4,000"),
            ("50 kB (all", "52 kB (all", "it says 52 kB, right is 50 kB"),
            ("9.4 of 50", "9.9 of 50", "no level takes 9.9 kB"),
            ("9.4 of 50", "9.4 of 51", "all: it says 51 kB, right is 50 kB"),
            ("1,324,890", "1,324,891", "it says 1,324,891, right is 1,324,890"),
            ("| fin (built", "| fun (built", "has no row fin"),
            ("The page", "The page " + 1100 * "word ", "at most 1100 are allowed"),
        ]:
            [sentence] = self.faults(TRUE.replace(said, false, 1))
            self.assertIn(expected, sentence)

    def test_the_weight_counts_what_the_page_asks_for(self):
        viewer = self.folder / "viewer"
        (viewer / "assets").mkdir(parents=True)
        for name, text, size in [
            ("index.html", '<script src="./assets/main.js"></script>', 500),
            ("assets/main.js", 'import{a}from"./part.js";import("./late.js")', 1000),
            ("assets/part.js", "", 1500),
            ("assets/late.js", "", 9000),
        ]:
            (viewer / name).write_text(text)
            (viewer / f"{name}.gz").write_bytes(bytes(size))
        first, every = readme.weigh(viewer)
        self.assertEqual((first, every), (3.0, 12.0))
        page = self.page(TRUE)
        readme.check_weight(page, "first", r"(\d+) kB \(gzip\)", first)
        self.assertEqual(page.wrong, ["README.md: first: it says 2 kB, right is 3 kB"])

    def test_meshes_of_a_folder(self):
        for name in ("bluntfin", "linkrods-1m"):
            (self.folder / f"{name}.vtu").write_bytes(bytes(100_000))
        args = mock.Mock(tool="qtet")
        with (
            mock.patch.dict("os.environ", {"QTET_DATA": str(self.folder)}),
            mock.patch("readme.simplified", return_value=REPORT),
        ):
            self.assertEqual(
                readme.check_data(args, self.page(TRUE)),
                ["README.md: CAD part, tetrahedra: it says 1,324,890, right is 80,000"],
            )
            (self.folder / "bluntfin.vtu").unlink()
            with self.assertRaisesRegex(readme.Failure, "bluntfin.vtu is missing"):
                readme.check_data(args, self.page(TRUE))


if __name__ == "__main__":
    unittest.main()
