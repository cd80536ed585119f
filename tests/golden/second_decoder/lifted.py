"""Lifted blocks and guessed integers (codec/VALUES.md)."""
from coder import Stream
from conventions import MISSING, clamp, log, quotient, refuse_unless

PLACES = {"at prey": 0, "middle": 1, "quarter": 2, "free": 3}
NOTHING = {
    "kind": 0, "around": 0, "bend": 0, "slope": 0, "spread": 0, "beside": 0, "shift": 0,
    "sign": 0, "first": True, "place": 0,
}  # fmt: skip


def size(x):
    return log(1 + abs(x)) // 16


def steps(x):
    return 0 if x == 0 else min(log(x) // 32 + 1, 31)


class Guesses:
    """The integers of one axis: differences, or corrections."""

    def __init__(self, stream, name, misreading):
        self.stream, self.name, self.wrong = stream, name, misreading
        self.weights = {}
        self.r = 0

    def read(self, hints):
        h = {**NOTHING, **hints}
        less = lambda x: max(0, x - 16 * h["shift"])
        bend = 0 if h["bend"] == 31 and self.wrong != "bend 31 is a figure" else 8 * h["bend"]
        figures = [quotient(self.r, 16), less(h["around"]), less(bend), less(8 * h["slope"])]
        figures += [less(8 * h["spread"]), less(16 * h["beside"]), 64]
        quarter = [16384, 16384, 16384, 0, 0, 16384, 0]
        by = 0 if self.wrong == "all kinds share their weights" else h["kind"]
        weights = self.weights.setdefault(by, quarter)
        g = clamp(sum(w * x for w, x in zip(weights, figures)) >> 16, 0, 272)
        n = self.length(h, g)
        if self.wrong != "the running length follows corrections of its own only":
            self.r += quotient(256 * n - self.r, 16)
        x = self.signed(h, n)
        t = min(log(1 + abs(x)) // 4, 272) - g
        s = 256 + sum(figure * figure for figure in figures)
        step = quotient(300 * t * 65536, s)
        for i, figure in enumerate(figures):
            weights[i] += step * figure >> 16
        return x

    def length(self, h, g):
        coarse = min(quotient(g, 12), 23)
        first = True if self.wrong == "mixers are not by first" else h["first"]
        shift = 0 if self.wrong == "models beside are not by shift" else min(h["shift"], 3)
        n = 0
        while True:
            refuse_unless(n < 32, "a length of 32")
            j = min(n, 17)
            if not self.stream.mixed(
                (self.name, "length", h["kind"], first, j),
                (self.name, "around", h["around"] // 12, coarse, j),
                (self.name, "beside", min(h["beside"], 15), shift, j),
                (self.name, "bend", h["bend"], coarse, j),
                (self.name, "place", h["place"], g // 2, j),
            ):
                return n
            n += 1

    def signed(self, h, n):
        if n == 0:
            return 0
        value, j = 1, min(n, 17)
        for _ in range(min(n - 1, 2)):
            value = value * 2 + self.stream.bit(self.name, "top", j, value)
        rest = max(n - 3, 0)
        value = value << rest | self.stream.raw(rest)
        sign = 0 if self.wrong == "signs are not by the likely one" else h["sign"]
        return -value if self.stream.bit(self.name, "sign", sign, j) else value


class Lifted:
    """A part of Field: its blocks, where they are lifted."""

    def lifted_block(self, data, chunk, splits):
        self.stream = self.stream_of(data)
        self.axes = [
            [Guesses(self.stream, (axis, kind), self.wrong) for kind in range(2)]
            for axis in range(4)
        ]
        self.scores = [0] * 4
        self.rule = (0, 0)
        if chunk == 0:
            for v, birth in enumerate(self.mesh.births):
                self.base_vertex(v, birth)
        level = None
        for split in splits:
            if split.level != level:
                level = split.level
                self.rule = self.read_rule()
            self.lifted_split(split)
        if data is not None:
            refuse_unless(not data or self.stream.at_end(), "a lifted block is too long")

    def stream_of(self, data):
        return Stream(data, None, self.wrong)

    def read_rule(self):
        q, w = self.rule
        if not self.stream.bit("same shift"):
            q = self.stream.raw(5) - 1
        if not self.stream.bit("same curvature"):
            w = self.stream.raw(7)
        return q, w

    def guessed(self, c, correction, hints):
        axis = c if self.wrong == "each component has models" else min(c, 3)
        return self.axes[axis][correction].read(hints)

    def base_vertex(self, v, birth):
        self.values[v], self.sizes[v] = [0] * self.components, [0] * self.components
        for c in range(self.components):
            near = birth is not None and any(self.values[u][c] == MISSING for u in birth[0])
            if self.gaps and self.stream.bit("missing", int(near)):
                self.values[v][c] = MISSING
                continue
            x = self.guessed(c, 0, {"kind": 3, "first": c == 0})
            self.values[v][c] = self.checked(self.of_base(v, birth, c) + x)
            self.sizes[v][c] = size(x)

    def checked(self, value):
        refuse_unless(abs(value) <= 1 << 30, "a value beyond 2^30")
        return value

    def lifted_split(self, split):
        n = self.components
        new = [[MISSING] * n for _ in split.prey]
        sizes = [[0] * n for _ in split.prey]
        self.beside = 0
        for c in range(n):
            there = self.present(split, c)
            if len(there) == split.k:
                self.component(split, c, new, sizes)
            else:
                self.rim(split, c, there, new, sizes)
        for p, values, size_of in zip(split.prey, new, sizes):
            self.values[p], self.sizes[p] = values, size_of

    def present(self, split, c):
        if not self.gaps:
            return list(range(split.k))
        if self.values[split.v][c] == MISSING:
            return []
        near = any(
            weight and self.values[v][c] == MISSING
            for slope in split.slopes
            for v, weight in slope.corners
        )
        there = []
        for i in range(split.k):
            last = i + 1 == split.k and not there
            before = len(there) < i
            if self.wrong == "a missing prey vertex before does not count":
                before = False
            if last or not self.stream.bit("missing", 2 + 2 * near + before):
                there.append(i)
        return there

    def rim(self, split, c, there, new, sizes):
        f, was = self.values[split.v][c], self.sizes[split.v][c]
        for i in range(split.k):
            sizes[i][c] = was
            if i not in there:
                continue
            x, first = 0, i == there[0]
            if self.rule[0] >= 0 or not first:
                hints = {"kind": 2, "around": min(4 * was, 236), "first": first}
                x = self.guessed(c, 0, hints)
            new[i][c] = self.checked(f + x)
            sizes[i][c] = (was + size(x) + 1) // 2

    def value(self, v, c, instead):
        x = self.values[v][c]
        return instead if x == MISSING else x

    def sums(self, slope, c, less, instead):
        out = [0, 0]
        for side, corners in enumerate(slope.sides):
            for v, weight in corners:
                out[side] += weight * (self.value(v, c, instead) - less)
        return out

    def component(self, split, c, new, sizes):
        f, was, k = self.values[split.v][c], self.sizes[split.v][c], split.k
        u = clamp(-split.step, 0, 256) if k == 2 else 0
        rises = [self.sums(slope, c, f, f) for slope in split.slopes]
        plain = [256 * sum(rise) + (1 << 19) >> 20 for rise in rises]
        chosen = [self.step(split, s, r, p, u) for s, r, p in zip(split.slopes, rises, plain)]
        guess, plain = self.differences(k, chosen), self.differences(k, plain)
        both = all(slope.both for slope in split.slopes)
        other, axis = None, min(c, 3)
        if any(any(slope.beyond) for slope in split.slopes):
            other = self.differences(k, [self.within(s, r) for s, r in zip(split.slopes, rises)])
            score = self.scores[axis]
            if score > 0:
                guess, plain, other, both = other, other, guess, False
        hints = {
            "kind": 2 if k > 2 else 0 if both else 1,
            "around": self.around(split, c, was),
            "bend": self.bend(split, rises) if both else 31,
            "slope": steps(2 * max(abs(x) for x in plain)),
            "spread": self.spread(split, c, f),
            "place": PLACES[split.placement],
        }
        d, largest, better, x = [0] * k, 0, 0, 0
        for i in range(1, k):
            likely = 1 if plain[i] > guess[i] else 2 if plain[i] < guess[i] else 0
            told = {"sign": likely, "first": i == 1, "beside": self.beside}
            x = self.guessed(c, 0, {**hints, **told})
            d[i] = guess[i] + x
            largest = max(largest, size(x))
            self.beside = max(self.beside, abs(x).bit_length())
            if other:
                better += size(d[i] - other[i]) - size(x)
        if other:
            decay = 0 if self.wrong == "the score does not decay" else quotient(score, 16)
            self.scores[axis] += (better if score > 0 else -better) - decay
        q, curve = self.rule
        y = f
        if q >= 0:
            told = {
                "sign": 1 if x > 0 else 2 if x < 0 else 0,
                "beside": self.beside,
                "shift": q,
                "bend": clamp(largest - 4 * q + 16, 0, 30),
            }
            y -= self.guessed(c, 1, {**hints, **told}) << q
        first = self.mean_of(split, c, y, f, curve, u) - self.mean(split, d, u)
        for i in range(k):
            new[i][c] = self.checked(first + d[i])
            sizes[i][c] = (was + largest + 1) // 2

    def differences(self, k, step):
        if k == 2:
            return [0, clamp(step[0], -(1 << 29), 1 << 29)]
        return [0] + [clamp(s - step[0], -(1 << 29), 1 << 29) for s in step[1:]]

    def step(self, split, slope, rise, plain, u):
        if not slope.both:
            return plain
        m = min(u, 256 - u)
        a, b, c = (20, 22, 22)
        if split.k > 2 or m < 32:
            a, b, c = 19, 45, 0
        elif m < 96 and self.wrong != "a quarter has the shares of the middle":
            a, b, c = 30, 26, 8
        far = 1 if split.k > 2 or u <= 128 else 0
        if self.wrong == "far is always along the step":
            far = 1
        parts = [rise[side] * slope.ratios[side] >> 8 for side in range(2)]
        return a * sum(rise) + b * parts[far] + c * parts[1 - far] + (1 << 17) >> 18

    def within(self, slope, rise):
        parts = [
            rise[side] * slope.ratios[side]
            for side in range(2)
            if not slope.beyond[side] and slope.reaches[side]
        ]
        return quotient(sum(parts), len(parts)) + (1 << 19) >> 20 if parts else 0

    def around(self, split, c, was):
        found = [was, was]
        for slope in split.slopes:
            found += [self.sizes[v][c] for v, weight in slope.corners if weight]
        if self.wrong == "the fused vertex's size counts once":
            found = found[1:]
        return min(4 * (sum(found) // len(found)), 236)

    def spread(self, split, c, f):
        found = [0]
        for slope in split.slopes:
            found += [
                abs(self.value(v, c, f) - f) for v, weight in slope.corners if weight
            ]
        return steps(max(found))

    def bend(self, split, rises):
        apart = [
            abs(rise[1] * slope.ratios[1] - rise[0] * slope.ratios[0]) >> 19
            for slope, rise in zip(split.slopes, rises)
        ]
        return min(steps(max(apart)), 30)

    def mean(self, split, d, u):
        if split.k == 2:
            return u * d[1] >> 8
        if split.placement == "at prey" and self.wrong != "a mean of three is never at one":
            return d[split.near]
        return {3: 85, 4: 64}[split.k] * sum(d) >> 8

    def mean_of(self, split, c, y, f, curve, u):
        """M, from the fused value without its correction."""
        slope = split.slopes[0]
        v = curve * 4 * u * (256 - u) >> 16
        if split.k > 2 or not slope.both:
            v = 0
        if any(slope.beyond) and self.wrong != "curvature counts beyond the mesh":
            v = 0
        missing = any(w and self.values[x][c] == MISSING for x, w in slope.corners)
        if missing and self.wrong != "curvature counts beside missing values":
            v = 0
        if v == 0:
            return y
        a = next(self.value(x, c, f) for x, weight in slope.corners if weight)
        against, along = self.sums(slope, c, a, f)
        e = a + (slope.reaches[0] * along - slope.reaches[1] * against + (1 << 19) >> 20)
        fused = lambda m: m + ((m - e) * v + 128 >> 8)
        m = e + quotient(256 * (y - e), 256 + v)
        while fused(m) > y:
            m -= 1
        while fused(m + 1) <= y:
            m += 1
        return m
