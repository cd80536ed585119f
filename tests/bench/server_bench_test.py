#!/usr/bin/env python3
"""The table that server_bench.py writes, from figures made up."""
import server_bench as bench


def result(ratio):
    """Five rounds in which qtet-server has `ratio` of nginx's figures."""
    rounds = [((1000 * ratio, 500 * ratio), (1000, 500))] * 5
    return {"congestion": "reno", "rounds": {name: rounds for name, *_ in bench.ROWS}}


def document(date, ratio, earlier=None, other_day=None):
    missed = []
    rows = bench.place_table("veth", result(ratio), 10**7, earlier or {}, missed)
    more = f"Another day is the run of {other_day}." if other_day else ""
    head = f"Measured on {date} at `abc`. {more}"
    return "\n".join([bench.BEGIN, head, *rows, bench.END]), missed


def test():
    first, missed = document("2026-01-01", 1.01)
    assert not missed, missed
    assert "| none |" in first
    # the run of another day is what stood there; on the same day it stays
    earlier, day = bench.earlier_runs(first, "2026-01-02")
    assert day == "2026-01-01" and earlier["veth", "JSON"] == 1.01
    second, _ = document("2026-01-02", 0.93, earlier, day)
    assert "| 1.01 |" in second, second
    assert bench.earlier_runs(second, "2026-01-02") == (earlier, day)
    # too far away
    third, missed = document("2026-01-02", 0.9, earlier, day)
    assert "| 1.01, differs |" in third, third
    assert bench.earlier_runs(third, "2026-01-02") == (earlier, day)
    # one line for each row with an aim above the figure
    assert len(missed) == sum(row[-1] is not None for row in bench.ROWS)
    assert missed[0] == "JSON 0.90 of 1.0"
    assert bench.verdict(None) != bench.verdict([])


test()
