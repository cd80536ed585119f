"""Value blocks: adaptive ones, and Draco's with digits."""
import struct

from coder import Stream
from conventions import quotient, refuse_unless
from draco_symbols import draco_symbols


def adaptive_values(data, components, tuples, misreading, stream=None):
    stream = stream or Stream(data, None, misreading)
    before = [0] * components
    mean = [0] * 4
    out = []
    for _ in range(tuples):
        beside = 0
        for c in range(components):
            axis = min(c, 3)
            bits = 0
            while True:
                refuse_unless(bits < 32, "a length of 32")
                j = min(bits, 16)
                if not stream.mixed(
                    ("length", axis, j),
                    ("before", axis, before[c], j),
                    ("beside", axis, beside, j),
                    ("mean", axis, min(mean[axis] // 8, 33), j),
                ):
                    break
                bits += 1
            capped = min(bits, 16)
            value = int(bits > 0)
            for i in range(min(bits - 1, 2)):
                value = value * 2 + stream.bit("top", axis, capped, value)
            rest = max(bits - 3, 0)
            value = value << rest | stream.raw(rest)
            if bits and stream.bit("sign", axis, capped):
                value = -value
            out.append(value)
            before[c] = beside = capped
            if misreading == "the running mean takes the capped length":
                bits = capped
            mean[axis] += quotient(16 * bits - mean[axis], 8)
    refuse_unless(data is None or stream.at_end(), "a value block is longer than its values")
    return out


def digit_values(data, components, tuples, misreading):
    (size,) = struct.unpack("<I", data[-4:])
    symbols = draco_symbols(data[: len(data) - 4 - size], tuples, components)
    digits = data[len(data) - 4 - size : -4]
    pending = int.from_bytes(digits, "little")
    out = []
    for symbol in symbols:
        u = abs(symbol)
        if u >= 4:
            count = 1 + (u - 4) // 2
            low = pending & (1 << count) - 1
            if misreading == "digits have their highest bit first":
                low = int(f"{low:0{count}b}"[::-1], 2)
            u = (2 + (u - 4) % 2) << count | low
            pending >>= count
        out.append(u if symbol > 0 else -u)
    refuse_unless(pending == 0, "digits are left over")
    return out


def block_values(data, components, tuples, codec, misreading):
    if tuples == 0:
        refuse_unless(not data, "a block of no tuples has bytes")
        return []
    decode = {2: digit_values, 3: adaptive_values}[codec]
    return decode(data, components, tuples, misreading)
