#!/usr/bin/env python3
# Reads a page of Prometheus' text format (0.0.4) and prints what is wrong with it.
#   exposition.py < PAGE       exit code 1: something is wrong
import re
import sys

NAME = r"[a-zA-Z_:][a-zA-Z0-9_:]*"
TEXT = r'"(?:[^"\\]|\\[\\"n])*"'
LABEL = rf"[a-zA-Z_][a-zA-Z0-9_]*={TEXT}"
VALUE = r"[+-]?(?:\d+(?:\.\d*)?(?:[eE][+-]?\d+)?|Inf)|NaN"
HEAD = re.compile(rf"# (?:HELP ({NAME}) \S.*|TYPE ({NAME}) (counter|gauge|histogram))")
SAMPLE = re.compile(rf"({NAME})(?:\{{({LABEL}(?:,{LABEL})*)\}})? ({VALUE})")


def complaints(page):
    helps, types, series, last = set(), {}, {}, None
    if not page.endswith("\n"):
        yield "the last line has no end"
    for line in page.splitlines():
        if head := HEAD.fullmatch(line):
            if (head[1] in helps) if head[1] else (head[2] in types or head[2] != last):
                yield f"not one HELP, then one TYPE: {line}"
            last = head[1] or head[2]
            helps.add(last)
            if head[2]:
                types[last] = head[3]
                if last.endswith("_total") != (head[3] == "counter"):
                    yield f"counters alone end in _total: {line}"
        elif sample := SAMPLE.fullmatch(line):
            base = re.sub("_(bucket|sum|count)$", "", sample[1])
            family = base if types.get(base) == "histogram" else sample[1]
            if family not in types or family != last:
                yield f"not behind its HELP and TYPE: {line}"
            labels = re.findall(f"({NAME})=({TEXT})", sample[2] or "")
            key = (sample[1], tuple(sorted(labels)))
            if key in series or len(dict(labels)) < len(labels):
                yield f"a second time: {line}"
            series[key] = float(sample[3])
        else:
            yield f"neither HELP, TYPE nor a figure: {line}"
    yield from badHistograms(series)


def badHistograms(series):
    histograms = {}
    for (name, labels), value in series.items():
        if name.endswith("_bucket"):
            key = (name[:-7], tuple(pair for pair in labels if pair[0] != "le"))
            bound = float(dict(labels).get("le", '"NaN"')[1:-1])
            histograms.setdefault(key, []).append((bound, value))
    for (name, labels), buckets in histograms.items():
        bounds, counts = map(list, zip(*buckets))
        if bounds != sorted(set(bounds)) or bounds[-1] != float("inf"):
            yield f"the bounds of {name} {labels} do not rise to +Inf: {bounds}"
        whole, total = (series.get((name + end, labels)) for end in ("_count", "_sum"))
        if counts != sorted(counts) or counts[-1] != whole or total is None:
            yield f"{name} {labels} has no sum, or counts that do not rise to its own: {counts}"


sys.exit("\n".join(complaints(sys.stdin.read())) or 0)
