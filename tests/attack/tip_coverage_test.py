#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""tip_coverage.py finds what is skipped and what is cut again, and nothing else."""
import math
import pathlib
import tempfile
import unittest

import tip_coverage

FRAME = (20.0, -30.0, 50.0)
PART = """UNITS / MM
RAPID
GOTO / 0 , 0 , 10 $
, 0 , 0 , 1
FEDRAT / 1000 , MMPM
GOTO / 10 , 0 , 10
GOTO / 10 , 5 , 10
GOTO / 0 , 5 , 10
FINI
"""
CORNERS = {6: ((0, 0, 10), (10, 0, 10)), 7: ((10, 0, 10), (10, 5, 10)), 8: ((10, 5, 10), (0, 5, 10))}


def joints_of(tip, turn_rad=0.4, tilt_rad=0.3):
    """Docs/kinematics.md, 2.3, for an axis of that turn and tilt."""
    x, y, z = (p + f for p, f in zip(tip, FRAME))
    c, s, length = math.cos(turn_rad), math.sin(turn_rad), 250.0
    return (x * c + y * s + length * math.sin(tilt_rad), -x * s + y * c + 60.0,
            400.0 - z - length * math.cos(tilt_rad), turn_rad, tilt_rad)


class TipCoverage(unittest.TestCase):
    def account(self, pieces, ends=None):
        """`pieces`: [(line, from share, to share), ...] of each service."""
        with tempfile.TemporaryDirectory() as folder:
            part, watch = pathlib.Path(folder, "part"), pathlib.Path(folder, "watch")
            part.write_text(PART)
            rows, cycle = ["service,cycle,due_ns,line,flags,p0,p1,p2,p3,p4,p5"], 0
            for service, cuts in enumerate(pieces):
                for line, begin, end in cuts:
                    for n in range(101):
                        share = begin + (end - begin) * n / 100
                        tip = [a + (b - a) * share for a, b in zip(*CORNERS[line])]
                        cycle += 1
                        numbers = ",".join(f"{j:.9g}" for j in joints_of(tip))
                        rows.append(f"{service},{cycle},{cycle * 40_000_000},{line},3,{numbers},0")
            watch.write_text("\n".join(rows) + "\n")
            return tip_coverage.check(part, watch, FRAME, 110.0, ends)

    def test_a_part_in_one_piece_is_covered(self):
        account = self.account([[(6, 0, 1), (7, 0, 1), (8, 0, 1)]])
        self.assertEqual((account["lines"], account["skipped"], account["cut_again"]), (3, [], []))

    def test_the_line_that_the_machine_rested_in_may_be_cut_again(self):
        account = self.account([[(6, 0, 1), (7, 0, 0.5)], [(7, 0, 1), (8, 0, 1)]])
        self.assertEqual((account["skipped"], account["cut_again"]), ([], []))

    def test_a_plunge_is_what_every_approach_goes_down(self):
        self.assertTrue(tip_coverage.is_along((0.6, 0.0, 0.8), (6, 1, 8), (3, 1, 4)))
        self.assertFalse(tip_coverage.is_along((0.6, 0.0, 0.8), (6, 1, 8), (3, 1, 4.1)))
        self.assertFalse(tip_coverage.is_along((0.0, 0.0, 1.0), (0, 0, 10), (10, 0, 10)))

    def test_a_line_that_is_left_out_is_skipped(self):
        self.assertEqual([s[0] for s in self.account([[(6, 0, 1)], [(8, 0, 1)]])["skipped"]], [7])

    def test_half_a_line_that_is_left_out_is_skipped(self):
        account = self.account([[(6, 0, 1), (7, 0, 0.5)], [(8, 0, 1)]])
        self.assertEqual([s[0] for s in account["skipped"]], [7])

    def test_a_finished_line_before_it_may_not(self):
        account = self.account([[(6, 0, 1), (7, 0, 0.5)], [(6, 0, 1), (7, 0, 1), (8, 0, 1)]])
        self.assertEqual([c[0] for c in account["cut_again"]], [6])

    def test_of_a_killed_service_only_what_is_older_than_its_journal_counts(self):
        pieces = [[(6, 0, 1), (7, 0, 0.5)], [(6, 0, 1), (7, 0, 1), (8, 0, 1)]]
        self.assertEqual([c[0] for c in self.account(pieces, ["kill"])["cut_again"]], [6])

    def test_a_path_beside_the_line_covers_nothing(self):
        right = CORNERS[6]
        CORNERS[6] = ((0, 0.1, 10), (10, 0.1, 10))
        try:
            account = self.account([[(6, 0, 1)], [(7, 0, 1), (8, 0, 1)]])
        finally:
            CORNERS[6] = right
        self.assertEqual([s[0] for s in account["skipped"]], [6])


if __name__ == "__main__":
    unittest.main()
