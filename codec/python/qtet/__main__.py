"""The command `qtet`, also as `python -m qtet`."""
from __future__ import annotations

import argparse
import os
import signal
import sys
import webbrowser

from . import hosting, tool
from .library import QtetError


def _arguments(name: str, words: list[str]) -> tuple[argparse.Namespace, list[str]]:
    is_view = name == "view"
    parser = argparse.ArgumentParser(
        prog=f"qtet {name}",
        allow_abbrev=False,
        description="Shows a log or a mesh in the browser until Ctrl-C, on this machine alone. A "
        "mesh becomes a temporary log first, by `qtet simplify` and its options."
        if is_view
        else "Serves logs and the viewer on this machine alone until Ctrl-C. For others: qtet "
        "publish makes a folder for any web server, and qtet-server is one.",
    )
    if is_view:
        parser.add_argument("files", nargs=1, metavar="FILE", help="a log, NAME.qtet, or a mesh")
        parser.add_argument("--no-open", action="store_true", help="only print the address")
    else:
        parser.add_argument("files", nargs="+", metavar="LOG.qtet", help="logs")
    parser.add_argument("--port", type=int, default=0, help="TCP port on 127.0.0.1; 0 = any free")
    given, rest = parser.parse_known_args(words)
    if rest and (not is_view or given.files[0].endswith(".qtet")):
        parser.error("these words are not known: " + " ".join(rest))
    return given, rest


def _serve(name: str, words: list[str]) -> int:
    given, options = _arguments(name, words)
    # As Ctrl-C does: the temporary files go.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        with hosting.serve(*given.files, port=given.port, options=options, told=True) as server:
            print(server.url, flush=True)
            print("qtet: Ctrl-C stops", file=sys.stderr)
            has_desktop = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
            if name == "view" and has_desktop and not given.no_open:
                webbrowser.open(server.url)
            server.wait()
        return 0
    except KeyboardInterrupt:
        return 0
    except (QtetError, OSError) as error:
        print(f"qtet: {error}", file=sys.stderr)
        return 1


def main() -> int:
    words = sys.argv[1:]
    # The WebAssembly's `view` opens a file.
    if words[:1] == ["serve"] or (words[:1] == ["view"] and not tool.is_wasm()):
        return _serve(words[0], words[1:])
    return tool.call(words)


if __name__ == "__main__":
    sys.exit(main())
