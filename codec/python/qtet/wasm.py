"""qtet-tool.wasm in Pyodide, where no native library can be loaded: the functions of libqtet.so, and
the tool's commands. Its memory is not that of Python, so arguments are copied to it and back.

Pyodide's ctypes and the module have the same layouts of structs: both are of 32 bits."""
from __future__ import annotations

import ctypes
import functools
import io
import json
import os
import pathlib
import sys
import tempfile
from typing import Any, Mapping, Sequence

from .library import OUT_OF_MEMORY, QtetError

__all__ = ["IS_HERE", "WEB", "Answer", "WasmLibrary", "fetch", "run"]

IS_HERE = sys.platform == "emscripten"
# The wheel without a native library carries this.
WEB = pathlib.Path(__file__).resolve().parent / "web"
_NULL = 0


@functools.lru_cache(maxsize=None)
def _module() -> Any:
    """The module, compiled once (web-client/tool/pyodide_host.ts)."""
    if not (WEB / "tool.js").is_file():
        raise QtetError("this package has no WebAssembly; install its wheel py3-none-any")
    import pyodide_js
    from pyodide.code import run_js

    script = (WEB / "tool.js").read_text("utf-8")
    make = run_js(f"(() => {{{script}; return (...words) => new qtetTool.Module(...words);}})()")
    return make(pyodide_js.FS, str(WEB / "qtet-tool.wasm"))


def _environment() -> str:
    own = {
        "PWD": os.getcwd(),
        "TMPDIR": tempfile.gettempdir(),
        "QTET_VIEWER": str(WEB / "viewer"),
    }
    return json.dumps({**os.environ, **own})


def run(words: Sequence[str | os.PathLike[str]]) -> tuple[int, str, str]:
    """Runs `qtet WORDS...`: the exit code, and what it printed to the output and the errors. Raises
    QtetError for what a page cannot take: bytes on the standard output, and another page."""
    given = [os.fspath(word) for word in words]
    if any(word in ("-", "-o-") or word.endswith("=-") for word in given):
        raise QtetError("in Pyodide files have names; give one instead of -")
    if given[:1] == ["view"]:
        raise QtetError("in Pyodide qtet.show shows a mesh or a log in a notebook's cell")
    code, printed, said = _module().run(json.dumps(given), _environment())
    return code, printed, said


class Answer(io.BytesIO):
    """What a server answered, as urllib has it."""

    def __init__(self, request: Any) -> None:
        super().__init__(request.response.to_bytes())
        self.status = int(request.status)
        self.headers = {"ETag": request.getResponseHeader("ETag")}
        self._url = str(request.responseURL)

    def geturl(self) -> str:
        return self._url


def fetch(url: str, headers: Mapping[str, str]) -> Answer:
    """GET by the browser, which waits for no answer but in a worker. Raises OSError."""
    import js
    from pyodide.ffi import JsException

    request = js.XMLHttpRequest.new()
    try:
        request.open("GET", url, False)
        request.responseType = "arraybuffer"
        for name, value in headers.items():
            request.setRequestHeader(name, value)
        request.send()
    except JsException as error:
        raise OSError(str(error)) from error
    if not 200 <= request.status < 300:
        raise OSError(f"HTTP {request.status} {request.statusText}")
    return Answer(request)


class WasmLibrary:
    """The module as a library.Library. Arguments are integers, numbers of ctypes, bytes, pointers
    to structs, and arrays of ctypes; arrays are only written to."""

    calls_back = False

    def __init__(self) -> None:
        self._c = _module().library(_environment())
        self._failure: tuple[type[Exception], str] | None = None

    @property
    def is_broken(self) -> bool:
        """Whether the module ended in the middle of a call. Its memory is not to be trusted."""
        return self._failure is not None

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or not self._c.has(name):
            raise AttributeError(name)
        return functools.partial(self._call, name)

    def text_at(self, address: int) -> str:
        return str(self._c.text(address))

    def bytes_at(self, address: int, size: int) -> bytes:
        return bytes(self._c.bytes(address, size).to_bytes())

    def place(self, data: Any) -> int:
        """Copies the bytes of an object, and a NUL behind them. Returns where they are."""
        plain = data if isinstance(data, bytes) else _bytes_of(data)
        address: int = self._run("malloc", len(plain) + 1)
        if address == _NULL:
            raise MemoryError(f"no memory for {len(plain)} bytes")
        self._c.bytes(address, len(plain)).assign(plain)
        self._c.bytes(address + len(plain), 1).assign(b"\0")
        return address

    def release(self, address: int) -> None:
        if not self.is_broken:
            self._run("free", address)

    def _call(self, name: str, *arguments: Any) -> Any:
        if self.is_broken and name.endswith("_destroy"):
            return None  # there is nothing to give back
        words: list[Any] = []
        placed: list[tuple[Any, int]] = []
        try:
            for argument in arguments:
                given = argument.contents if isinstance(argument, ctypes._Pointer) else argument
                if isinstance(given, (bytes, ctypes.Structure, ctypes.Array)):
                    placed.append((given, self.place(given)))
                    words.append(placed[-1][1])
                else:
                    words.append(_word_of(given))
            result = self._run(name, *words)
            if name == "qtet_simplify" and result == OUT_OF_MEMORY:
                # Functions that know no exceptions have not given their memory back.
                text = self.text_at(self._run("qtet_simplified_error", words[0]))
                self._failure = MemoryError, text
                raise MemoryError(text)
            for given, address in placed:
                if not isinstance(given, bytes):
                    size = ctypes.sizeof(given)
                    ctypes.memmove(ctypes.byref(given), self.bytes_at(address, size), size)
            return result
        finally:
            for _, address in placed:
                self.release(address)

    def _run(self, name: str, *words: Any) -> Any:
        from pyodide.ffi import JsException

        if self._failure is None:
            try:
                return self._c.call(name, *words)
            except JsException as error:
                kind = MemoryError if self._c.isFull else QtetError
                self._failure = kind, str(error).removeprefix("Error: ")
        kind, text = self._failure
        raise kind(text)


def _bytes_of(data: Any) -> Any:
    """Those of a packed array of numpy, or of an object of ctypes."""
    is_numpy = hasattr(data, "ctypes") and data.nbytes > 0
    return memoryview(data).cast("B") if is_numpy else bytes(data)


def _word_of(value: Any) -> Any:
    """As call() takes it: an integer of 64 bits as a text."""
    if isinstance(value, ctypes.c_uint64):
        return str(value.value)
    if isinstance(value, ctypes._SimpleCData):
        value = value.value
    return _NULL if value is None else value
