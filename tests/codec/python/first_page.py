#!/usr/bin/env python3
"""The part of PYTHON.md that makes and reads logs, as a notebook that was run: first_page.ipynb.

  first_page.py --check        fails where the notebook's cells are not PYTHON.md's (needs nothing)
  first_page.py --write        runs it again with the package `qtet` that Python finds, such as an
                               installed wheel (Debian: python3-nbclient python3-ipykernel
                               python3-meshio)
"""

import argparse
import json
import pathlib
import re
import sys
import tempfile

PYTHON = pathlib.Path(__file__).resolve().parents[3] / "codec/python"
DOCUMENT, NOTEBOOK = PYTHON / "PYTHON.md", PYTHON / "first_page.ipynb"
FIRST, END = "## numpy: making logs\n", "## ParaView\n"
MOST_BYTES = 200_000
SECONDS = 600


def cells_of(document):
    """(type, text) of each cell: prose, or a block of Python that runs."""
    page = document[document.index(FIRST) : document.index(END)]
    cells = []
    for part in re.split(r"^(```python\n.*?^```\n)", page, flags=re.DOTALL | re.MULTILINE):
        is_code = part.startswith("```python\n")
        text = part[len("```python\n") : -len("```\n")] if is_code else part
        if text.strip():
            cells.append(("code" if is_code else "markdown", text.strip("\n")))
    return cells


def notebook_of(cells):
    out = []
    for number, (kind, text) in enumerate(cells):
        cell = {"cell_type": kind, "id": f"cell-{number}", "metadata": {}}
        if kind == "code":
            cell.update(execution_count=None, outputs=[])
        out.append({**cell, "source": text.splitlines(keepends=True)})
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    return {"cells": out, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}


def merged(outputs):
    """The outputs with the pieces of a stream in one."""
    out = []
    for output in outputs:
        is_more = out and output["output_type"] == out[-1]["output_type"] == "stream"
        if is_more and output["name"] == out[-1]["name"]:
            out[-1]["text"] += output["text"]
        else:
            out.append(output)
    return out


def run(notebook):
    """The notebook with its outputs. The mesh part.vtu is the sample `fin` of 20,000 cells."""
    import nbclient
    import nbformat
    from qtet import tool

    with tempfile.TemporaryDirectory() as folder:
        tool.run(["sample", "fin", "-o", f"{folder}/part.vtu"])
        node = nbformat.reads(json.dumps(notebook), as_version=4)
        client = nbclient.NotebookClient(
            node,
            timeout=SECONDS,
            kernel_name="python3",
            resources={"metadata": {"path": folder}},
            record_timing=False,
        )
        client.execute()
        node.metadata.pop("language_info", None)
        for cell in node.cells:
            if cell.cell_type == "code":
                cell.outputs = merged(cell.outputs)
        text = nbformat.writes(node, indent=1) + "\n"
    paths = {folder, str(pathlib.Path.home()), str(PYTHON)}
    found = [path for path in paths if len(path) > 1 and path in text]
    if found:
        sys.exit(f"first_page: an output names {', '.join(found)}")
    return text


def check():
    """The first difference between the notebook and the document, or None."""
    text = NOTEBOOK.read_text(encoding="utf-8")
    if len(text) > MOST_BYTES:
        return f"has {len(text):,} bytes, more than {MOST_BYTES:,}"
    notebook = json.loads(text)
    held = [(cell["cell_type"], "".join(cell["source"])) for cell in notebook["cells"]]
    wanted = cells_of(DOCUMENT.read_text(encoding="utf-8"))
    for number, (have, want) in enumerate(zip(held, wanted)):
        if have != want:
            return f"cell {number} is not PYTHON.md's:\n{want[1]}"
    if len(held) != len(wanted):
        return f"has {len(held)} cells, and PYTHON.md {len(wanted)}"
    for cell in notebook["cells"]:
        outputs = cell.get("outputs", [])
        if cell["cell_type"] == "code" and cell["execution_count"] is None:
            return "was not run"
        if any(output["output_type"] == "error" for output in outputs):
            return "holds an error"
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--check", action="store_true")
    what.add_argument("--write", action="store_true")
    if parser.parse_args().write:
        text = run(notebook_of(cells_of(DOCUMENT.read_text(encoding="utf-8"))))
        NOTEBOOK.write_text(text, encoding="utf-8")
    wrong = check()
    if wrong:
        sys.exit(f"first_page: {NOTEBOOK.name} {wrong}\nrun first_page.py --write")
    print(f"first_page: {NOTEBOOK.name} is PYTHON.md's, {NOTEBOOK.stat().st_size:,} bytes")


main()
