"""A second decoder of logs, written from the documents in codec/ alone: plain and slow."""
import hashlib
import struct

from blocks import block_values
from conventions import MISSING, clamp, quotient, refuse_unless
from head import Log
from lifted import Lifted
from mesh import Mesh


class Field(Lifted):
    def __init__(self, mesh, number):
        self.mesh, self.log, self.number = mesh, mesh.log, number
        self.wrong = mesh.wrong
        self.components, association = self.log.shapes[number]
        self.of_cells, self.gaps = association & 127 == 1, association >= 128
        self.values, self.sizes = {}, {}

    def decode(self):
        tetrahedra = 0
        for chunk, row in enumerate(self.log.rows):
            first, end = self.mesh.split_chunks[chunk]
            n = self.components
            if self.of_cells:
                tuples = row.tetrahedra
            else:
                tuples = row.vertices + row.records
            data, codec = row.blocks[2 + self.number], row.codec
            if codec == 4 and not self.of_cells:
                self.lifted_block(data, chunk, self.mesh.splits[first:end])
                continue
            codec = 3 if codec == 4 else codec
            told = iter(block_values(data, n, tuples, codec, self.wrong))
            if self.of_cells:
                for t in range(tetrahedra, tetrahedra + row.tetrahedra):
                    self.values[t] = [self.read(told, self.of_cell(t, c)) for c in range(n)]
                tetrahedra += row.tetrahedra
                continue
            if chunk == 0:
                for v, birth in enumerate(self.mesh.births):
                    self.values[v] = [self.read(told, self.of_base(v, birth, c)) for c in range(n)]
            for split in self.mesh.splits[first:end]:
                self.split(split, told)
            refuse_unless(next(told, None) is None, "values are left over")

    def read(self, told, predicted):
        x = next(told)
        if self.gaps:
            if x == 0:
                return MISSING
            x = x if x < 0 else x - 1
        refuse_unless(abs(predicted + x) <= 1 << 30, "a value beyond 2^30")
        return predicted + x

    def of_cell(self, t, c):
        known = [self.values[s][c] for s in self.mesh.known[t]]
        known = [x for x in known if x != MISSING]
        twice = [x for x in known if known.count(x) > 1]
        if twice:
            return min(twice)
        return quotient(sum(known), len(known)) if known else 0

    def of_base(self, v, birth, c):
        if birth is None:
            before = self.values[v - 1][c] if v else 0
            return 0 if self.gaps and before == MISSING else before
        corners = [self.values[u][c] for u in birth[0]]
        if not self.gaps:
            third = int.__floordiv__ if self.wrong == "a third rounds down" else quotient
            return third(sum(corners) + 1, 3)
        there = [x for x in corners if x != MISSING]
        half = 0 if self.wrong == "a face's mean with gaps has no half" else len(there) // 2
        return quotient(sum(there) + half, len(there)) if there else 0

    def split(self, split, told):
        k, n = split.k, self.components
        new = [[None] * n for _ in range(k)]
        places = [(i, c) for c in range(n) for i in range(k)]
        if self.wrong == "a record's values are k tuples":
            places = [(i, c) for i in range(k) for c in range(n)]
        for i, c in places:
            new[i][c] = self.read(told, self.predicted(split, i, c))
        for p, values in zip(split.prey, new):
            self.values[p] = values

    def predicted(self, split, i, c):
        f = self.values[split.v][c]
        if f == MISSING:
            return 0
        slope = split.slopes[0 if split.k == 2 else i]
        sums = [0, 0]
        for side, corners in enumerate(slope.sides):
            for v, weight in corners:
                x = self.values[v][c]
                if x != MISSING:
                    sums[side] += weight * (x - f)
        change = sum(sums)
        if any(slope.beyond) and self.wrong != "a prediction looks beyond the mesh":
            change = sum(sums[s] * slope.ratios[s] >> 8 for s in range(2) if not slope.beyond[s])
        steps = 256
        if split.k == 2:
            steps = split.step + (256 if i else 0)
        predicted = f + (change * steps + (1 << 19) >> 20)
        if self.wrong == "a prediction is not clamped to 2^29":
            return predicted
        return clamp(predicted, -(1 << 29), 1 << 29)

    def add_parents(self, fields):
        """Values from differences in time ("Series")."""
        parents = self.log.parents[self.number]
        for i, values in self.values.items() if parents else ():
            for c, x in enumerate(values):
                if x != MISSING:
                    parts = [(fields[p].values[i][c], weight) for p, weight in parents]
                    values[c] = x + self.in_time(parts)

    def in_time(self, parents):
        there = [x for x, _ in parents if x != MISSING]
        if len(there) < len(parents):
            last = self.wrong == "a gap in time takes the last that is there"
            return there[-1 if last else 0] if there else 0
        half = 0 if self.wrong == "a prediction in time has no half" else 8
        return sum(x * weight for x, weight in parents) + half >> 4

    def digest(self):
        count = len(self.mesh.tetrahedra if self.of_cells else self.mesh.points)
        data = b"".join(struct.pack("<i", x) for i in range(count) for x in self.values[i])
        return hashlib.sha256(data).hexdigest()


def decode(data, misreading="", trace=None):
    """(the mesh with its digest of each level, its fields)"""
    log = Log(data, misreading)
    mesh = Mesh(log)
    mesh.trace = trace
    mesh.decode()
    fields = [Field(mesh, f) for f in range(log.fields)]
    for field in fields:
        field.decode()
        field.add_parents(fields)
    return mesh, fields
