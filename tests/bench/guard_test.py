#!/usr/bin/env python3
"""The rule of guard.py at its limits: slower means above 1.2 times and above 50 ms more."""

import unittest

import guard


class Guard(unittest.TestCase):
    def test_a_large_figure_may_take_exactly_the_ratio(self):
        self.assertFalse(guard.slower(10, 11.999))
        self.assertFalse(guard.slower(10, 12))
        self.assertTrue(guard.slower(10, 12.001))

    def test_a_small_figure_may_take_exactly_fifty_milliseconds_more(self):
        self.assertFalse(guard.slower(0.1, 0.149))
        self.assertFalse(guard.slower(0.1, 0.15))
        self.assertTrue(guard.slower(0.1, 0.151))

    def test_both_limits_meet_at_a_quarter_of_a_second(self):
        self.assertFalse(guard.slower(0.25, 0.3))
        self.assertTrue(guard.slower(0.25, 0.301))

    def test_what_became_faster_is_well(self):
        self.assertFalse(guard.slower(10, 1))
        self.assertFalse(guard.slower(1, 1))

    def test_the_least_of_each_is_compared(self):
        lines, well = guard.table({"one": ([1, 9, 9], [9, 9, 1.1])})
        self.assertTrue(well)
        self.assertEqual(lines[2], "| one | 1000.0 | 1100.0 | 1.10 |  |")

    def test_one_slow_figure_among_others_fails(self):
        lines, well = guard.table({"one": ([1], [2]), "other": ([1], [1])})
        self.assertFalse(well)
        self.assertIn("| 2.00 | slower |", lines[2])
        self.assertNotIn("slower", lines[3])


if __name__ == "__main__":
    unittest.main()
