"""A folder as `qtet publish` makes it, behind HTTP on this machine alone (127.0.0.1)."""
from __future__ import annotations

import contextlib
import http.server
import os
import pathlib
import re
import shutil
import tempfile
import threading
import urllib.parse
import webbrowser
from typing import Any, BinaryIO, Sequence

from . import tool
from .library import QtetError
from .log import Log
from .sources import Remote, check_readable, log_url

__all__ = ["Server", "serve", "view"]

_ADDRESS = "127.0.0.1"
_TYPES = {
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".svg": "image/svg+xml",
    ".txt": "text/plain; charset=utf-8",
    ".wasm": "application/wasm",
    ".webp": "image/webp",
}
_PIECE_BYTES = 1 << 18


class _Handler(http.server.BaseHTTPRequestHandler):
    """GET and HEAD of files, whole or one range of them (RFC 9110, section 14)."""

    protocol_version = "HTTP/1.1"
    folder = pathlib.Path()
    # Small answers would wait for the other side's acknowledgement.
    disable_nagle_algorithm = True

    def do_GET(self) -> None:
        self._answer(True)

    def do_HEAD(self) -> None:
        self._answer(False)

    def log_message(self, *_: Any) -> None:
        pass

    def _answer(self, with_body: bool) -> None:
        # A page of another site whose name leads here must read nothing.
        if self.headers.get("Host", "").rsplit(":", 1)[0] not in (_ADDRESS, "localhost"):
            return self.send_error(421, "Misdirected Request")
        path = self._file()
        if path is None:
            return self.send_error(404)
        with open(path, "rb") as file:
            size = os.fstat(file.fileno()).st_size
            first, last, is_part = 0, size - 1, False
            asked = re.fullmatch(r"bytes=(\d*)-(\d*)", self.headers.get("Range", ""))
            if asked and any(asked.groups()):
                first, last = _range(asked[1], asked[2], size)
                is_part = True
            if is_part and first > last:
                self.send_response(416)
                self.send_header("Content-Range", f"bytes */{size}")
                self.send_header("Content-Length", "0")
                return self.end_headers()
            self.send_response(206 if is_part else 200)
            self.send_header("Content-Type", _TYPES.get(path.suffix, "application/octet-stream"))
            self.send_header("Content-Length", str(last + 1 - first))
            self.send_header("Accept-Ranges", "bytes")
            self.send_header("Cache-Control", "no-cache")
            self.send_header("X-Content-Type-Options", "nosniff")
            if is_part:
                self.send_header("Content-Range", f"bytes {first}-{last}/{size}")
            self.end_headers()
            if with_body:
                self._send(file, first, last + 1 - first)
        return None

    def _send(self, file: BinaryIO, first: int, count: int) -> None:
        file.seek(first)
        with contextlib.suppress(ConnectionError):
            while count > 0:
                piece = file.read(min(count, _PIECE_BYTES))
                if not piece:
                    break
                self.wfile.write(piece)
                count -= len(piece)

    def _file(self) -> pathlib.Path | None:
        """The file of the request's path; None: there is none within the folder."""
        name = urllib.parse.unquote(urllib.parse.urlsplit(self.path).path).lstrip("/")
        try:
            path = (self.folder / (name or "index.html")).resolve(strict=True)
        except (OSError, ValueError):
            return None
        return path if path.is_file() and self.folder in path.parents else None


def _range(first: str, last: str, size: int) -> tuple[int, int]:
    """The first and the last byte; an empty range where there is nothing to send."""
    if not first:
        return max(0, size - int(last)), size - 1
    return int(first), min(int(last), size - 1) if last else size - 1


