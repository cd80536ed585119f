"""Builds the wheel (PEP 517) of what CMake made: the package's library, the viewer and the modules.

The wheel fits every Python 3.9 and later on one processor: this one, or aarch64, for which Debian's
cross compiler makes the library. The modules reach the library by ctypes.
A pure wheel fits all others. It holds the tool and the library as WebAssembly, for Pyodide and
node.
The same sources and build machine give the same bytes.

   python_backend.py FOLDER [aarch64|pure]"""
import base64
import gzip
import hashlib
import io
import json
import os
import pathlib
import platform
import re
import subprocess
import sys
import tarfile
import tempfile
import time
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build/release"
LIBRARY = "package/qtet/libqtet.so"
TOOL = "qtet-tool.wasm"
PURE = "py3-none-any"
# Builds for another processor have its Debian packages in root/.
AARCH64 = ROOT / "build/aarch64"
# Processors as readelf calls them, and as tags of wheels do. Others build for themselves alone.
_PROCESSORS = {"AArch64": "aarch64", "Advanced Micro Devices X86-64": "x86_64"}
NAME = "qtet"
# Members carry one date: that of the last change, or this one, the earliest that a zip can hold.
_EARLIEST = 315532800
# Debian's packages of what is linked statically into the library.
LINKED = (
    "libdraco-dev libboost-program-options-dev libhdf5-dev libaec-dev libexpat1-dev libdeflate-dev "
    "liblz4-dev liblzma-dev libmetis-dev libwebp-dev libbrotli-dev zlib1g-dev nlohmann-json3-dev"
).split()


def version():
    text = (ROOT / "CMakeLists.txt").read_text()
    return re.search(r"project\(qtet VERSION ([\d.]+)", text).group(1)


def date():
    """Seconds: SOURCE_DATE_EPOCH, or the last commit's."""
    told = os.environ.get("SOURCE_DATE_EPOCH")
    if not told:
        done = subprocess.run(
            ["git", "-C", ROOT, "log", "-1", "--format=%ct"], capture_output=True, text=True
        )
        told = done.stdout.strip() if done.returncode == 0 else ""
    return max(int(told or 0), _EARLIEST)


def _metadata(system="POSIX :: Linux"):
    return f"""Metadata-Version: 2.4
Name: {NAME}
Version: {version()}
Summary: Tetrahedral meshes as small logs that a browser shows coarse-first
License-Expression: Apache-2.0
License-File: LICENSE
License-File: third-party.txt
Classifier: Operating System :: {system}
Classifier: Programming Language :: Python :: 3
Classifier: Topic :: Scientific/Engineering :: Visualization
Requires-Python: >=3.9
Requires-Dist: numpy
Description-Content-Type: text/markdown

""" + (ROOT / "codec/python/PYTHON.md").read_text()


def tag(told):
    """Names the processor, and the oldest glibc that has what the library needs (PEP 600). `told`
    is what readelf -hVW says of it."""
    machine = re.search(r"^ *Machine: +(.+?) *$", told, re.M).group(1)
    needed = max(map(int, re.findall(r"GLIBC_2\.(\d+)", told)))
    return f"py3-none-manylinux_2_{needed}_{_PROCESSORS.get(machine, platform.machine())}"


def _notices(root):
    """The licences of what the library holds, as Debian's packages below `root` state them."""
    # Cross compilers have the version of Debian's own.
    compiler = subprocess.run(["g++", "-dumpversion"], capture_output=True, text=True, check=True)
    parts = []
    for package in [*LINKED, f"libstdc++-{compiler.stdout.strip().split('.')[0]}-dev"]:
        path = root / "usr/share/doc" / package / "copyright"
        if not path.is_file():
            raise SystemExit(f"{path} is missing; a wheel is made on Debian, after make setup")
        parts.append(f"==== {package}\n\n{path.read_text(errors='replace')}")
    return "\n".join(parts)


def _viewer(folder):
    """The viewer's files as members in a folder of the package."""
    viewer = BUILD / "share/qtet/viewer"
    # Compressed copies are made again where the viewer is published. Meshes are simplified by the
    # library, not in the browser.
    without = json.loads(_needed(viewer / "viewer.json"))["simplifier"]
    for path in sorted(viewer.rglob("*")):
        is_copy = path.suffix in (".gz", ".br", ".zst")
        name = path.relative_to(viewer).as_posix()
        if path.is_file() and not is_copy and name not in without:
            yield f"{NAME}/{folder}/{name}", path.read_bytes(), False


def _needed(path):
    if not path.is_file():
        raise SystemExit(f"{path} is missing; run make wheel")
    return path.read_bytes()


def _members(parts, tag, notices):
    """(name in the wheel, bytes, whether it may be executed), without the record. `parts` are those
    of one kind of wheel."""
    members = list(parts)
    for path in sorted((ROOT / "codec/python/qtet").iterdir()):
        if path.suffix == ".py" or path.name == "py.typed":
            members.append((f"{NAME}/{path.name}", path.read_bytes(), False))
    info = f"{NAME}-{version()}.dist-info"
    is_pure = tag == PURE
    wheel = (
        f"Wheel-Version: 1.0\nGenerator: qtet {version()}\n"
        f"Root-Is-Purelib: {str(is_pure).lower()}\nTag: {tag}\n"
    )
    for name, text in (
        ("METADATA", _metadata("OS Independent") if is_pure else _metadata()),
        ("WHEEL", wheel),
        ("entry_points.txt", "[console_scripts]\nqtet = qtet.__main__:main\n"),
        ("licenses/LICENSE", (ROOT / "LICENSE").read_text()),
        ("licenses/third-party.txt", notices),
    ):
        members.append((f"{info}/{name}", text.encode(), False))
    return members, f"{info}/RECORD"


