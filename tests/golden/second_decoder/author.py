#!/usr/bin/env python3
"""Writes the logs of dice that a folder lacks, and the digests of all logs: author.py FOLDER

A log of dice is made by the decoder itself: its stream answers each question by a die and writes
the answer down. So a small log takes every branch of the format, also those that no simplifier
takes. The cells may be inside out; the connectivity is sound.
"""
import copy
import hashlib
import itertools
import random
import struct
import sys
from pathlib import Path

sys.dont_write_bytecode = True

from blocks import adaptive_values  # noqa: E402
from closing import closing_blocks  # noqa: E402
from coder import Stream  # noqa: E402
from conventions import MISSING, Refused  # noqa: E402
from decoder import Field, decode  # noqa: E402
from mesh import Mesh  # noqa: E402

TRIES = 60  # of dice until a record is valid


class Author(Stream):
    """Answers by dice, or from `script`, a text of 0 and 1."""

    def __init__(self, seed, learnt=None, script="", surprise=0.5):
        super().__init__(b"\0\0\0\0", learnt)
        self.dice, self.surprise, self.script = random.Random(seed), surprise, list(script)
        self.out, self.raw_out, self.raw_bits = bytearray(), 0, 0
        self.forced = None

    def decide(self, p):
        if self.script:
            bit = int(self.script.pop(0))
        elif self.forced is not None:
            bit = self.forced
        else:
            even = self.dice.random() < self.surprise
            bit = int(self.dice.randrange(65536) < (32768 if even else p))
        middle = self.low + ((self.high - self.low) * p >> 16)
        if bit:
            self.high = middle
        else:
            self.low = middle + 1
        if self.trace is not None:
            self.trace.append((p, bit, self.low, self.high))
        while (self.low ^ self.high) >> 24 == 0:
            self.out.append(self.high >> 24)
            self.low = self.low << 8 & 0xFFFFFFFF
            self.high = (self.high << 8 | 255) & 0xFFFFFFFF
        return bit

    def raw(self, bits):
        value = self.dice.getrandbits(bits) if bits else 0
        return self.put_raw(value, bits)

    def put_raw(self, value, bits):
        self.raw_out |= value << self.raw_bits
        self.raw_bits += bits
        return value

    def finish(self):
        raw = self.raw_out.to_bytes((self.raw_bits + 7) // 8, "little")
        return bytes(self.out) + self.low.to_bytes(4, "big") + raw[::-1]


class Writer(Author):
    """Tells values that are known: each question is asked of `answers` and `raws` in turn."""

    def __init__(self):
        super().__init__(0)
        self.raws = []

    def raw(self, bits):
        return self.put_raw(self.raws.pop(0) if bits else 0, bits)


def tell_number(stream, key, value):
    bits = value.bit_length()
    below = f"{value:b}"[1:]
    stream.script = list("1" * bits + ("0" if bits < 32 else "") + below[:2])
    stream.raws = [int(bit) for bit in below[2:]]
    assert stream.number(key) == value


def adaptive_block(values, components):
    """The block that adaptive_values reads."""
    writer = Writer()
    for x in values:
        u = abs(x)
        bits = u.bit_length()
        writer.script += list("1" * bits + "0" + f"{u:b}"[1:3]) if bits else ["0"]
        writer.script += [str(int(x < 0))] if bits else []
        if bits > 3:
            writer.raws.append(u & (1 << bits - 3) - 1)
    if values:
        tuples = len(values) // components
        assert adaptive_values(None, components, tuples, "", writer) == list(values)
    return writer.finish() if values else b""


def draco_block(values, components):
    """A Draco point cloud whose symbols are not compressed, and the digits behind it."""
    if not values:
        return b""
    codes, digits, count = [], 0, 0
    for x in values:
        u, bits = abs(x), max(abs(x).bit_length() - 2, 0)
        if bits:
            digits |= (u & (1 << bits) - 1) << count
            count += bits
            u = 4 + 2 * (bits - 1) + (u >> bits) % 2
        symbol = u if x > 0 else -u
        codes.append(2 * symbol if symbol >= 0 else -2 * symbol - 1)
    tail = digits.to_bytes((count + 7) // 8, "little")
    head = b"DRACO" + bytes([2, 3, 0, 0, 0, 0]) + struct.pack("<I", len(values) // components)
    head += bytes([1, 1, 4, 5, components, 0, 0, 1, 0xFE, 0, 4])
    return head + struct.pack(f"<{len(codes)}I", *codes) + tail + struct.pack("<I", len(tail))


def crc32c(data):
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


def varint(x):
    out = bytearray()
    while x >= 128:
        out.append(x & 127 | 128)
        x >>= 7
    return bytes(out) + bytes([x])


def text(s):
    return varint(len(s)) + s.encode()


class DiceLog:
    """The head that Mesh and Field ask for."""

    def __init__(self, bits, shapes, codec):
        self.bits, self.shapes, self.codec, self.misreading = bits, shapes, codec, ""
        self.rows, self.levels = [], []

    def manifest(self):
        out = text("qtet golden") + text("dice.vtu") + struct.pack("<4d", 1, 0, 0, 0)
        for i, (n, association) in enumerate(self.shapes):
            out += text(f"f{i}") + bytes([association & 128, 28])
            out += struct.pack(f"<{n + 3}d", 1, *[0] * n, 0, 1 << 28)
        out += b"\0"
        writer = Writer()
        for column in range(3):
            told = []
            for counts in self.levels:
                predicted = 0 if not told else told[-1]
                if len(told) > 1:
                    predicted = 2 * told[-1] - told[-2]
                d = (counts[column] - predicted) % 2**32
                tell_number(writer, column, 2 * d if d < 2**31 else 2 * (2**32 - d) - 1)
                told.append(counts[column])
        return out + writer.finish()

    def file(self):
        table = b"\0" + b"".join(bytes(shape) for shape in self.shapes)
        body = b""
        first = 0
        for row in self.rows:
            table += varint(row["last"] - first) + varint(row["end"])
            first = row["last"] + (row["end"] == 0)
            for name in ("records", "vertices", "tetrahedra", "triangles"):
                table += varint(row[name])
            table += bytes([1 + 16 * self.codec])
            table += b"".join(varint(len(block)) for block in row["blocks"])
            table += b"".join(struct.pack("<I", crc32c(block)) for block in row["blocks"])
            body += b"".join(row["blocks"])
        manifest = self.manifest()
        size = 64 + len(manifest) + len(table) + len(body)
        header = bytes.fromhex("89515445540D0A1A") + struct.pack(
            "<HHBBHQIIIIIIIII", 4, 0, 0, self.bits, 0, size, len(manifest), len(table),
            crc32c(manifest), crc32c(table), len(self.rows), len(self.shapes),
            len(self.rows) - 1, 0, 0,
        )  # fmt: skip
        return header + struct.pack("<I", crc32c(header)) + manifest + table + body


class FieldAuthor(Field):
    """Values of dice: those that stay in the last level lie in [0, magnitude)."""

    def __init__(self, mesh, number, magnitude):
        super().__init__(mesh, number)
        self.magnitude, self.dice = magnitude, random.Random(number)
        self.told, self.passing = [], False

    def read(self, told, predicted):
        if self.gaps and not self.passing and self.dice.random() < 0.3:
            self.told.append(0)
            return MISSING
        low = -2 * self.magnitude if self.passing else 0
        value = self.dice.randrange(low, 2 * self.magnitude if self.passing else self.magnitude)
        d = value - predicted
        self.told.append(d + 1 if self.gaps and d >= 0 else d)
        return value

    def blocks(self, rows):
        tetrahedra = 0
        splits_left = [split.v for split in self.mesh.splits]
        for row, (first, end) in zip(rows, self.mesh.split_chunks):
            self.told = []
            if self.of_cells:
                for t in range(tetrahedra, tetrahedra + row["tetrahedra"]):
                    self.values[t] = [
                        self.read(None, self.of_cell(t, c)) for c in range(self.components)
                    ]
                tetrahedra += row["tetrahedra"]
            else:
                self.point_values(first, end, splits_left)
            row["blocks"].append(adaptive_block(self.told, self.components))

    def point_values(self, first, end, splits_left):
        if end == first == 0 and not self.values:
            for v, birth in enumerate(self.mesh.births):
                self.passing = v in splits_left
                self.values[v] = [
                    self.read(None, self.of_base(v, birth, c)) for c in range(self.components)
                ]
        for i in range(first, end):
            split = self.mesh.splits[i]
            self.passing = set(split.prey) <= set(splits_left[i + 1 :])
            self.split(split, None)


class LiftedAuthor(Field):
    """Lifted blocks of dice, round 2^20."""

    def stream_of(self, data):
        first = "1" * 21 + "0" + "00" + "0"
        if self.gaps:
            first = "0" + first
        return Author(self.number, script="" if self.values else first * self.components, surprise=0.2)

    def read_rule(self):
        stream = self.stream
        few = lambda bits: stream.put_raw(stream.dice.randrange(7 if bits == 5 else 128), bits)
        stream.raw = few  # no shift of 30, which would leave the range at once
        try:
            return super().read_rule()
        finally:
            del stream.raw

    def blocks(self, rows):
        for chunk, (row, (first, end)) in enumerate(zip(rows, self.mesh.split_chunks)):
            self.lifted_block(None, chunk, self.mesh.splits[first:end])
            row["blocks"].append(self.stream.finish())
        present = [x for values in self.values.values() for x in values if x != MISSING]
        if not all(0 <= x < 1 << 28 for x in present):
            raise Refused("a value of the last level out of range")


class Dice:
    """Makes a log chunk by chunk."""

    def __init__(self, seed, bits=14, shapes=(), splits=0.3, surprise=0.5, codec=3):
        self.log = DiceLog(bits, list(shapes), codec)
        self.mesh = Mesh(self.log)
        self.mesh.all_detours = 0
        self.dice, self.splits, self.surprise = random.Random(seed), splits, surprise
        self.seed, self.visited, self.level = seed, None, 0
        self.told, self.records = [], 0
        self.stream = None

    def base(self, script, cells, told):
        """Chunk 0: what `script` says, a 0 or 1 for each decision."""
        self.stream = Author(self.seed, script=script)
        self.stream.forced = 1
        mesh = self.mesh
        mesh.grow(self.stream, cells)
        mesh.place_base(iter(told))
        self.told = list(told)
        mesh.know_base()
        mesh.next = [0, 0, 0]
        mesh.split_chunks = []
        self.first = 0
        self.end_chunk(0)
        self.log.levels.append(self.counts())

    def counts(self):
        return [len(self.mesh.tetrahedra), len(self.mesh.points), len(self.mesh.triangles)]

    def run(self, end=None):
        """The next level, or the rest of it, up to slot `end`."""
        if self.visited is None:
            self.level += 1
            self.visited, self.last, self.taken = 0, len(self.mesh.points), set()
        stop = self.last if end is None else end
        for v in range(self.visited, stop):
            if v not in self.taken:
                if not (self.dice.random() < self.splits and self.record(v)):
                    self.stream.forced = 0
                    self.mesh.split_flag(self.stream, v, self.level)
                    self.stream.forced = None
        self.visited = end
        if end is None:
            self.log.levels.append(self.counts())

    def record(self, v):
        kept = copy.deepcopy((self.mesh, self.stream, self.taken))
        for _ in range(TRIES):
            told = [self.dice.randrange(-6, 7) for _ in range(9)]
            self.stream.dice.seed(self.dice.random())
            self.stream.learnt = self.mesh.learnt
            used = iter(told)
            try:
                self.stream.forced = 1
                self.mesh.split_flag(self.stream, v, self.level)
                self.stream.forced = None
                self.mesh.record(self.stream, v, self.level, used, self.taken)
                self.told += told[: 9 - len(list(used))]
                self.records += 1
                return True
            except (Refused, StopIteration):
                self.mesh, self.stream, self.taken = copy.deepcopy(kept)
                self.stream.learnt = self.mesh.learnt
        return False

    def end_chunk(self, end):
        """`end`: the end slot plus 1, 0 if the level is complete."""
        mesh, before = self.mesh, [0, 0, 0]
        for row in self.log.rows:
            for i, name in enumerate(("vertices", "tetrahedra", "triangles")):
                before[i] += row[name]
        mesh.next = [len(mesh.points), len(mesh.tetrahedra), len(mesh.triangles)]
        row = {"last": self.level, "end": end, "records": self.records}
        for i, name in enumerate(("vertices", "tetrahedra", "triangles")):
            row[name] = mesh.next[i] - before[i]
        positions = draco_block if self.log.codec == 4 else adaptive_block
        row["blocks"] = [self.stream.finish(), positions(self.told, 3)]
        self.log.rows.append(row)
        mesh.split_chunks.append((self.first, len(mesh.splits)))
        self.first, self.told, self.records = len(mesh.splits), [], 0
        self.stream = Author(self.dice.random(), mesh.learnt, surprise=self.surprise)

    def file(self, magnitude=0):
        for number in range(len(self.log.shapes)):
            if self.log.codec == 4 and self.log.shapes[number][1] & 127 == 0:
                LiftedAuthor(self.mesh, number).blocks(self.log.rows)
            else:
                FieldAuthor(self.mesh, number, magnitude).blocks(self.log.rows)
        return self.log.file()


# Seven cells: a seed, cells over three of its faces and over one of theirs, and one apart.
SOLID = "1111" "01" "01" "01" "01" + "1" * 11 + "1111"
SOLID_TOLD = [60, 0, 5, 9, 70, -3, -80, 10, 66]


def solid(seed, levels, **options):
    dice = Dice(seed, **options)
    middle = 1 << dice.log.bits - 1
    told = [middle] * 3 + SOLID_TOLD + [dice.dice.randrange(-9, 10) for _ in range(12)]
    told += [300, 0, 0] + [50, 1, 2, -3, 60, 7, -20, 9, 70]
    dice.base(SOLID, 6, told)
    for level in range(1, levels + 1):
        if level == 2:
            dice.run(6)
            dice.end_chunk(7)
        dice.run()
        if level == levels // 2 and level < levels:
            dice.end_chunk(0)
    dice.end_chunk(0)
    return dice


def single_cells(seed, cells):
    """Cells that share nothing: models become as sure as they can."""
    dice = Dice(seed, bits=10, splits=0.004)
    steps = [[-1, 0, -1], [1, 0, 0], [-1, 1, 0], [1, -1, 1]]
    dice.base("", cells, [500] * 3 + [x for v in range(1, 4 * cells) for x in steps[v % 4]])
    for _ in range(2):
        dice.run()
    dice.end_chunk(0)
    return dice


def traced():
    seed = 50
    while True:
        dice = solid(seed, 1, splits=0.7)
        if {split.k for split in dice.mesh.splits} == {2, 3, 4}:
            return dice.file()
        seed += 1


def scripted_base():
    """A cell that meets a face across which nothing was said to lie."""
    dice = Dice(1)
    told = [1000] * 3 + [dice.dice.randrange(-20, 21) for _ in range(15)]
    dice.base("1111" "1" "01" "00" "1100" "111" "01", 4, told)
    return dice.file()


LIFTED = [(1, 0), (5, 0), (2, 128), (1, 129)]
SCALAR, TENSOR, GAPS, CELLS, CELL_GAPS = (1, 0), (5, 0), (2, 128), (2, 1), (1, 129)
# By seed: a log whose dice leave a level without a record is not sound, and the next seed is tried.
LOGS = {
    "dice-base": lambda seed: scripted_base(),
    "dice-gaps": lambda seed: solid(seed, 4, shapes=[SCALAR, GAPS, CELLS, CELL_GAPS]).file(4),
    "dice-lifted": lambda seed: solid(seed, 7, shapes=LIFTED, codec=4, splits=0.5).file(4),
    "dice-single": lambda seed: single_cells(seed, 300).file(),
    "dice-steep": lambda seed: solid(seed, 4, bits=26, shapes=[SCALAR, TENSOR]).file(1 << 28),
    "dice-traced": lambda seed: traced(),
    "dice-wild": lambda seed: solid(seed, 4, surprise=0.8).file(),
}


def sound_log(make):
    for seed in itertools.count(1):
        try:
            data = make(seed)
            decode(data)
            return data
        except Refused:
            continue


def write_digests(folder):
    out = {name: [] for name in ("digests", "field-digests", "level-digests", "closing-digests")}
    for path in sorted((folder / "valid").glob("*.qtet")):
        mesh, fields = decode(path.read_bytes())
        out["digests"].append(f"{mesh.digest()}  {path.name}")
        for i, field in enumerate(fields):
            out["field-digests"].append(f"{field.digest()}  {path.name}/{i}")
        for level, digest in sorted(mesh.digests.items()):
            out["level-digests"].append(f"{digest}  {path.name}@{level}")
        for (kind, field), data in closing_blocks(mesh, fields).items():
            digest = hashlib.sha256(data).hexdigest()
            out["closing-digests"].append(f"{digest}  {path.name}#{kind}/{field}")
    for name, lines in out.items():
        (folder / f"{name}.txt").write_text("\n".join(lines) + "\n")


def write_trace(folder):
    trace = []
    decode((folder / "valid" / "dice-traced.qtet").read_bytes(), trace=trace)
    lines = [f"{i} {p} {bit} {low} {high}" for i, (p, bit, low, high) in enumerate(trace)]
    head = "# The decisions of chunk 1 of valid/dice-traced.qtet: number, p, bit, low, high.\n"
    head += "# low and high are those before they shift.\n"
    (folder / "trace.txt").write_text(head + "\n".join(lines) + "\n")


def main():
    folder = Path(sys.argv[1])
    for name, make in LOGS.items():
        path = folder / "valid" / f"{name}.qtet"
        if not path.exists():
            path.write_bytes(sound_log(make))
    write_digests(folder)
    write_trace(folder)


if __name__ == "__main__":
    main()
