"""Constants, arithmetic and bytes ("Conventions"). `misreading` everywhere in this decoder names one
sentence of the documents that is read wrongly on purpose, so that judge.py can show that the golden
files notice.
"""
import math
import struct

G = 0xFFFFFFFF  # the ghost vertex
MISSING = -(1 << 31)
LEVEL_END = None


class Refused(Exception):
    """The log breaks a rule."""


def refuse_unless(holds, what):
    if not holds:
        raise Refused(what)


def quotient(a, b):
    """a / b, rounded towards zero."""
    return abs(a) // abs(b) * (1 if (a < 0) == (b < 0) else -1)


def clamp(x, low, high):
    return max(low, min(high, x))


def log(x):
    """L(x)"""
    if x < 1:
        return 0
    if isinstance(x, int):
        e = x.bit_length() - 1
        return 64 * e + ((x << 6) >> e) - 64
    mantissa, exponent = math.frexp(x)
    return 64 * (exponent - 1) + int(64 * (2 * mantissa - 1))


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def one_more_square(a):
    return 1 + a[0] * a[0] + a[1] * a[1] + a[2] * a[2]


class Reader:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, count):
        refuse_unless(self.at + count <= len(self.data), "truncated")
        self.at += count
        return self.data[self.at - count : self.at]

    def unpack(self, form):
        return struct.unpack("<" + form, self.take(struct.calcsize("<" + form)))

    def u8(self):
        return self.take(1)[0]

    def varint(self):
        value = shift = 0
        while True:
            byte = self.u8()
            value |= (byte & 127) << shift
            if byte < 128:
                refuse_unless(byte or not shift, "long varint")
                return value
            shift += 7

    def text(self):
        return self.take(self.varint()).decode("utf-8")
