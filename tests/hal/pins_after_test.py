# SPDX-License-Identifier: Apache-2.0
"""What pins_after.py finds in samples that are made here, without HAL."""
import unittest

import pins_after

LIMITS = (100, 7500, 1500)  # ms, mm/s2, deg/s2


def samples(periods_ms=None, jump=0.0, speed=150.0):
    """0.1 s at `speed`, the deed, 50 ms of bridge and a ramp with 6000 mm/s2; `jump`: of the velocity at its begin."""
    lines = []
    for n in range(300):
        ramp = max(0.0, n - 150) * 6 + (jump if n > 150 else 0)
        v = max(0.0, speed - ramp)
        dt = 1e6 * (periods_ms or {}).get(n, 1.0)
        lines.append(f"{dt} {int(n >= 100)} {int(n >= 102)} 1 {v} {v} {v} {v / 5} {v / 5}\n")
    return lines


class PinsAfter(unittest.TestCase):
    def code(self, lines, stalled_ms=1.0, crowd=0.5, limits=LIMITS):
        return pins_after.check(lines, stalled_ms, crowd, *limits)[0]

    def test_a_stop_inside_its_promise_is_fine(self):
        self.assertEqual(self.code(samples()), pins_after.FINE)

    def test_half_of_a_limit_is_broken(self):
        for limits in ((30, 7500, 1500), (100, 3750, 1500), (100, 7500, 750)):
            self.assertEqual(self.code(samples(), limits=limits), pins_after.BROKEN, limits)

    def test_a_jump_at_the_begin_of_the_ramp_is_broken(self):
        self.assertEqual(self.code(samples(jump=60)), pins_after.BROKEN)

    def test_samples_that_are_lost_make_a_run_void(self):
        lines = samples(jump=60)
        self.assertEqual(self.code(lines[:200] + ["overrun\n"] + lines[210:]), pins_after.VOID)
        self.assertEqual(self.code(lines[:90]), pins_after.VOID, "the mark is missing")
        self.assertEqual(self.code(["overrun\n"] + samples()), pins_after.FINE, "the sampler began anew")

    def test_a_last_line_that_is_cut_off_is_none(self):
        self.assertEqual(self.code(samples() + ["1000000 1 1 1 0"]), pins_after.FINE)

    def test_a_host_that_stalled_makes_a_run_void(self):
        self.assertEqual(self.code(samples(jump=60), stalled_ms=25), pins_after.VOID)
        self.assertEqual(self.code(samples({160: 25}, jump=60)), pins_after.VOID)

    def test_a_crowded_host_proves_what_is_fine_alone(self):
        self.assertEqual(self.code(samples(), crowd=5), pins_after.FINE)
        self.assertEqual(self.code(samples(jump=60), crowd=5), pins_after.VOID)

    def test_what_is_caught_up_behind_a_stall_breaks_no_promise(self):
        self.assertEqual(self.code(samples(jump=60), stalled_ms=5), pins_after.VOID)
        self.assertEqual(self.code(samples(jump=60), stalled_ms=2), pins_after.BROKEN)

    def test_a_move_that_ended_makes_a_run_void(self):
        self.assertEqual(self.code(samples(speed=100)), pins_after.VOID)


if __name__ == "__main__":
    unittest.main()
