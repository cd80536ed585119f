"""Annotations: mypy --strict finds nothing in the package, nor in a program that uses it.
   types_test.py MODULES FOLDER-TO-WRITE-TO; ends with 77 without mypy."""
import importlib.util
import os
import pathlib
import subprocess
import sys

modules, out = sys.argv[1:]
for name in ("mypy", "numpy"):
    if importlib.util.find_spec(name) is None:
        print(f"skipped: {name} is not installed (Debian: {'python3-' * (name != 'mypy')}{name})")
        sys.exit(77)

_PROGRAM = '''
from typing import Optional, Tuple
import qtet, qtet.hosting, qtet.vtk
def told(path: str) -> Tuple[str, int, Optional[int], float]:
    with qtet.open(path) as log:
        log.refine(log.level_of_error("Heat", 0.01))
        names: str = ", ".join(field.name for field in log.fields)
        most = float(log.field("Heat", time=0.5, method="nearest").max())
        return names + log.info.source, len(log.arrays("Heat").cells), log.level, most
def shown(data: bytes) -> str:
    server: qtet.hosting.Server = qtet.serve(data, port=0)
    qtet.vtk.read(data, level=0)
    return qtet.page([data], "a.html", times=[0]) + qtet.show(data).told + server.url
reveal_type(qtet.open(b"").info.latticeStep)
reveal_type(qtet.open(b"").times)
'''

folder = pathlib.Path(out)
folder.mkdir(parents=True, exist_ok=True)
(folder / "program.py").write_text(_PROGRAM)
# VTK has types from 9.2 on alone; ParaView's plugins are classes of modules without types.
files = pathlib.Path(modules, "qtet").glob("*.py")
package = [path for path in files if "paraview" not in path.name]
found = subprocess.run(
    [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", "--no-color-output"]
    + ["--cache-dir", str(folder / "cache")]
    + [str(path) for path in [*package, folder / "program.py"]],
    env={**os.environ, "MYPYPATH": modules},
    capture_output=True,
    text=True,
    check=False,
)
said = [line for line in found.stdout.splitlines() if "note: Revealed" in line]
types = [line.split('"')[1] for line in said]
assert types == ["builtins.float", "builtins.list[builtins.float]"], found.stdout + found.stderr
assert found.returncode == 0, found.stdout
print("mypy --strict finds nothing")
