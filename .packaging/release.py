"""Everything that a release hands out, in one folder: wheel, Debian packages, npm package, gallery,
sources, a bill of materials (CycloneDX 1.5), and the checksums of all.

   release.py FOLDER      after make build; the same commit and build give the same bytes
"""
import gzip
import hashlib
import json
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import tarfile
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import python_backend as backend
from gallery import build_gallery

ROOT, BUILD = backend.ROOT, backend.BUILD


# Compiled into the WebAssembly, beside what the wheel's library is linked with.
IN_BROWSER = ["libc++-19-dev-wasm32", "wasi-libc", "libfast-float-dev", "libboost-dev"]


def run(*words, cwd=ROOT):
    subprocess.run([str(word) for word in words], check=True, cwd=cwd, stdout=sys.stderr)


def wheels(folder):
    """For this processor, for aarch64 where Debian's compiler for it is installed, and for all."""
    backend.build_wheel(folder)
    backend.build_pure_wheel(folder)
    if platform.machine() == "aarch64":
        return
    if shutil.which("aarch64-linux-gnu-g++"):
        backend.build_aarch64_wheel(folder)
    else:
        print("release: no wheel for aarch64; install g++-aarch64-linux-gnu", file=sys.stderr)


def _client():
    return json.loads((ROOT / "web-client/package.json").read_text())


def npm_package(folder):
    """Modules, types and papers, packed by npm."""
    made = BUILD / "npm-release"
    shutil.rmtree(made, ignore_errors=True)
    made.mkdir(parents=True)
    wasm = BUILD / "web-client/qtet-codec.wasm"
    run("node", ROOT / "web-client/pack.mjs", wasm, made)
    run("npm", "pack", "--silent", "--pack-destination", folder, cwd=made)
    # Sources have the same name with another ending.
    (folder / f"qtet-{backend.version()}.tgz").rename(folder / f"qtet-npm-{backend.version()}.tgz")


def gallery(folder):
    """A folder for static hosting, with the samples and links to each feature."""
    name = f"{backend.NAME}-gallery-{backend.version()}"
    with tempfile.TemporaryDirectory(prefix="qtet-release-") as work:
        made = pathlib.Path(work) / name
        build_gallery(made, BUILD)
        with (folder / f"{name}.tar.gz").open("wb") as out, gzip.GzipFile(
            filename="", fileobj=out, mode="wb", mtime=backend.date()
        ) as packed, tarfile.open(fileobj=packed, mode="w") as archive:
            for path in sorted(made.rglob("*")):
                info = archive.gettarinfo(path, f"{name}/{path.relative_to(made).as_posix()}")
                info.uid = info.gid = 0
                info.uname = info.gname = ""
                info.mtime = backend.date()
                info.mode = 0o755 if info.isdir() else 0o644
                archive.addfile(info, path.open("rb") if path.is_file() else None)


def debian_packages(folder):
    shutil.rmtree(BUILD / "packages", ignore_errors=True)
    run("cpack", "-G", "DEB", cwd=BUILD)
    for package in sorted((BUILD / "packages").glob("*.deb")):
        shutil.copy(package, folder)


def _debian_component(package):
    query = ("dpkg-query", "-W", "-f", "${Version}\t${source:Package}\t${Homepage}", package)
    done = subprocess.run(query, check=True, capture_output=True, text=True)
    version, source, homepage = done.stdout.split("\t")
    component = {
        "type": "library",
        "name": source,
        "version": version,
        "purl": f"pkg:deb/debian/{package}@{version}?distro=debian-12",
    }
    if homepage:
        component["externalReferences"] = [{"type": "website", "url": homepage}]
    return component


def _npm_component(name):
    own = json.loads((ROOT / f"web-client/node_modules/{name}/package.json").read_text())
    return {
        "type": "library",
        "name": name,
        "version": own["version"],
        "licenses": [{"license": {"id": own["license"]}}],
        "purl": f"pkg:npm/{name}@{own['version']}",
    }


def bill_of_materials():
    """What is part of the files beside our own sources: linked statically, or bundled."""
    linked = [_debian_component(package) for package in [*backend.LINKED, *IN_BROWSER]]
    bundled = [_npm_component(name) for name in _client()["dependencies"]]
    version = backend.version()
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {
            "component": {
                "type": "application",
                "name": backend.NAME,
                "version": version,
                "licenses": [{"license": {"id": "Apache-2.0"}}],
            }
        },
        "components": sorted(linked + bundled, key=lambda part: (part["name"], part["purl"])),
    }


def check_viewer():
    """The browser's simplifier is there: a build without Debian's sources leaves it out."""
    if not (BUILD / "web-client/qtet-simplify.wasm").stat().st_size:
        raise SystemExit("the browser's simplifier was left out; run make setup, and build again")


def check_versions(folder):
    """Every file says the same version."""
    npm = _client()["version"]
    if npm != backend.version():
        raise SystemExit(f"web-client/package.json says {npm}, CMakeLists.txt {backend.version()}")
    others = [path.name for path in folder.iterdir() if backend.version() not in path.name]
    if others:
        raise SystemExit(f"{', '.join(others)}: another version than {backend.version()}")


def main():
    folder = pathlib.Path(sys.argv[1]).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    os.environ["SOURCE_DATE_EPOCH"] = str(backend.date())
    check_viewer()
    wheels(folder)
    backend.build_sdist(folder)
    npm_package(folder)
    debian_packages(folder)
    gallery(folder)
    bill = json.dumps(bill_of_materials(), indent=2, ensure_ascii=False)
    (folder / f"{backend.NAME}-{backend.version()}.cdx.json").write_text(bill + "\n")
    check_versions(folder)
    lines = [
        f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n"
        for path in sorted(folder.iterdir())
    ]
    (folder / "SHA256SUMS").write_text("".join(lines))
    for path in sorted(folder.iterdir()):
        print(f"{path.stat().st_size:>10} {path}")


main()
