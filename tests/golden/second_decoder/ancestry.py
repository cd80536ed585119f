"""What fields need of records, noted while the mesh grows ("Point values", "Cell values")."""
import math
from collections import defaultdict

from conventions import clamp, cross, dot
from link import faces


class Ancestry:
    """A part of Mesh."""

    def note_fields(self, split, link, points):
        f = tuple(float(x) for x in self.points[split.v])
        ends = [tuple(float(x) for x in p) for p in points]
        if split.k == 2:
            d = tuple(b - a for a, b in zip(*ends))
            length = dot(d, d)
            u = dot([a - b for a, b in zip(ends[0], f)], d) / length if length > 0 else 0.0
            split.step = math.floor(clamp(u, -4.0, 4.0) * 256 + 0.5)
            steps = [d]
        else:
            steps = [tuple(b - a for a, b in zip(f, p)) for p in ends]
        split.slopes = [self.slope(link, d) for d in steps]

    def slope(self, link, d):
        exits = [(0.0, None, None), (0.0, None, None)]
        turned = [cross(d, x) for x in link.offsets]
        for t in link.triangles:
            if link.is_ghost(t):
                continue
            i, j, k = t
            x = link.offsets
            a, b, c = dot(turned[j], x[k]), dot(turned[k], x[i]), dot(turned[i], x[j])
            total = a + b + c
            negative, positive = min(a, b, c) < 0, max(a, b, c) > 0
            if negative == positive or total == 0:
                continue
            reach = dot(x[i], cross(x[j], x[k])) / total
            if abs(reach) > abs(exits[reach > 0][0]):
                exits[reach > 0] = (reach, t, (a / total, b / total, c / total))
        whole = exits[1][0] - exits[0][0]
        weights = []
        if whole >= (1 if self.wrong == "R is at least 1" else 0.25):
            for sign, (reach, t, shares) in zip((-1, 1), exits):
                if reach:
                    for corner, share in zip(t, shares):
                        weight = math.floor(4096 * (sign * share / whole) + 0.5)
                        weights.append((link.vertices[corner], weight))
        return weights

    def note_cells(self, split):
        """Of each new tetrahedron the earlier ones across its faces."""
        sides = defaultdict(list)
        old = [slot for kind, slot in split.star if kind == 0]
        for slot in sorted(set(old)) + split.brought:
            for face in faces(self.tetrahedra[slot]):
                sides[tuple(sorted(face))].append(slot)
        for slot in split.brought:
            self.known[slot] = self.known_at(slot, sides)

    def known_at(self, slot, sides):
        out = []
        for face in faces(self.tetrahedra[slot]):
            lower = [s for s in sides[tuple(sorted(face))] if s < slot]
            if lower:
                lowest = self.wrong == "a tetrahedron knows the lowest slot"
                out.append(lower[0] if lowest else lower[-1])
        return out

    def know_base(self):
        self.known = {}
        sides = defaultdict(list)
        for slot, cell in enumerate(self.tetrahedra):
            for face in faces(cell):
                sides[tuple(sorted(face))].append(slot)
        for slot in range(len(self.tetrahedra)):
            known = self.known_at(slot, sides)
            if not known and slot and self.wrong != "a lone base tetrahedron knows none":
                known = [slot - 1]
            self.known[slot] = known