class Server:
    """Serves until close(), or until the process ends. With `with` it is closed at the end.

    url     the viewer's address, which shows the first mesh
    folder  what it serves"""

    url: str
    folder: pathlib.Path

    def __init__(
        self,
        folder: pathlib.Path,
        port: int = 0,
        owned: tempfile.TemporaryDirectory[str] | None = None,
    ) -> None:
        """`owned`: a temporary folder that goes with the server."""
        if not 0 <= port < 1 << 16:
            raise ValueError(f"the port is {port}; give 0 to 65535")
        handler: Any = type("Handler", (_Handler,), {"folder": pathlib.Path(folder).resolve()})
        self.folder, self._owned = handler.folder, owned
        try:
            self._http = http.server.ThreadingHTTPServer((_ADDRESS, port), handler)
        except OSError as error:
            raise QtetError(f"port {port} cannot be used ({error}); give another one") from error
        self._http.daemon_threads = True
        self.url = f"http://{_ADDRESS}:{self._http.server_address[1]}/"
        self._thread = threading.Thread(
            target=self._http.serve_forever, name="qtet.serve", daemon=True
        )
        self._thread.start()

    def wait(self) -> None:
        """Returns when the server is closed."""
        while self._thread.is_alive():
            self._thread.join(1)

    def close(self) -> None:
        self._http.shutdown()
        self._http.server_close()
        self._thread.join()
        if self._owned is not None:
            self._owned.cleanup()
            self._owned = None

    def __enter__(self) -> Server:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<qtet.Server {self.url}>"


def _log_name(path: str | os.PathLike[str]) -> str:
    """A log's name that needs no quoting in an address."""
    stem = pathlib.Path(path).stem
    return re.sub(r"[^A-Za-z0-9.-]", "_", stem).lstrip(".") or "mesh"


def _free(folder: pathlib.Path, name: str) -> pathlib.Path:
    """The path of a log that is not there yet."""
    path, again = folder / f"{name}.qtet", 1
    while path.exists():
        again += 1
        path = folder / f"{name}-{again}.qtet"
    return path


def _log_of_path(
    source: str | os.PathLike[str],
    folder: pathlib.Path,
    is_log: bool,
    options: Sequence[str],
    told: bool,
) -> pathlib.Path:
    url = log_url(source)
    if url is not None:
        remote = Remote(url)
        remote.need(remote.bytes)
        return pathlib.Path(shutil.copyfile(remote.file.name, _free(folder, "mesh")))
    check_readable(source)
    path = pathlib.Path(source)
    if path.suffix == ".qtet":
        return path
    log = _free(folder, _log_name(path))
    if is_log:
        return pathlib.Path(shutil.copyfile(path, log))
    tool.run(["simplify", path, "-o", log, "--quiet", *options], told)
    return log


def log_of(
    source: Any,
    folder: pathlib.Path,
    options: Sequence[str] = (),
    told: bool = False,
    times: Sequence[float] | None = None,
) -> pathlib.Path:
    """The path of a log: the file itself, or what is made in `folder` of a mesh, of bytes, of an
    open log. `options`: words for `qtet simplify`; `told`: it may print its notes; `times`: those
    of a list of grids."""
    is_log = isinstance(source, Log)
    if is_log:
        source = source.source
    if isinstance(source, (bytes, bytearray, memoryview)):
        log = _free(folder, "mesh")
        log.write_bytes(source)
        return log
    if isinstance(source, (str, os.PathLike)):
        return _log_of_path(source, folder, is_log, options, told)
    from .simplifier import simplify

    of_list = times if isinstance(source, (list, tuple)) else None
    if isinstance(source, (list, tuple)) and times is None:
        raise ValueError(f"{len(source)} grids without times; give times=[...], one each")
    return pathlib.Path(simplify(source, times=of_list, path=_free(folder, "mesh")))


def serve(
    *sources: Any,
    times: Sequence[float] | None = None,
    port: int = 0,
    options: Sequence[str] = (),
    told: bool = False,
) -> Server:
    """Shows meshes in the browser of this machine: a Server, which has their address.

    sources   logs: paths, URLs, bytes, open ones; paths of mesh files; grids as simplify() takes
              them, and lists of grids
    times     of the grids in a list
    port      on 127.0.0.1; 0: any free one
    options   of mesh files: words for `qtet simplify`
    told      warnings go to the standard error

    Raises QtetError, and OSError for a file that cannot be opened. Others reach what `qtet publish`
    writes by any web server, or a qtet-server."""
    owned = tempfile.TemporaryDirectory(prefix="qtet-")
    try:
        folder = pathlib.Path(owned.name)
        logs = [log_of(source, folder, options, told, times) for source in sources]
        tool.run(["publish", folder / "site", *logs, "--plain"])
        return Server(folder / "site", port, owned)
    except BaseException:
        owned.cleanup()
        raise


def view(
    *sources: Any,
    times: Sequence[float] | None = None,
    port: int = 0,
    options: Sequence[str] = (),
) -> Server:
    """serve(), and the browser on it."""
    server = serve(*sources, times=times, port=port, options=options)
    webbrowser.open(server.url)
    return server
