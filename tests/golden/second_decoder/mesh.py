"""The mesh: base mesh, levels, split flags, records."""
import hashlib
import struct
from collections import defaultdict

from ancestry import Ancestry
from blocks import block_values
from coder import Learnt, Stream
from conventions import G, LEVEL_END, clamp, log, quotient, refuse_unless
from deleted import DeletedCells, is_prey
from labels import Labels
from link import Link, faces, with_last
from positions import Positions


class Split:
    """A record, and what fields need of it."""


class Mesh(Labels, DeletedCells, Positions, Ancestry):
    def __init__(self, log):
        self.log, self.wrong = log, log.misreading
        self.points, self.tetrahedra, self.triangles = [], [], []
        self.stars, self.born = [], []
        self.shift = max(0, log.bits - 20)
        self.learnt = Learnt()
        self.splits = []  # in order of arrival; by chunk in split_chunks
        self.digests = {}
        self.trace = None

    def cell(self, ref):
        kind, slot = ref
        return self.triangles[slot] + (G,) if kind else self.tetrahedra[slot]

    def digest(self):
        sha = hashlib.sha256()
        for tuples in (self.points, self.tetrahedra, self.triangles):
            for t in tuples:
                sha.update(b"".join(struct.pack("<I", x & 0xFFFFFFFF) for x in t))
        return sha.hexdigest()

    def stream(self, row):
        return Stream(row.blocks[0], self.learnt, self.wrong, self.trace)

    def values(self, row):
        codec = 2 if row.codec == 4 else row.codec
        return block_values(row.blocks[1], 3, row.vertices, codec, self.wrong)

    def check_points(self, points):
        for p in points:
            for x in p:
                refuse_unless(0 <= x < 1 << self.log.bits, "off the lattice")

    # Base mesh

    def base(self, row):
        stream = Stream(row.blocks[0], Learnt(), self.wrong)
        self.grow(stream, row.tetrahedra)
        refuse_unless(len(self.births) == row.vertices and stream.at_end(), "base mesh")
        self.place_base(iter(self.values(row)))
        refuse_unless(len(self.triangles) == row.triangles, "boundary triangles")

    def grow(self, stream, tetrahedra):
        self.births = []
        is_open, queue, head = {}, [], 0

        def vertex(question, birth):
            slot = len(self.births)
            if stream.bit(question):
                self.births.append(birth)
                return slot
            n = stream.number("back")
            refuse_unless(n < slot, "a vertex that is not there")
            return slot - 1 - n

        def place(cell):
            refuse_unless(len(set(cell)) == 4, "a vertex twice")
            self.tetrahedra.append(cell)
            for face, w in zip(faces(cell), cell):
                key = tuple(sorted(face))
                if key in is_open:
                    del is_open[key]
                else:
                    is_open[key] = len(queue)
                    queue.append((face, w, key))

        while len(self.tetrahedra) < tetrahedra:
            if head == len(queue):
                place(tuple(vertex("seed fresh", None) for _ in range(4)))
                continue
            face, w, key = queue[head]
            head += 1
            if is_open.get(key) != head - 1:
                continue
            if stream.bit("boundary"):
                if self.wrong == "a boundary face leaves the set":
                    del is_open[key]
                continue
            place(face + (vertex("fresh", (face, w)),))

    def place_base(self, told):
        for v, birth in enumerate(self.births):
            if birth is None:
                q = self.points[v - 1] if v else (0, 0, 0)
            else:
                x, y, z = (self.points[u] for u in birth[0])
                w = self.points[birth[1]]
                q = [quotient(2 * (x[a] + y[a] + z[a]) + 1, 3) - w[a] for a in range(3)]
            self.points.append(tuple(q[a] + next(told) for a in range(3)))
        self.check_points(self.points)
        count = defaultdict(int)
        for cell in self.tetrahedra:
            for face in faces(cell):
                count[tuple(sorted(face))] += 1
        for cell in self.tetrahedra:
            for face in faces(cell):
                if count[tuple(sorted(face))] == 1:
                    self.triangles.append(face)
        self.stars = [[] for _ in self.points]
        self.born = [0] * len(self.points)
        for kind, cells in enumerate((self.tetrahedra, self.triangles)):
            for slot, cell in enumerate(cells):
                for v in cell:
                    self.stars[v].append((kind, slot))

    # Refinement

    def spread(self, v):
        here = self.points[v]
        edges, sums = 0, [0, 0, 0]
        for ref in self.stars[v]:
            for w in self.cell(ref):
                if w not in (v, G):
                    edges += 1
                    for a in range(3):
                        sums[a] += (here[a] - self.points[w][a] >> self.shift) ** 2
        return edges, sums

    def log_mean(self, total, edges):
        return max(0, log(total % 2**64) - log(edges))

    def split_flag(self, stream, v, level):
        know = self.learnt
        n = len(self.stars[v])
        if self.wrong == "the star's size counts tetrahedra only":
            n = sum(1 for kind, _ in self.stars[v] if kind == 0)
        edges, sums = self.spread(v)
        extent = self.log_mean(sum(sums), edges)
        scale = extent - know.m // 16

        def step(w, h):
            divided = scale // w if self.wrong == "step rounds down" else quotient(scale, w)
            return clamp(divided + h, 0, 2 * h - 1)

        born = self.born[v]
        old = 2 if self.wrong == "age is 1 for two levels" else 1
        age = 0 if born == 0 else 1 if level - born <= old else 2
        since = 15 if born == 0 else min(level - born, 14)
        edge = int(any(kind for kind, _ in self.stars[v]))
        flat = min((log(max(sums) + 1) - log(min(sums) + 1)) // 48, 7)
        split = stream.mixed(
            ("split", age),
            ("split size", min(n // 6, 15), step(16, 8), age),
            ("split scale", step(8, 32), edge, age),
            ("split age", since, min(n // 2, 31), edge),
            ("split run", know.run, flat, step(24, 4)),
        )
        know.run = (know.run << 1 | split) & (7 if self.wrong == "run has three flags" else 15)
        if split or self.wrong == "m follows every flag":
            know.m += quotient(16 * extent - know.m, 64)
        return split

    def record(self, stream, v, level, told, taken):
        link = Link(self, v)
        taken.update(w for w in link.vertices if w != G)
        taken.add(v)
        size = min(len(link.triangles) // 24, 3)
        k = 2
        if stream.bit("k = 4", size, link.has_ghost):
            k = 4
        elif stream.bit("k = 3", size, link.has_ghost):
            k = 3
        self.read_labels(stream, link, k)
        deleted = self.derive(stream, link, k)
        points = self.read_points(stream, link, k, v, told)
        split = Split()
        split.placement, split.near = self.placement, self.near
        split.v, split.k, split.level = v, k, level
        split.prey = [v] + list(range(self.next[0], self.next[0] + k - 1))
        self.note_fields(split, link, points)
        self.apply(split, link, points, deleted, level)
        self.splits.append(split)
        taken.update(split.prey)

    def put(self, cells, slot, cell):
        if slot == len(cells):
            cells.append(cell)
        else:
            cells[slot] = cell

    def apply(self, split, link, points, deleted, level):
        star = self.stars[split.v]
        for p, point in zip(split.prey, points):
            if p == len(self.points):
                self.points.append(None), self.stars.append(None), self.born.append(0)
            self.points[p], self.stars[p], self.born[p] = point, [], level
        split.star = []
        for ref, label in zip(star, link.labels):
            new = split.prey[label]
            cells = self.triangles if ref[0] else self.tetrahedra
            cells[ref[1]] = tuple(new if w == split.v else w for w in cells[ref[1]])
            self.stars[new].append(ref)
            split.star.append(ref)
        split.brought = []
        for local in deleted:
            cell = tuple(split.prey[x[1]] if is_prey(x) else link.vertices[x] for x in local)
            if G in cell:
                kind, cells, corners = 1, self.triangles, with_last(cell, cell.index(G))
            else:
                kind, cells, corners = 0, self.tetrahedra, cell
            slot = self.next[1 + kind]
            self.next[1 + kind] += 1
            self.put(cells, slot, corners)
            for w in corners:
                self.stars[w].append((kind, slot))
                self.stars[w].sort()
            if kind == 0:
                split.brought.append(slot)
        self.next[0] += split.k - 1
        if any(association & 127 == 1 for _, association in self.log.shapes):
            self.note_cells(split)

    def decode(self):
        rows = self.log.rows
        self.all_detours = 0
        self.base(rows[0])
        self.know_base()
        self.next = [len(self.points), len(self.tetrahedra), len(self.triangles)]
        self.split_chunks = [(0, 0)]
        self.digests[0] = self.digest()
        level, visited, last, taken = 0, None, 0, set()
        for row in rows[1:]:
            stream, told = self.stream(row), iter(self.values(row))
            first = len(self.splits)
            for level in range(row.first, row.last + 1):
                if visited is None:
                    visited, last, taken = 0, len(self.points), set()
                    before = len(self.splits)
                end = row.end if level == row.last and row.end is not LEVEL_END else last
                for v in range(visited, min(end, last)):
                    if v not in taken and self.split_flag(stream, v, level):
                        self.record(stream, v, level, told, taken)
                if level == row.last and row.end is not LEVEL_END:
                    visited = end
                else:
                    visited = None
                    refuse_unless(len(self.splits) > before, "a level without a record")
                    self.digests[level] = self.digest()
            self.split_chunks.append((first, len(self.splits)))
            refuse_unless(len(self.splits) - first == row.records, "records")
            refuse_unless(stream.at_end() and next(told, None) is None, "a chunk is too long")
