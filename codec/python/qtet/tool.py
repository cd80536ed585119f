"""The program `qtet` from Python: the one in the package's library, the one that is installed, or
the one of the package's WebAssembly, which node runs, and Pyodide in its own process."""
from __future__ import annotations

import ctypes
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
from typing import Callable, Sequence

from . import wasm
from .library import QtetError, library

__all__ = ["call", "is_wasm", "run"]

_PACKAGE = pathlib.Path(__file__).resolve().parent
_FAILED = 1
# As a shell reports a program that Ctrl-C ended.
_INTERRUPTED = 130
_INTERVAL_S = 0.1
# The oldest that runs the WebAssembly.
_NODE = 18
# pip's scripts have some 200 bytes, and a path.
_SCRIPT_BYTES = 8192
_COMMAND = wasm.WEB / "qtet.mjs"


def _is_in_library() -> bool:
    """Whether libqtet.so holds the tool, as that of a wheel for one processor does."""
    try:
        return not wasm.IS_HERE and hasattr(library(), "qtet_main")
    except QtetError:
        return False


def _program() -> list[str]:
    """The first words of a command that runs the tool. Raises QtetError where there is none."""
    if _is_in_library():
        # Within ParaView the program is no Python.
        is_python = pathlib.Path(sys.executable or "").name.startswith("python")
        python = sys.executable if is_python else shutil.which("python3")
        if python is None:
            raise QtetError("the program python3 is not found; install it")
        return [python, "-m", "qtet"]
    # Elsewhere the only one is this package's, which pip made a program.
    program = shutil.which("qtet") if os.name == "posix" else None
    if program is not None and not _is_this_package(program):
        return [program]
    if not _COMMAND.is_file():
        raise QtetError("the program qtet is not found; install the package qtet")
    node = shutil.which("node")
    told = subprocess.run([node, "--version"], capture_output=True, text=True) if node else None
    version = re.match(r"v(\d+)", told.stdout) if told else None
    if node is None or version is None or int(version[1]) < _NODE:
        found = f"node is {told.stdout.strip()}" if told else "node is not found"
        raise QtetError(
            f"{found}; this package of qtet needs node {_NODE} or later for it. "
            "Linux on x86_64 and aarch64 has packages without node"
        )
    return [node, str(_COMMAND)]


def is_wasm() -> bool:
    """Whether the tool is the WebAssembly, which publishes nothing, or is not there at all."""
    try:
        return wasm.IS_HERE or _program()[-1] == str(_COMMAND)
    except QtetError:
        return True


def call(words: Sequence[str | os.PathLike[str]]) -> int:
    """Runs `qtet WORDS...` in this process and returns its exit code. The process can do nothing
    else meanwhile: it is for the command `qtet`, and run() for everybody else. A tool that is not
    in the library runs in a process of its own."""
    if not _is_in_library():
        try:
            if wasm.IS_HERE:
                code, printed, said = wasm.run(words)
                sys.stdout.write(printed)
                sys.stderr.write(said)
                return code
            return subprocess.call([*_program(), *words])
        except KeyboardInterrupt:
            return _INTERRUPTED
        except QtetError as error:
            sys.stderr.write(f"qtet: {error}\n")
            return _FAILED
    # Python's own handlers would wait for the end.
    for number in (signal.SIGINT, signal.SIGPIPE):
        signal.signal(number, signal.SIG_DFL)
    # Formats that meshio reads are read by the Python of this package.
    os.environ["PATH"] = os.pathsep.join(
        [str(pathlib.Path(sys.executable).parent), os.environ.get("PATH", os.defpath)]
    )
    given = [b"qtet", *(os.fsencode(word) for word in words)]
    sys.stdout.flush()
    main = library().qtet_main
    return int(main(len(given), (ctypes.c_char_p * (len(given) + 1))(*given, None)))


def _is_this_package(program: str) -> bool:
    """Whether the program is the script that pip made of this package."""
    with open(program, "rb") as file:
        return b"qtet.__main__" in file.read(_SCRIPT_BYTES)


def run(
    words: Sequence[str | os.PathLike[str]],
    told: bool = False,
    goes_on: Callable[[], bool | None] | None = None,
) -> str | None:
    """Runs `qtet WORDS...` in a process of its own, in Pyodide in this one. Returns what it printed.
    Raises QtetError with its own text where it fails, KeyboardInterrupt after Ctrl-C. `told`: what
    it says of a success goes to the standard error. `goes_on` is called about ten times a second,
    in Pyodide never. The answer False ends the process, and None is returned."""
    code, printed, said = wasm.run(words) if wasm.IS_HERE else _run_apart(words, goes_on)
    if code is None:
        return None
    if code == -signal.SIGINT:
        raise KeyboardInterrupt
    if code != 0:
        lines = [line.removeprefix("qtet: ") for line in said.splitlines()]
        raise QtetError("\n".join(lines) or f"qtet ended with {code}")
    if told:
        sys.stderr.write(said)
    return printed


def _run_apart(
    words: Sequence[str | os.PathLike[str]], goes_on: Callable[[], bool | None] | None
) -> tuple[int | None, str, str]:
    """The exit code, and what was printed to the output and the errors. None: it was stopped."""
    environment = dict(os.environ)
    environment["PYTHONPATH"] = os.pathsep.join(
        filter(None, [str(_PACKAGE.parent), environment.get("PYTHONPATH")])
    )
    with subprocess.Popen(
        [*_program(), *(os.fspath(word) for word in words)],
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
                        return None, "", ""
        except BaseException:
            process.kill()
            raise
    return process.returncode, printed, said
