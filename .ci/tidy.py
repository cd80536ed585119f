#!/usr/bin/env python3
"""clang-tidy over the sources that changed; any finding is an error.
    tidy.py BUILD JOBS [SINCE]   BUILD: a folder with compile_commands.json, where each source is
                                 compiled alone; SINCE: as changed.sh's
A header that changed stands for the source of the same name. A source that was found clean is not
looked at again while its preprocessed text, .clang-tidy and the program stay the same: such texts'
digests are kept in QTET_TIDY_CACHE, ~/.cache/qtet-tidy unless given."""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import shlex
import subprocess
import sys

TIDY = "clang-tidy-19"
ROOT = pathlib.Path(__file__).resolve().parent.parent
CACHE = pathlib.Path(os.environ.get("QTET_TIDY_CACHE", "~/.cache/qtet-tidy")).expanduser()


def changed(since):
    script = [ROOT / ".ci/changed.sh", since, "*.h", "*.cpp"]
    text = subprocess.run(script, capture_output=True, text=True, check=True).stdout
    return {ROOT / pathlib.Path(line).with_suffix(".cpp") for line in text.splitlines()}


def digest(entry, rules):
    """The digest of all that a verdict depends on, with `rules` for every source. None: the source
    cannot be preprocessed."""
    words = shlex.split(entry["command"])
    out = words.index("-o")
    del words[out : out + 2]
    words[words.index("-c")] = "-E"
    # Comments count, since NOLINT is one. The folder does not, so that clones share verdicts:
    # asserts hold the file's path.
    command = [*words, "-CC", "-P", f"-fmacro-prefix-map={ROOT}=."]
    made = subprocess.run(command, cwd=entry["directory"], capture_output=True)
    if made.returncode != 0:
        return None
    flags = [word for word in words if not word.startswith(("-I/", "/"))]
    return hashlib.sha256(b"\0".join([rules, " ".join(flags).encode(), made.stdout])).hexdigest()


def look(build, entry, rules):
    """The findings, or None."""
    known = digest(entry, rules)
    if known and (CACHE / known).exists():
        return None
    found = subprocess.run(
        [TIDY, "--quiet", "-p", build, entry["file"]], capture_output=True, text=True
    )
    if found.returncode != 0:
        return found.stdout + found.stderr
    if known:
        CACHE.mkdir(parents=True, exist_ok=True)
        (CACHE / known).touch()
    return None


def main():
    build, jobs, since = (sys.argv + [""])[1:4]
    entries = json.loads((pathlib.Path(build) / "compile_commands.json").read_text())
    wanted = changed(since)
    entries = {entry["file"]: entry for entry in entries if pathlib.Path(entry["file"]) in wanted}
    print(f"tidy: {len(entries)} sources changed {since and 'since ' + since}", flush=True)
    version = subprocess.run([TIDY, "--version"], capture_output=True, check=True).stdout
    rules = version + (ROOT / ".clang-tidy").read_bytes()
    wrong = 0
    with concurrent.futures.ThreadPoolExecutor(int(jobs)) as pool:
        for text in pool.map(lambda entry: look(build, entry, rules), entries.values()):
            if text:
                wrong += 1
                print(text, flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
