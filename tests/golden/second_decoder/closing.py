"""Closing blocks, decoded from codec/CLOSING.md alone."""
import math
import struct
from collections import defaultdict

from coder import Stream
from conventions import MISSING, clamp, refuse_unless

MASK = (1 << 64) - 1
ROWS = "0123 0231 0312 1032 1203 1320 2013 2130 2301 3021 3102 3210"


def point_order(mesh, data):
    """The slot of each point of the input."""
    stream = Stream(data, None, mesh.wrong)
    beside = defaultdict(set)
    for cell in mesh.tetrahedra:
        for v in cell:
            beside[v].update(w for w in cell if w != v)
    count = len(mesh.points)
    slots, met, stepped = [], set(), 0
    for i in range(count):
        candidates = []
        if i:
            p = mesh.points[slots[-1]]
            q = mesh.points[slots[-2]] if i > 1 else p
            straight = [2 * p[a] - q[a] for a in range(3)]
            if mesh.wrong == "the next point is looked for round the last one":
                straight = p

            def key(v):
                return sum((x - y) ** 2 for x, y in zip(mesh.points[v], straight)), v

            candidates = sorted(beside[slots[-1]] - met, key=key)
        if candidates and stream.bit("candidate", stepped):
            slots.append(candidates[stream.number("place")])
            stepped = 1
        else:
            slots.append(stream.raw((count - 1).bit_length()))
            stepped = 0
        met.add(slots[-1])
    refuse_unless(len(met) == count and stream.at_end(), "no permutation")
    return slots


def is_odd(cell):
    return sum(cell[j] > cell[i] for i in range(4) for j in range(i)) % 2


def permuted(cell, row, odd):
    out = [cell[int(i)] for i in ROWS.split()[row]]
    return tuple(out[:2] + out[:1:-1] if odd else out)


def cell_order(mesh, slots, data):
    """The slot of each cell of the input, and its vertices."""
    stream = Stream(data, None, mesh.wrong)
    number = {slot: i for i, slot in enumerate(slots)}
    own = [tuple(number[v] for v in cell) for cell in mesh.tetrahedra]
    by_rank = sorted(range(len(own)), key=lambda t: (sorted(own[t]), t))
    known = defaultdict(lambda: [1, 0])
    last, repeated, rank, row = (0, 0, 0), 0, -1, 0
    cells, out = [], []
    for _ in own:
        key = 0
        factors = (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9)
        for s, factor in zip(last, factors):
            key ^= s * factor & MASK
        entry = known[key]
        if stream.bit("same step", min(entry[1], 7), repeated):
            step, repeated = entry[0], 1
            entry[1] += 1
        else:
            negative = stream.bit("negative")
            step = stream.number("step")
            step = -step if negative else step
            entry[0], repeated = step, 0
            entry[1] = 0
        last = (step,) + last[:2]
        rank += step
        cells.append(by_rank[rank])
        cell = own[cells[-1]]
        turned = stream.bit("turned")
        node = 1
        for _ in range(4):
            node = node * 2 + stream.bit("row", row, node)
        row = node - 16
        out.append(permuted(sorted(cell), row, turned != is_odd(cell)))
    refuse_unless(len(set(cells)) == len(cells) and stream.at_end(), "no permutation")
    return cells, out


def original_cells(count, data, wrong):
    """The number of the file's cell that each cell of the input was split from."""
    stream, out = Stream(data, None, wrong), []
    run = last_run = 0
    for i in range(count):
        if i and stream.bit("same", run, last_run):
            run = min(run + 1, 63)
            out.append(out[-1])
            continue
        step = 1
        if not stream.bit("next"):
            negative = stream.bit("negative")
            step = stream.number("step") * (-1 if negative else 1)
        out.append((out[-1] if i else -1) + step)
        refuse_unless(0 <= out[-1] < 1 << 31, "no number of a cell")
        last_run, run = run, 1
    refuse_unless(stream.at_end(), "a block of original cells is too long")
    return out


