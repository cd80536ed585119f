"""Child bits and packets ("Layout regions")."""
from collections import defaultdict

from conventions import G, clamp, quotient, refuse_unless


class Regions:
    """A part of Mesh."""

    def end_head(self, stream, first_node):
        every = [(0, t) for t in range(len(self.tetrahedra))]
        every += [(1, t) for t in range(len(self.triangles))]
        self.waiting = {1: every}
        for node in range(1, first_node):
            self.children(stream, node, self.waiting.pop(node))

    def children(self, stream, node, cells):
        halves = ([], [])
        if cells:
            axis = stream.raw(2)
            refuse_unless(axis <= 2, "an axis")
            place = stream.raw(self.log.bits)
            told = defaultdict(lambda: [0, 0])
            for ref in cells:
                corners = [v for v in self.cell(ref) if v != G]
                x = [self.points[v][axis] for v in corners]
                n = len(corners)
                divide = int.__floordiv__ if self.wrong == "side rounds down" else quotient
                side = divide(4 * (sum(x) - n * place), n * (max(x) - min(x) + 1))
                ones = sum(told[v][1] for v in corners)
                all_ = ones + sum(told[v][0] for v in corners)
                votes = 8 * ones // all_ if all_ else 9
                if self.wrong == "votes are 0 where there are none" and not all_:
                    votes = 0
                bit = stream.bit("child", ref[0], clamp(side, -6, 6), votes)
                for v in corners:
                    told[v][bit] += 1
                halves[bit].append(ref)
        for i in range(2):
            self.waiting[2 * node + i] = halves[i]

    def packets(self, rows, head):
        at_head = self.learnt
        last_node = rows[-1].node
        for row in rows[head:]:
            self.learnt = at_head.copy()
            if self.wrong == "packets keep what packets learnt" and row.node > rows[head].node:
                self.learnt = learnt
            learnt = self.learnt
            stream, told = self.stream(row), iter(self.values(row))
            first, before = len(self.splits), list(self.next)
            cells = self.waiting.pop(row.node)
            count = defaultdict(int)
            for ref in cells:
                for v in self.cell(ref):
                    count[v] += 1
            inner = sorted(v for v, n in count.items() if v != G and n == len(self.stars[v]))
            for level in range(row.first, row.last + 1):
                taken, start = set(), self.next[0]
                for v in list(inner):
                    if v not in taken and self.split_flag(stream, v, level):
                        self.record(stream, v, level, told, taken)
                inner += range(start, self.next[0])
            for kind in (0, 1):
                cells = cells + [(kind, t) for t in range(before[1 + kind], self.next[1 + kind])]
            cells.sort()
            if 2 * row.node <= last_node:
                self.children(stream, row.node, cells)
            refuse_unless(stream.at_end() and next(told, None) is None, "a packet is too long")
            self.split_chunks.append((first, len(self.splits)))
