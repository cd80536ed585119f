#!/usr/bin/env python3
"""Compares the programs that Makefile, .ci and the test scripts call with .ci/packages.txt: what is
installed here by chance alone would be missing on a bare machine.
    check.py [ROOT]      exit code 77: no Debian, nothing to compare with"""

import pathlib
import re
import shutil
import subprocess
import sys

# Called only where they are installed; without them a test skips and says so.
OPTIONAL = {
    "lintian": "judges the packages of make deb",
    "mmdebstrap": "makes the Debian of make fresh and make test-deb",
    "debootstrap": "the same",
    "nginx": "tests/contract skips without it",
    "gcc": "called inside the Debian of make test-deb",
    "pvbatch": "called inside the Debian of make test-deb",
    "pvpython": "ParaView excludes libvtk9-dev on Debian 12",
    "systemd-analyze": "called inside the Debian of make test-deb",
    "aarch64-linux-gnu-g++": "compiles for another processor: make same-bytes, make wheel",
    "qemu-aarch64": "runs that",
    "docker": "stands in comments' examples",
    "sudo": "for users who are not root; root needs none",
    "zfp": "stands beside ours in tests/bench/series.py",
    "script": "a test of the tool's colours skips without it",
    "gmsh": "higher_cells_test.py tries its elements of higher degree where it is",
}

# The first word of a command: at a line's start or behind | & ; ( { ! `; the word behind one that
# runs another; and the first string of a call that starts a process.
WORD = r"\s*@?-?(?:[A-Za-z_]\w*=\S*\s+)*([a-z][\w.+-]*)(?=\s|$|\)|;)"
FIRST = re.compile(r"(?:^|[|&;({!`])" + WORD, re.M)
NEXT = re.compile(
    r"\b(?:then|do|else|if|while|until|exec|sudo|env|nice|time|xargs(?: -\S+| \d+)*|command -v"
    r"|inside|timeout \d+)" + WORD
)
SCRIPT = re.compile(
    r"(?:spawn|spawnSync|exec|execFileSync|execFile|run|Popen|check_output|check_call|which|call)"
    r"\(\s*\[?\s*['\"]([a-z][\w.+-]*)['\"]"
)


def words(path):
    text = path.read_text(errors="replace")
    if path.suffix in (".py", ".mjs"):
        return set(SCRIPT.findall(text))
    text = re.sub(r"^\s*#.*$|\s#\s.*$", "", text, flags=re.M)
    text = re.sub(r"<<'?(\w+)'?.*?^\s*\1$", "", text, flags=re.M | re.S)
    return {*FIRST.findall(text), *NEXT.findall(text)}


def output(*command):
    return subprocess.run(command, capture_output=True, text=True).stdout


def with_dependencies(packages):
    text = output(
        "apt-cache", "depends", "--recurse", "--no-recommends", "--no-suggests", "--no-conflicts",
        "--no-breaks", "--no-replaces", "--no-enhances", "--installed", *packages,
    )
    return {line.strip() for line in text.splitlines() if line and not line.startswith((" ", "<"))}


def owners(programs):
    """The package that brings each program, of those that a package brings."""
    names = {}
    for program in programs:
        path = shutil.which(program, path="/usr/sbin:/usr/bin:/sbin:/bin")
        if path is not None:
            # Debian 12 keeps /bin as a link to /usr/bin; packages name either.
            for name in (path, str(pathlib.Path(path).resolve()), path.replace("/usr/", "/", 1)):
                names.setdefault(name, set()).add(program)
    found = {}
    for line in output("dpkg", "-S", *names).splitlines():
        package, _, path = line.rpartition(": ")
        if not package.startswith("diversion"):
            for program in names[path]:
                found.setdefault(program, package.split(":")[0].split(",")[0])
    return found


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2])
    if shutil.which("dpkg") is None or shutil.which("apt-cache") is None:
        print("skipped: this is no Debian")
        return 77
    listed = re.sub(r"#.*", "", (root / ".ci/packages.txt").read_text()).split()
    always = [
        line.split()[0]
        for line in output("dpkg-query", "-W", "-f", "${Package} ${Priority}\n").splitlines()
        if line.endswith(" required")
    ]
    known = with_dependencies([*listed, *always, "apt", "nodejs", "npm"])
    patterns = ["Makefile", ".ci/run", ".ci/*.sh", ".packaging/*.sh"]
    patterns += [f"tests/**/*.{ending}" for ending in ("sh", "py", "mjs")]
    scripts = [s for p in patterns for s in sorted(root.glob(p)) if "node_modules" not in s.parts]
    calls = {script.relative_to(root): words(script) - OPTIONAL.keys() for script in scripts}
    brought = owners(set().union(*calls.values()))
    wrong = [
        f"{script} calls {word}, which package {brought[word]} brings"
        for script, called in calls.items()
        for word in sorted(called)
        if word in brought and brought[word] not in known
    ]
    for line in wrong:
        print(line)
    if wrong:
        print("packages: add the package to .ci/packages.txt, or the program to OPTIONAL")
        return 1
    print(f"packages: {len(scripts)} scripts call {len(brought)} programs of listed packages")
    # A pattern that finds nothing would find no fault.
    return 0 if {"clang-format-19", "cmake", "openssl", "curl"} <= brought.keys() else 1


if __name__ == "__main__":
    sys.exit(main())
