"""The integers of a Draco bit stream of the one kind that logs hold (codec/FORMAT.md, "Value
blocks"): a point cloud in sequential encoding, one generic attribute of int32, no prediction.
"""


class Bytes:
    def __init__(self, data):
        self.data, self.at = data, 0

    def u8(self):
        return self.take(1)[0]

    def varint(self):
        value = shift = 0
        while True:
            byte = self.u8()
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return value

    def take(self, count):
        assert self.at + count <= len(self.data), "a Draco stream ends too early"
        self.at += count
        return self.data[self.at - count : self.at]


def probabilities(reader):
    out = []
    count = reader.varint()
    while len(out) < count:
        first = reader.u8()
        extra = first & 3
        if extra == 3:  # a run of symbols that do not occur
            out += [0] * ((first >> 2) + 1)
            continue
        value = first >> 2
        for b in range(extra):
            value |= reader.u8() << (8 * b + 6)
        out.append(value)
    return out


class Symbols:
    """A rANS decoder with a table; it reads its bytes from the end."""

    def __init__(self, reader, alphabet_bits):
        self.precision = min(20, max(12, 3 * alphabet_bits // 2))
        self.base = 4 << self.precision
        self.table = []
        for symbol, p in enumerate(probabilities(reader)):
            start = len(self.table)
            self.table += [(symbol, p, start)] * p
        assert len(self.table) == 1 << self.precision
        self.data = reader.take(reader.varint())
        width = 1 + (self.data[-1] >> 6)
        self.at = len(self.data) - width
        state = int.from_bytes(self.data[self.at :], "little")
        self.state = (state & (1 << (8 * width - 2)) - 1) + self.base

    def next(self):
        while self.state < self.base and self.at > 0:
            self.at -= 1
            self.state = self.state * 256 + self.data[self.at]
        rest = self.state & (1 << self.precision) - 1
        symbol, p, start = self.table[rest]
        self.state = (self.state >> self.precision) * p + rest - start
        return symbol


def draco_symbols(data, tuples, components):
    """tuples * components integers, in order."""
    reader = Bytes(data)
    assert reader.take(5) == b"DRACO" and reader.u8() == 2
    reader.take(5)  # minor version, point cloud, sequential, flags
    assert int.from_bytes(reader.take(4), "little") == tuples
    assert reader.take(5) == bytes([1, 1, 4, 5, components])
    reader.u8()
    reader.varint()
    assert reader.take(2) == bytes([1, 0xFE])
    count = tuples * components
    if reader.u8() == 0:
        size = reader.u8()
        codes = [int.from_bytes(reader.take(size), "little") for _ in range(count)]
    elif reader.u8() == 0:  # a symbol tells the bits of each tuple
        tags = Symbols(reader, 5)
        bits = int.from_bytes(reader.data[reader.at :], "little")
        codes = []
        for _ in range(tuples):
            length = tags.next()
            for _ in range(components):
                codes.append(bits & (1 << length) - 1)
                bits >>= length
    else:
        symbols = Symbols(reader, reader.u8())
        codes = [symbols.next() for _ in range(count)]
    return [code >> 1 ^ -(code & 1) for code in codes]