class Order:
    """Numbers of a type as integers in the same order."""

    def __init__(self, kind):
        self.form, self.bits = {0: ("<f", 31), 1: ("<d", 63)}.get(kind, (None, 0))

    def of(self, x):
        if self.form is None:
            if math.isnan(x):
                return 0
            below = math.floor(x)
            return clamp(below + (x - below >= 0.5), -(1 << 53), 1 << 53)
        raw = int.from_bytes(struct.pack(self.form, x), "little")
        m = raw & (1 << self.bits) - 1
        return -1 - m if raw >> self.bits else m

    def number(self, order):
        if self.form is None:
            return float(order)
        m = -1 - order if order < 0 else order
        refuse_unless(m >> self.bits == 0, "no number of the type")
        raw = m | (1 << self.bits if order < 0 else 0)
        return struct.unpack(self.form, raw.to_bytes((self.bits + 1) // 8, "little"))[0]


def exponent(x):
    return struct.unpack("<Q", struct.pack("<d", x))[0] >> 52 & 0x7FF


def exact(integers, kind, step, minimum, data, wrong):
    """One number for each integer; `minimum` has one a component."""
    shift, stream, order = data[0], Stream(data[1:], None, wrong), Order(kind)
    seen, out = {}, []
    for i, integer in enumerate(integers):
        c = i % len(minimum)
        x = math.nan if integer == MISSING else minimum[c] + step * integer
        expected = order.of(x) >> shift
        if (c, integer) in seen and stream.bit("again", c):
            told = seen[c, integer]
        else:
            size = clamp(exponent(step) - exponent(x) + 48, 0, 63)
            key = (min(c, 3), size)
            told = expected + correction(stream, key)
            told = (told + (1 << 63)) % (1 << 64) - (1 << 63)
            seen[c, integer] = told
        whole = told << shift
        if told < 0 and wrong != "a shifted order is a plain product":
            whole = -1 - (-1 - told << shift)
        out.append(order.number(whole))
    refuse_unless(stream.at_end(), "a block of exact values is too long")
    return out


def correction(stream, key):
    node = 1
    for _ in range(7):
        node = node * 2 + stream.bit("count", key, node)
    bits = min(node - 128, 64)
    if bits == 0:
        return 0
    negative = stream.raw(1)
    out, left = 1, bits - 1
    while left > 0 and out < 4:
        out = out * 2 + stream.bit("top", key, bits, out)
        left -= 1
    while left > 0:
        take = min(left, 16)
        left -= take
        out = out << take | stream.raw(take)
    return -out if negative else out


def closing_blocks(mesh, fields):
    """The content of each block by (kind, field), as bytes for a digest; unknown kinds are left."""
    log, out = mesh.log, {}
    for (kind, field), data in log.closing.items():
        if kind == 1:
            slots = point_order(mesh, data)
            out[kind, field] = struct.pack(f"<{len(slots)}I", *slots)
        elif kind == 2:
            cells, vertices = cell_order(mesh, slots, data)
            flat = cells + [v for cell in vertices for v in cell]
            out[kind, field] = struct.pack(f"<{len(flat)}I", *flat)
        elif kind == 3:
            flat = [x for p in mesh.points for x in p]
            numbers = exact(flat, data[0], log.step, log.origin, data[1:], mesh.wrong)
            out[kind, field] = struct.pack(f"<{len(numbers)}d", *numbers)
        elif kind == 4:
            type_, _, step, minimum = log.infos[field]
            values = fields[field].values
            flat = [x for i in range(len(values)) for x in values[i]]
            numbers = exact(flat, type_, step, minimum, data, mesh.wrong)
            out[kind, field] = struct.pack(f"<{len(numbers)}d", *numbers)
        elif kind == 5:
            numbers = original_cells(len(mesh.tetrahedra), data, mesh.wrong)
            out[kind, field] = struct.pack(f"<{len(numbers)}I", *numbers)
    return out
