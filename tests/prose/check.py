#!/usr/bin/env python3
"""Finds sentences in comments and documents that are read twice: those that begin with "Of" or
"What" (but questions), and those of more than 25 words.
    check.py [ROOT [PATH...]]"""

import pathlib
import re
import subprocess
import sys

MOST_WORDS = 25

CODE = (".h", ".cpp", ".c", ".ts", ".mjs", ".css")
HASH = (".py", ".sh", ".cmake", ".txt", ".yml")


def comment_blocks(path, text):
    """(line, text) of every comment: consecutive lines of one kind are one."""
    if path.suffix in CODE:
        start = re.compile(r"^\s*(?://[/!]?<?|\*(?!/)|/\*\*?)\s?(.*?)(?:\*/)?$")
        trailing = re.compile(r"\S.*?\s//[/!]?<?\s?(.*)$")
    else:
        start, trailing = re.compile(r"^\s*#(?!!)\s?(.*)$"), re.compile(r"(?!)")
    block, first = [], 0
    for number, line in enumerate(text.splitlines(), 1):
        match = start.match(line)
        if match:
            if not block:
                first = number
            block.append(match.group(1))
            continue
        if block:
            yield first, block
            block = []
        match = trailing.match(line)
        if match and '"' not in line and "'" not in line:
            yield number, [match.group(1)]
    if block:
        yield first, block


def document_blocks(text):
    block, first, fenced = [], 0, False
    for number, line in enumerate(text.splitlines() + [""], 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
            line = ""
        elif fenced or line.lstrip().startswith(("|", "#", "<")):
            line = ""
        item = re.match(r"\s*(?:[-*]|\d+\.)\s+(.*)", line)
        if block and (not line.strip() or item):
            yield first, block
            block = []
        if line.strip():
            if not block:
                first = number
            block.append(item.group(1) if item else line.strip())
    if block:
        yield first, block


def sentences(lines):
    """(line within the block, sentence)"""
    text, starts = "", []
    for line in lines:
        starts.append(len(text))
        text += line + ("\n" if line.strip() else "\n.\n")
    begin = 0
    ends = re.finditer(r"[.!?](?=[\s)\"]|$)(?<!e\.g\.)(?<!i\.e\.)(?<!Eq\.)", text)
    for end in [*(m.end() for m in ends), len(text)]:
        sentence = " ".join(text[begin:end].split()).strip(" .")
        if sentence:
            lead = len(text[begin:end]) - len(text[begin:end].lstrip(" .\n"))
            line = max(i for i, s in enumerate(starts) if s <= begin + lead)
            yield line, sentence, text[begin:end].rstrip().endswith("?")
        begin = end


def faults(root, paths):
    names = subprocess.run(
        ["git", "-C", root, "ls-files", "--", *paths], capture_output=True, text=True, check=True
    ).stdout.split("\n")
    for name in names:
        path = pathlib.Path(name)
        if path.suffix == ".md":
            blocks = document_blocks
        elif path.suffix in CODE + HASH or path.name == "Makefile":
            def blocks(text, path=path):
                return comment_blocks(path, text)
        else:
            continue
        if "bench/HISTORY" in name or path.name in ("LICENSE", "CHANGELOG.md"):
            continue
        text = (pathlib.Path(root) / name).read_text(errors="replace")
        for first, block in blocks(text):
            for line, sentence, question in sentences(block):
                bare = sentence.lstrip("(*_`\"'- ")
                if re.match(r"(Of|What)\b", bare) and not question:
                    yield name, first + line, "begins with " + bare.split()[0], sentence
                count = len(re.sub(r"`[^`]*`|\([^()]*\)", "x", sentence).split())
                if count > MOST_WORDS:
                    yield name, first + line, f"has {count} words", sentence


def main():
    root, *paths = sys.argv[1:] or ["."]
    found = list(faults(root, paths))
    for name, line, why, sentence in found:
        print(f"{name}:{line}: {why}: {sentence}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