def _record(members, own):
    lines = []
    for name, content, _ in members:
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        lines.append(f"{name},sha256={digest},{len(content)}")
    return "\n".join([*lines, f"{own},,", ""]).encode()


def _make(*words):
    subprocess.run(["make", "-C", ROOT, *words], check=True, stdout=sys.stderr)


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Writes the wheel for this processor and returns its name."""
    _make("build", "TARGETS=--target qtet_package_library qtet_viewer")
    return _native_wheel(wheel_directory, BUILD / LIBRARY, pathlib.Path("/"))


def build_aarch64_wheel(wheel_directory):
    """The same for aarch64. The modules and the viewer fit every processor."""
    _make("build", "TARGETS=--target qtet_viewer")
    _make("build-aarch64")
    return _native_wheel(wheel_directory, AARCH64 / LIBRARY, AARCH64 / "root")


def build_pure_wheel(wheel_directory):
    """The wheel with WebAssembly, without anything for one processor."""
    _make("build", "TARGETS=--target qtet_tool_wasm qtet_viewer")
    parts = [(f"{NAME}/web/{TOOL}", _needed(BUILD / "web-client" / TOOL), False)]
    with tempfile.TemporaryDirectory(prefix="qtet-wheel-") as made:
        for mode in ("node", "pyodide"):
            vite = "node_modules/vite/bin/vite.js build --config vite.wheel.config.ts --mode"
            subprocess.run(
                ["node", *vite.split(), mode, "--logLevel", "warn"],
                check=True,
                cwd=ROOT / "web-client",
                env={**os.environ, "QTET_WHEEL_OUT": made},
                stdout=sys.stderr,
            )
        folder = pathlib.Path(made)
        for name in ("qtet.mjs", "tool.js"):
            parts.append((f"{NAME}/web/{name}", (folder / name).read_bytes(), False))
        texts = ("third-party.txt", "qtet-tool.third-party.txt")
        notices = "\n".join((folder / name).read_text() for name in texts)
    return _write_wheel(wheel_directory, [*parts, *_viewer("web/viewer")], PURE, notices)


def _native_wheel(wheel_directory, library, root):
    parts = [(f"{NAME}/libqtet.so", _needed(library), True), *_viewer("viewer")]
    done = subprocess.run(["readelf", "-hVW", library], capture_output=True, text=True, check=True)
    return _write_wheel(wheel_directory, parts, tag(done.stdout), _notices(root))


def _write_wheel(wheel_directory, parts, its_tag, notices):
    members, own = _members(parts, its_tag, notices)
    members.append((own, _record(members, own), False))
    name = f"{NAME}-{version()}-{its_tag}.whl"
    day = time.gmtime(date())[:6]
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, content, executable in members:
            info = zipfile.ZipInfo(path, day)
            info.compress_type = zipfile.ZIP_DEFLATED
            info.external_attr = (0o100755 if executable else 0o100644) << 16
            wheel.writestr(info, content, compresslevel=9)  # a ZipInfo ignores the file's level
    target = pathlib.Path(wheel_directory) / name
    target.parent.mkdir(parents=True, exist_ok=True)
    part = target.with_suffix(".part")
    part.write_bytes(out.getvalue())
    part.replace(target)
    return name


def build_sdist(sdist_directory, config_settings=None):
    """The files of the last commit."""
    name = f"{NAME}-{version()}"
    files = subprocess.run(
        ["git", "-C", ROOT, "archive", "--format=tar", f"--prefix={name}/", "HEAD"],
        check=True,
        capture_output=True,
    ).stdout
    out = io.BytesIO()
    with tarfile.open(fileobj=io.BytesIO(files)) as given, gzip.GzipFile(
        fileobj=out, mode="wb", mtime=date()
    ) as packed, tarfile.open(fileobj=packed, mode="w", format=tarfile.PAX_FORMAT) as made:
        for member in given:
            made.addfile(member, given.extractfile(member) if member.isfile() else None)
        # The notices are those of the libraries that a wheel holds.
        text = _metadata().replace("License-File: third-party.txt\n", "").encode()
        info = tarfile.TarInfo(f"{name}/PKG-INFO")
        info.size, info.mtime = len(text), date()
        made.addfile(info, io.BytesIO(text))
    (pathlib.Path(sdist_directory) / f"{name}.tar.gz").write_bytes(out.getvalue())
    return f"{name}.tar.gz"


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    processor = sys.argv[2] if len(sys.argv) > 2 else platform.machine()
    builds = {
        "pure": build_pure_wheel,
        "aarch64": build_aarch64_wheel,
        platform.machine(): build_wheel,
    }
    if processor not in builds:
        raise SystemExit(f"no wheel for {processor}; {' and '.join(builds)} can be made here")
    path = folder / builds[processor](folder)
    print(f"{path}: {path.stat().st_size} bytes")
