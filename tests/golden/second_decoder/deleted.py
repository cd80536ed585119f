"""The cells that a record brings back ("Deleted cells"): local ids, and ("prey", i)."""
from conventions import refuse_unless


def is_prey(v):
    return isinstance(v, tuple)


class DeletedCells:
    """A part of Mesh."""

    def derive(self, stream, link, k):
        escape = k >= 3 and stream.bit("escape", k)
        cells, between = [], {}
        detours = 0
        for f, t in enumerate(link.triangles):
            for i in range(3):
                g = link.neighbours[f][i]
                p, q = link.labels[f], link.labels[g]
                if g < f or p == q:
                    continue
                x, y = t[(i + 1) % 3], t[(i + 2) % 3]
                path = [p, q]
                if self.wrong == "detours are counted for the whole log":
                    detours = self.all_detours
                if escape and stream.bit("detour", k, min(detours, 3)):
                    detours += 1
                    self.all_detours = detours
                    others = [c for c in range(k) if c not in (p, q)]
                    inner = others[:1]
                    if len(others) == 2:
                        w = stream.bit("which", k)
                        inner = [others[w]]
                        if stream.bit("second", k):
                            inner.append(others[1 - w])
                            if self.wrong == "second comes before which":
                                inner.reverse()
                    path = [p, *inner, q]
                    between[f, g, x, y] = inner
                    between[g, f, x, y] = inner[::-1]
                for r, s in zip(path, path[1:]):
                    cells.append((x, y, ("prey", r), ("prey", s)))
        if k >= 3:
            for x in range(len(link.vertices)):
                self.walk(stream, link, k, escape, x, between, cells)
        if k == 4:
            whole = [c for c in cells if not is_prey(c[0]) and all(map(is_prey, c[1:]))]
            refuse_unless(whole, "no cell of three prey vertices")
            _, a, b, c = whole[-1 if self.wrong == "the prey's own cell comes from the last" else 0]
            s = ("prey", 6 - a[1] - b[1] - c[1])
            cells.append((a, s, b, c))
        met = set(link.labels) | {v[1] for c in cells for v in c if is_prey(v)}
        refuse_unless(len(met) == k, "a prey vertex without a cell")
        return cells

    def walk(self, stream, link, k, escape, x, between, cells):
        f = start = link.first[link.vertices[x]][1]
        word = []
        while True:
            t = link.triangles[f]
            if not word or word[-1] != link.labels[f]:
                word.append(link.labels[f])
            e = (t.index(x) + 1) % 3
            g = link.neighbours[f][e]
            edge = (x, t[(e + 1) % 3])
            for a, b in (edge, edge[::-1]):
                word += between.get((f, g, a, b), [])
            f = g
            if f == start:
                break
        self.take_apart(stream, k, escape, x, word, cells)

    def take_apart(self, stream, k, escape, x, word, cells):
        while len(word) > 1 and word[0] == word[-1]:
            word = word[:-1]
        if len(word) < 3:
            return
        for i, letter in enumerate(word):
            if letter in word[i + 1 :]:
                j = word.index(letter, i + 1)
                parts = [word[i:j], word[j:] + word[:i]]
                if self.wrong == "the rest of a word comes first":
                    parts.reverse()
                for part in parts:
                    self.take_apart(stream, k, escape, x, part, cells)
                return
        if len(word) == 3:
            a, b, c = (("prey", letter) for letter in word)
            if escape and k == 4 and stream.bit("hidden", k):
                s = ("prey", 6 - sum(word))
                cells += [(x, a, b, s), (x, b, c, s)]
                cells.append((x, a, c, s) if self.wrong == "hidden turns a cell" else (x, c, a, s))
            else:
                cells.append((x, a, b, c))
            return
        if self.wrong != "a word of four is not turned":
            least = word.index(min(word))
            word = word[least:] + word[:least]
        a, b, c, d = (("prey", letter) for letter in word)
        if stream.bit("diagonal", k):
            cells += [(x, a, b, c), (x, a, c, d)]
        else:
            cells += [(x, a, b, d), (x, b, c, d)]
