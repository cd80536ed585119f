"""Cells, their faces, and the link of a vertex."""
from conventions import G, dot, refuse_unless


def faces(cell):
    a, b, c, d = cell
    return [(b, c, d), (a, d, c), (a, b, d), (a, c, b)]


def with_last(cell, index):
    """The even permutation that puts a vertex last: the other three."""
    c0, c1, c2, c3 = cell
    return [(c1, c3, c2), (c0, c2, c3), (c0, c3, c1), (c0, c1, c2)][index]


class Link:
    """The surface round a vertex: triangles of local ids, neighbours, offsets, middles."""

    def __init__(self, mesh, v):
        self.mesh, self.v = mesh, v
        self.vertices, self.triangles, self.first = [], [], {}
        here = mesh.points[v]
        for ref in mesh.stars[v]:
            cell = mesh.cell(ref)
            corners = []
            for w in with_last(cell, cell.index(v)):
                if w not in self.first:
                    self.first[w] = (len(self.vertices), len(self.triangles))
                    self.vertices.append(w)
                corners.append(self.first[w][0])
            self.triangles.append(tuple(corners))
        edges = {}
        for f, t in enumerate(self.triangles):
            for i in range(3):
                edge = (t[(i + 1) % 3], t[(i + 2) % 3])
                refuse_unless(edge not in edges and edge[0] != edge[1], "an edge twice")
                edges[edge] = f
        self.neighbours = []
        for t in self.triangles:
            across = [edges.get((t[(i + 2) % 3], t[(i + 1) % 3])) for i in range(3)]
            refuse_unless(None not in across, "an open edge")
            self.neighbours.append(across)
        faces_ = len(self.triangles)
        refuse_unless(2 * len(self.vertices) - faces_ == 4, "not a sphere")
        self.has_ghost = G in self.first
        self.offsets = []
        for w in self.vertices:
            place = here if w == G else mesh.points[w]
            self.offsets.append(tuple(float(p - q) for p, q in zip(place, here)))
        self.middles = []
        for t in self.triangles:
            times = 3 if self.is_ghost(t) else 2
            i, j, k = (self.offsets[x] for x in t)
            self.middles.append(tuple((i[a] + j[a] + k[a]) * times for a in range(3)))
        squares = [dot(m, m) for m in self.middles]
        start = squares.index(max(squares))
        self.order = [start]
        seen = {start}
        for f in self.order:
            for g in self.neighbours[f]:
                if g not in seen:
                    seen.add(g)
                    self.order.append(g)
        refuse_unless(len(self.order) == faces_, "not connected")
        self.labels = [None] * faces_
        self.round = [[0] * 4 for _ in self.vertices]

    def is_ghost(self, triangle):
        return any(self.vertices[x] == G for x in triangle)

    def label(self, f, label):
        self.labels[f] = label
        for x in self.triangles[f]:
            self.round[x][label] += 1
