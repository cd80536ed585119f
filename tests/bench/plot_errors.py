"""Draws the errors of a log's levels against its bytes, with logarithmic axes.

   qtet info LOG --json | plot_errors.py > errors.svg
"""
import html
import json
import math
import sys

info = json.load(sys.stdin)
levels = [level for level in info["levels"] if "error" in level]
if not levels:
    sys.exit("the log does not have its levels' errors; make it again with --measure levels")
boundary = [("boundary", [level["error"]["boundary"]["toOriginal"]["max"] for level in levels])]
fields = [
    (field["name"], [level["error"]["fields"][f]["rms"] for level in levels])
    for f, field in enumerate(info["fields"])
]
places = [math.log10(level["cumulativeBytes"]) for level in levels]
shown = [math.log10(e) for _, errors in boundary + fields for e in errors if e > 0] or [0, 1]
low, high = min(shown), max(shown)


def x(place):
    return 60 + 500 * (place - places[0]) / max(places[-1] - places[0], 1e-9)


def y(error):
    return 20 + 300 * (high - (math.log10(error) if error > 0 else low)) / max(high - low, 1e-9)


print('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 760 360" font-family="sans-serif">')
for n, (name, errors) in enumerate(boundary + fields):
    colour = f"hsl({47 * n % 360} 70% 45%)"
    line = " ".join(f"{x(p):.1f},{y(e):.1f}" for p, e in zip(places, errors))
    print(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
    label = html.escape(name)
    print(f'<text x="580" y="{30 + 18 * n}" font-size="13" fill="{colour}">{label}</text>')
for place, text in ((places[0], levels[0]), (places[-1], levels[-1])):
    print(f'<text x="{x(place):.0f}" y="345" font-size="12">{text["cumulativeBytes"]:,} B</text>')
for level in (low, high):
    print(f'<text x="2" y="{y(10 ** level) + 4:.0f}" font-size="12">{10 ** level:.1e}</text>')
print("</svg>")
