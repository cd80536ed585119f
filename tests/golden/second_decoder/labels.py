"""Which prey vertex each cell of a star goes to ("Label stream")."""
from conventions import clamp, dot, log, one_more_square, quotient


class Labels:
    """A part of Mesh."""

    def read_labels(self, stream, link, k):
        link.label(link.order[0], 0)
        seen = 1
        sums = [[0.0] * 3 for _ in range(4)]
        counts = [0] * 4
        everything, labelled = [0.0] * 3, 0

        def take(f, label):
            nonlocal labelled
            counts[label] += 1
            labelled += 1
            for a in range(3):
                sums[label][a] += link.middles[f][a]
                everything[a] += link.middles[f][a]

        take(link.order[0], 0)
        for f in link.order[1:]:
            label = self.read_label(stream, link, k, f, seen, sums, counts, everything, labelled)
            link.label(f, label)
            seen = max(seen, label + 1)
            take(f, label)

    def read_label(self, stream, link, k, f, seen, sums, counts, everything, labelled):
        corners, middle = link.triangles[f], link.middles[f]
        candidates = min(seen + 1, k)
        neighbours = [0] * 4
        for g in link.neighbours[f]:
            if link.labels[g] is not None:
                neighbours[link.labels[g]] += 1
        round_ = [sum(link.round[x][c] for x in corners) for c in range(4)]
        if self.wrong == "shared counts a triangle once":
            near = {g for g, t in enumerate(link.triangles) if set(t) & set(corners)}
            round_ = [sum(1 for g in near if link.labels[g] == c) for c in range(4)]
        shared = [8 * r // max(sum(round_), 1) for r in round_]
        distance, score = [0] * 4, [0] * 4
        for c in range(candidates):
            if counts[c]:
                n, s = counts[c], sums[c]
            else:
                n, s = labelled, [-x for x in everything]
            d = [float(n) * middle[a] - s[a] for a in range(3)]
            distance[c] = log(dot(d, d)) - 2 * log(n)
            score[c] = 96 * neighbours[c] + 12 * shared[c] - distance[c]
        order = sorted(range(candidates), key=lambda c: -score[c])

        def many(c):
            return (counts[c] >= 2) + (counts[c] >= 5) + (counts[c] >= 10)

        for rank in range(candidates - 1):
            a, b = order[rank], order[rank + 1]
            question = 0 if k == 2 else 1 + rank
            if self.wrong == "k = 4 has label models of its own" and k == 4:
                question += 10
            place = (question, neighbours[a], neighbours[b])
            d = distance[b] - distance[a] + 192
            unseen = 2 * (counts[a] == 0) + (counts[b] == 0)
            met = tuple(link.round[x][c] > 0 for x in corners for c in (a, b))
            sizes = (many(a), many(b))
            s = [sums[c] for c in (a, b)]
            if self.wrong == "plane takes S as distance does":
                s = [sums[c] if counts[c] else [-x for x in everything] for c in (a, b)]
            normal = [p - q for p, q in zip(*s)]
            along = dot(normal, middle)
            cosine = log(one_more_square(normal)) + log(one_more_square(middle))
            t = 7 - clamp(quotient(cosine - log(along * along), 40), 0, 7)
            side = 7 - t if along < 0 else 8 + t
            if stream.mixed(
                ("label", place),
                ("coarse", place, clamp(d >> 5, 0, 11), (shared[a] - shared[b] + 9) // 4, unseen),
                ("fine", place, clamp(d >> 4, 0, 23), sizes),
                ("corners", place, met),
                ("plane", place, side, sizes),
            ):
                return a
        return order[-1]
