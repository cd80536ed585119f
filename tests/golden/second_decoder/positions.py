"""Where prey vertices lie ("Positions")."""
from conventions import G, clamp, log, one_more_square, quotient


class Positions:
    """A part of Mesh."""

    def read_points(self, stream, link, k, v, told):
        f = self.points[v]
        edges, sums = self.spread(v)
        sizes = [self.log_mean(q, edges) // 128 + self.shift for q in sums]
        sum_, count = [[0, 0, 0] for _ in range(5)], [0] * 5
        for x, w in enumerate(link.vertices):
            if w == G:
                continue
            labels = [c for c in range(k) if link.round[x][c]]
            owner = labels[0] if len(labels) == 1 else 4
            count[owner] += 1
            for a in range(3):
                sum_[owner][a] += int(link.offsets[x][a])
        divide = int.__floordiv__ if self.wrong == "X rounds down" else quotient
        mean = [[divide(s, max(n, 1)) for s in total] for total, n in zip(sum_, count)]
        distance = [log(one_more_square([float(x) for x in mean[i]])) for i in range(k)]
        order = sorted(range(k), key=lambda i: distance[i])
        r = min((distance[order[1]] - distance[order[0]]) // 32, 7)
        question = ("placement", k, link.has_ghost, r)
        if stream.bit(*question, 0):
            placement = "at prey"
        elif stream.bit(*question, 1):
            placement = "free"
        elif k > 2 or stream.bit(*question, 2):
            placement = "middle"
        else:
            placement = "quarter"
        near = None
        if placement in ("at prey", "quarter"):
            near = order[-1]
            by_k = k if self.wrong == "near is also by k" else 0
            for rank in range(k - 1):
                if stream.bit("near", by_k, placement, r, rank):
                    near = order[rank]
                    break
        self.placement, self.near = placement, near

        def predicted(*shares):
            half = 0 if self.wrong == "the quotient by 64 rounds down" else 32
            return [
                f[a] + (half + sum(weight * mean[i][a] for i, weight in shares) >> 6)
                for a in range(3)
            ]

        def coordinate(q, a, digits):
            shift = clamp(sizes[a] - digits, 0, 28)
            h = next(told)
            if shift == 0:
                return q + h
            start = q - (1 << shift - 1) + (h << shift)
            same = "any" if self.wrong == "f_a is not by placement" else placement
            if start <= f[a] < start + (1 << shift) and stream.bit("same", same, a):
                return f[a]
            return start + stream.raw(shift)

        def remainder(a, n):
            key = ("quarter", a) if n == 4 and placement == "quarter" else ("remainder", k, a)
            high = stream.bit(*key, 1) if n > 2 else 0
            low = 0 if n == 3 and high else stream.bit(*key, 2 + high)
            return 2 * high + low

        points = [None] * k
        if placement == "at prey":
            points[near] = f
            which, digits = [i for i in range(k) if i != near], 2
            guess = lambda i: predicted((i, 28), (4, 8), (near, -8))
        elif placement == "quarter":
            which, digits = [near], 4
            guess = lambda i: predicted((i, 6), (1 - i, -6))
        elif k == 2:
            which, digits = [0], 3
            guess = lambda i: predicted((0, 13), (1, -13))
        else:
            which, digits = list(range(k - 1)), 3
            guess = lambda i: predicted((i, 24))
        if self.wrong == "axes come before points":
            guesses = {i: guess(i) for i in which}
            for i in which:
                points[i] = [0, 0, 0]
            for a in range(3):
                for i in which:
                    points[i][a] = coordinate(guesses[i][a], a, digits)
        else:
            for i in which:
                q = guess(i)
                points[i] = [coordinate(q[a], a, digits) for a in range(3)]
        if placement == "quarter":
            points[1 - near] = [
                4 * f[a] - 3 * points[near][a] - 2 + remainder(a, 4) for a in range(3)
            ]
        elif placement != "at prey":
            last = []
            for a in range(3):
                rest = k * f[a] - sum(points[i][a] for i in range(k - 1))
                if placement == "middle":
                    last.append(rest + remainder(a, k))
                else:
                    size = stream.number("difference", a)
                    last.append(rest - size if size and stream.raw(1) else rest + size)
            points[k - 1] = last
        points = [tuple(p) for p in points]
        self.check_points(points)
        return points
