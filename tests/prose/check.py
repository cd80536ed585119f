#!/usr/bin/env python3
"""Finds sentences in comments and documents that are read twice: those that begin with "Of" or
"What" (but questions), those of more than 25 words, and those of the kinds in ODD.
    check.py [ROOT [PATH...]]     0 = none; 1 = each is named
    check.py --selftest           whether the kinds find their examples, and no others"""

import pathlib
import re
import subprocess
import sys

MOST_WORDS = 25

# Kinds of sentences: what is wrong, a pattern, and examples that it has to find.
ODD = [
    (
        'has a clause that begins with "of"; begin with its subject',
        r"^[^a-z].*; of (?:the|an?|what|which|two)\b|(?:^|, |, and )of what\b",
        [
            "401 and 403 of a mesh; of the list (nullptr) only for a token that nobody has",
            "of what is no JSON it says anything",
            "The wedges are turned, and of what a cell's parts are the cell counts once",
        ],
    ),
    (
        'says "also of" something; write a sentence with "even for"',
        r"\balso of (?:one|those)\b",
        ["401 and 403 of a mesh, also of one that does not exist"],
    ),
    (
        'begins with "From its ... on:"; begin with the verb',
        r"^From (?:its|the|their) \w+ on:",
        ["From its making on: after `time` what waits on the socket is cancelled"],
    ),
    (
        'has "is told"; say who reports what to whom',
        r"\b(?:is|are|was|were|be) told\b(?! apart)",
        ["A port in use is told at once", "SIGHUP: what is wrong is told"],
    ),
    ('has "hold on"; write "keep"', r"\b(?:hold|holds|held) on\b", ["All that held holds on"]),
    ('has "anew"; write "again"', r"\banew\b", ["The server is started anew"]),
]
# Sentences that none of the kinds finds.
PLAIN = [
    "SIGHUP reloads the configuration. If it is invalid, the server keeps the old one",
    "The result is unspecified for invalid JSON",
    "Cancels whatever waits on the socket, `time` after construction",
    "Counts a cell once, however many parts it was split into",
    "Refuses with 401 or 403, also for a mesh that does not exist, so that names do not leak",
    "So many colours can be told apart",
]

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


def odd(sentence):
    return [why for why, pattern, _ in ODD if re.search(pattern, sentence)]


def selftest():
    """0 if every kind finds its examples, and nothing in plain sentences."""
    missed = [(why, e) for why, _, examples in ODD for e in examples if why not in odd(e)]
    false = [(why, sentence) for sentence in PLAIN for why in odd(sentence)]
    for why, sentence in missed:
        print(f"selftest: not found: {why}: {sentence}")
    for why, sentence in false:
        print(f"selftest: a false alarm: {why}: {sentence}")
    return 1 if missed or false else 0


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
                for why in odd(bare):
                    yield name, first + line, why, sentence
                count = len(re.sub(r"`[^`]*`|\([^()]*\)", "x", sentence).split())
                if count > MOST_WORDS:
                    yield name, first + line, f"has {count} words", sentence


def main():
    if sys.argv[1:] == ["--selftest"]:
        return selftest()
    root, *paths = sys.argv[1:] or ["."]
    found = list(faults(root, paths))
    for name, line, why, sentence in found:
        print(f"{name}:{line}: {why}: {sentence}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
