"""Where logs come from and go to: files, and URLs of which only the front is fetched."""
from __future__ import annotations

import errno
import os
import pathlib
import struct
import tempfile
import urllib.error
import urllib.parse
import urllib.request
from typing import Any

from . import wasm
from .library import QtetError

_HEADER_BYTES = 64  # FORMAT.md, "Header"
_MAGIC = b"\x89QTET\r\n\x1a"
_TIMEOUT_S = 60
_PIECE_BYTES = 1 << 20  # read from the network at a time


def check_readable(path: str | os.PathLike[str]) -> None:
    """Raises FileNotFoundError, PermissionError or IsADirectoryError, as Python's open()."""
    with open(path, "rb"):
        pass


def check_output(path: str | os.PathLike[str]) -> None:
    """Refuses a place for a log before the work, as the program `qtet simplify` does, and a file
    that holds something else. Raises ValueError for another ending, and OSError."""
    file = pathlib.Path(path)
    if file.suffix != ".qtet":
        raise ValueError(f"the output {file} must end in .qtet")
    folder = file.resolve().parent
    if not folder.is_dir():
        raise FileNotFoundError(errno.ENOENT, "make the output's folder first", str(folder))
    if file.is_dir():
        raise IsADirectoryError(errno.EISDIR, "the output is a folder", str(file))
    if not os.access(folder, os.W_OK):
        raise PermissionError(errno.EACCES, "the output's folder cannot be written", str(folder))
    if file.exists():
        with file.open("rb") as old:
            if old.read(len(_MAGIC)) not in (_MAGIC, b""):
                raise FileExistsError(
                    errno.EEXIST, "the output is no log; choose another name", str(file)
                )


class Remote:
    """A log behind a URL as a sparse file of which only the front is filled."""

    def __init__(self, url: str) -> None:
        self.url, self.have = url, 0
        self.tag: str | None = None
        self.file = tempfile.NamedTemporaryFile(prefix="qtet-", suffix=".qtet")
        head = self._get(0, _HEADER_BYTES)
        if len(head) < _HEADER_BYTES or not head.startswith(_MAGIC):
            raise QtetError(
                f"{url} is no qtet log; give the URL of a .qtet file,"
                " or http://host/v1/meshes/NAME of a qtet-server"
            )
        self.bytes, manifest, table = struct.unpack_from("<QII", head, 16)
        self.file.truncate(max(self.bytes, self.have))
        self.need(_HEADER_BYTES + manifest + table)

    def need(self, end: int) -> bool:
        """Whether bytes came: the front up to `end` is there afterwards."""
        end = min(end, self.bytes)
        if end <= self.have:
            return False
        self._get(self.have, end)
        return True

    def _get(self, first: int, end: int) -> bytes:
        """Writes the bytes [first, end) of the log to the file; the first ones of them are the
        answer."""
        try:
            with _asked(self.url, f"bytes={first}-{end - 1}") as answer:
                self._same_log(answer)
                return self._store(answer, first if answer.status == 206 else 0, end)
        except (urllib.error.URLError, OSError, ValueError) as error:
            raise QtetError(
                f"{self.url} cannot be fetched: {error}; is the server running, and the name right?"
            ) from error

    def _same_log(self, answer: Any) -> None:
        tag = answer.headers.get("ETag")
        if self.tag is not None and tag != self.tag:
            raise QtetError(f"{self.url} was replaced by another log meanwhile; open it again")
        self.tag, self.url = tag, answer.geturl()  # behind a redirection lies one log for ever

    def _store(self, answer: Any, at: int, end: int) -> bytes:
        start = b""
        self.file.seek(at)
        while piece := answer.read(_PIECE_BYTES):
            start = start or piece
            self.file.write(piece)
            at += len(piece)
        self.file.flush()
        if self.have and at < end:
            raise QtetError(
                f"{self.url} ended after {at} bytes, {end} were asked for; fetch it again"
            )
        self.have = max(self.have, at)
        return start


def _asked(url: str, bytes_: str) -> Any:
    """The answer to a GET of a range of bytes."""
    headers = {"Range": bytes_}
    if wasm.IS_HERE:
        return wasm.fetch(url, headers)
    request = urllib.request.Request(url, headers={**headers, "Accept-Encoding": "identity"})
    return urllib.request.urlopen(request, timeout=_TIMEOUT_S)


def log_url(source: str | os.PathLike[str]) -> str | None:
    """The URL of the log's bytes, or None for a file."""
    parts = urllib.parse.urlsplit(str(source))
    if parts.scheme not in ("http", "https"):
        return None
    mesh = urllib.parse.parse_qs(parts.query).get("mesh")
    if mesh and not parts.path.startswith("/v1/"):
        folder = parts.path[: parts.path.rfind("/") + 1] or "/"
        parts = parts._replace(
            path=folder + "v1/meshes/" + urllib.parse.quote(mesh[0], safe=""), query="", fragment=""
        )
    if (
        "/v1/meshes/" in parts.path
        and parts.path.rpartition("/v1/meshes/")[2].strip("/").count("/") == 0
    ):
        parts = parts._replace(path=parts.path.rstrip("/") + "/log")
    return urllib.parse.urlunsplit(parts)
