"""The program `qtet` from Python: the one in the package's library, or the one that is installed."""
from __future__ import annotations

import ctypes
import os
import pathlib
import shutil
import signal
import subprocess
import sys
from typing import Callable, Sequence

from .library import QtetError, library

__all__ = ["call", "run"]

_PACKAGE = pathlib.Path(__file__).resolve().parent
_FAILED = 1
_INTERVAL_S = 0.1


def _is_in_library() -> bool:
    return hasattr(library(), "qtet_main")


def call(words: Sequence[str | os.PathLike[str]]) -> int:
    """Runs `qtet WORDS...` in this process and returns its exit code. The process can do nothing
    else meanwhile: it is for the command `qtet`, and run() for everybody else."""
    if not _is_in_library():
        program = shutil.which("qtet")
        if program is None or _is_this_package(program):
            sys.stderr.write("qtet: this libqtet.so holds no tool; install the package qtet\n")
            return _FAILED
        return subprocess.call([program, *words])
    # Python's own handlers would wait for the end.
    for number in (signal.SIGINT, signal.SIGPIPE):
        signal.signal(number, signal.SIG_DFL)
    # Formats that meshio reads are read by the Python of this package.
    os.environ["PATH"] = os.pathsep.join(
        [str(pathlib.Path(sys.executable).parent), os.environ.get("PATH", os.defpath)]
    )
    given = [b"qtet", *(os.fsencode(word) for word in words)]
    sys.stdout.flush()
    code: int = library().qtet_main(len(given), (ctypes.c_char_p * (len(given) + 1))(*given, None))
    return code


def _is_this_package(program: str) -> bool:
    """Whether the program is the script that pip made of this package."""
    with open(program, "rb") as file:
        return file.read(2) == b"#!"


def run(
    words: Sequence[str | os.PathLike[str]],
    told: bool = False,
    goes_on: Callable[[], bool | None] | None = None,
) -> str | None:
    """Runs `qtet WORDS...` in a process of its own. Returns what it printed. Raises QtetError with
    its own text where it fails, KeyboardInterrupt after Ctrl-C. `told`: what it says of a success
    goes to the standard error. `goes_on` is called about ten times a second; the answer False ends
    the process, and None is returned."""
    environment = dict(os.environ)
    environment["PYTHONPATH"] = os.pathsep.join(
        filter(None, [str(_PACKAGE.parent), environment.get("PYTHONPATH")])
    )
    # Within ParaView the program is no Python.
    is_python = pathlib.Path(sys.executable or "").name.startswith("python")
    python = sys.executable if is_python else shutil.which("python3")
    program = python if _is_in_library() else shutil.which("qtet")
    if program is None:
        raise QtetError("the program qtet is not found; install the package qtet")
    command = [program, "-m", "qtet"] if _is_in_library() else [program]
    with subprocess.Popen(
        [*command, *(os.fspath(word) for word in words)],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        errors="replace",
        env=environment,
    ) as process:
        try:
            while True:
                try:
                    printed, said = process.communicate(timeout=_INTERVAL_S)
                    break
                except subprocess.TimeoutExpired:
                    if goes_on and goes_on() is False:
                        process.terminate()
                        process.communicate()
                        return None
        except BaseException:
            process.kill()
            raise
    if process.returncode == -signal.SIGINT:
        raise KeyboardInterrupt
    if process.returncode != 0:
        lines = [line.removeprefix("qtet: ") for line in said.splitlines()]
        raise QtetError("\n".join(lines) or f"qtet ended with {process.returncode}")
    if told:
        sys.stderr.write(said)
    return printed
