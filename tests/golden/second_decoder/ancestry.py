"""What fields need of records, noted while the mesh grows ("Point values", "Cell values")."""
import math
from collections import defaultdict

from conventions import G, clamp, cross, dot
from link import faces


NO_EXIT = (0.0, None, None, False)


class Slope:
    """Corners with weights on both sides, and how far these reach."""

    def __init__(self):
        self.reaches, self.beyond, self.sides = [0, 0], [False, False], [[], []]

    def complete(self):
        self.corners = self.sides[0] + self.sides[1]
        self.both = all(self.reaches)
        whole = 256 * sum(self.reaches)
        self.ratios = [min((whole + t // 2) // t, 32767) if t else 0 for t in self.reaches]


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
        exits = [NO_EXIT, NO_EXIT]
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
                exits[reach > 0] = (reach, t, (a / total, b / total, c / total), False)
        self.look_beyond(link, d, exits)
        whole = exits[1][0] - exits[0][0]
        out = Slope()
        if whole >= (1 if self.wrong == "R is at least 1" else 0.25):
            for side, (sign, (reach, t, shares, beyond)) in enumerate(zip((-1, 1), exits)):
                if reach:
                    out.reaches[side] = int(clamp(math.floor(256 * abs(reach) + 0.5), 1, 32767))
                    out.beyond[side] = beyond
                    for corner, share in zip(t, shares):
                        weight = math.floor(4096 * (sign * share / whole) + 0.5)
                        out.sides[side].append((link.vertices[corner], weight))
        out.complete()
        return out

    def look_beyond(self, link, d, exits):
        """Exits beyond the mesh, for sides that have none or a short one."""
        wanted = [abs(exit[0]) < 0.25 for exit in exits]
        if not any(wanted) or self.wrong == "no exit lies beyond the mesh":
            return
        out = [0.0, 0.0, 0.0]
        for offset in link.offsets:
            for a in range(3):
                out[a] -= offset[a]
        for t in link.triangles:
            if not link.is_ghost(t):
                continue
            edge = [v for v in t if link.vertices[v] != G]
            x, y = (link.offsets[v] for v in edge)
            e = tuple(a - b for a, b in zip(x, y))
            n = cross(d, out)
            total = dot(e, n)
            if total == 0:
                continue
            m = cross(e, y)
            share, reach, g = -dot(y, n) / total, dot(m, out) / total, dot(m, d) / total
            if not (0 <= share <= 1 and g >= 0) or reach == 0:
                continue
            if wanted[reach > 0] and abs(reach) > abs(exits[reach > 0][0]):
                exits[reach > 0] = (reach, edge, (share, 1 - share), True)

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
