"""Decisions, raw bits, models and mixers of one stream ("Range coder")."""
from collections import defaultdict

from conventions import clamp, refuse_unless

LOGISTIC = [
    22, 36, 60, 98, 162, 267, 439, 720, 1179, 1921, 3108, 4971, 7812, 11955, 17625, 24743, 32768,
    40793, 47911, 53581, 57724, 60565, 62428, 63615, 64357, 64816, 65097, 65269, 65374, 65438,
    65476, 65500, 65514,
]  # fmt: skip


def squash(x):
    y = x + 2048
    j = y // 128
    return LOGISTIC[j] + ((LOGISTIC[j + 1] - LOGISTIC[j]) * (y % 128) >> 7)


OPINIONS = []
for top_bits in range(4096):
    least = OPINIONS[-1] if OPINIONS else -2047
    while least < 2047 and squash(least) < 16 * top_bits + 8:
        least += 1
    OPINIONS.append(least)


class Learnt:
    """Models by question and context, and what else structure blocks keep."""

    def __init__(self):
        self.models = defaultdict(lambda: [32768, 0])
        self.mixers = {}
        self.m, self.run = 10240, 0

    def copy(self):
        out = Learnt()
        for key, model in self.models.items():
            out.models[key] = list(model)
        out.mixers = {key: list(weights) for key, weights in self.mixers.items()}
        out.m, out.run = self.m, self.run
        return out


class Stream:
    """The decisions and raw bits of one block. `trace` takes (p, bit, low, high) of each."""

    def __init__(self, data, learnt=None, misreading="", trace=None):
        self.data, self.misreading, self.trace = data, misreading, trace
        self.learnt = learnt or Learnt()
        self.low, self.high, self.code = 0, 0xFFFFFFFF, 0
        self.front = self.back = 0
        self.pending = self.pending_bits = 0
        for _ in range(4):
            self.code = self.code << 8 | self.next()

    def next(self):
        byte = self.data[self.front] if self.front < len(self.data) else 0
        self.front += 1
        return byte

    def decide(self, p):
        refuse_unless(self.front + self.back <= len(self.data), "truncated")
        low, high = self.low, self.high
        middle = low + ((high - low) * p >> 16)
        bit = int(self.code <= middle)
        if bit:
            self.high = middle
        else:
            self.low = middle + 1
        if self.trace is not None:
            self.trace.append((p, bit, self.low, self.high))
        while (self.low ^ self.high) >> 24 == 0:
            self.low = self.low << 8 & 0xFFFFFFFF
            self.high = (self.high << 8 | 255) & 0xFFFFFFFF
            self.code = (self.code << 8 | self.next()) & 0xFFFFFFFF
        return bit

    def raw(self, bits):
        while self.pending_bits < bits:
            self.back += 1
            if self.back <= len(self.data):
                self.pending |= self.data[-self.back] << self.pending_bits
            self.pending_bits += 8
        value = self.pending & (1 << bits) - 1
        self.pending >>= bits
        self.pending_bits -= bits
        return value

    def learn(self, model, bit):
        p, n = model
        rate = 655360 // (10 * n + 16)
        model[0] = p + ((65535 - p) * rate >> 16) if bit else p - (p * rate >> 16)
        model[1] = min(n + 1, 255 if self.misreading == "models learn up to n = 255" else 90)

    def bit(self, *key):
        model = self.learnt.models[key]
        bit = self.decide(clamp(model[0], 32, 65504))
        self.learn(model, bit)
        return bit

    def mixed(self, mixer, *keys):
        models = [self.learnt.models[key] for key in keys]
        opinions = [OPINIONS[model[0] >> 4] for model in models]
        first = 65536 if self.misreading == "weights begin at 65536 / N" else 80000
        weights = self.learnt.mixers.setdefault(mixer, [first // len(keys)] * len(keys))
        x = clamp(sum(w * o for w, o in zip(weights, opinions)) >> 16, -2047, 2047)
        p = squash(x)
        if self.misreading != "a mixed p is not clamped":
            p = clamp(p, 32, 65504)
        bit = self.decide(p)
        error = 65536 * bit - p
        for i, opinion in enumerate(opinions):
            weights[i] += opinion * error + 65536 >> 17
        for model in models:
            self.learn(model, bit)
        return bit

    def unary(self, *key):
        bits = 0
        while bits < 32 and self.bit(*key, "more", bits):
            bits += 1
        return bits

    def number(self, *key):
        bits = self.unary(*key)
        if bits < 2:
            return bits
        out = 1
        for i in range(bits - 1):
            out = out * 2 + (self.bit(*key, "below", bits, out) if i < 2 else self.raw(1))
        return out

    def at_end(self):
        return self.front + self.back == len(self.data) and self.pending == 0
