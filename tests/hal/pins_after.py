#!/usr/bin/env python3
"""pins_after.py SAMPLES STALLED_MS MAX_MS MAX_LINEAR MAX_ROTARY: what HAL's sampler saw after something was done to the machine.

One line of SAMPLES is one period of HAL's servo thread: its length in ns, mark before and after the deed, power, and the velocities
commanded to three linear (mm/s) and two rotary joints (deg/s). STALLED_MS: the latest wake-up that stall_watch.py saw meanwhile.
Prints for how long a joint moved after the deed began and the largest acceleration over 5 ms (a busy host makes periods of
microseconds after a late one).

Exit code 1: a joint moved for longer than MAX_MS (plus the time that the deed itself took; 0: any time) or harder than these limits
(mm/s2, deg/s2). 2: the run is void: samples are lost, the host stalled, the move was at its end, or a promise was broken on a host that is
crowded, where a thread may wait for its processor while others do not, or after a stall that HAL catches up with: at nine eighths of the pace.
"""
import collections
import os
import sys

LINEAR, ROTARY = slice(4, 7), slice(7, 9)
WINDOW_s = 0.005
STALL_ms = 20  # of 50 ms of bridge
CATCHING_UP_ms = 3  # HAL goes on by two periods at most
SPEED = 140  # mm/s, of 151 in the middle of the move
CROWD = 2  # processes that want to run, for each processor
FINE, BROKEN, VOID = 0, 1, 2


def rows(lines):
    """The periods that were sampled; None where the sampler lost some. Its last line may be cut off."""
    for line in lines:
        words = line.split()
        if words == ["overrun"]:
            yield None
        elif len(words) == 9:
            yield [float(word) for word in words]


class Seen:
    """What the samples show."""

    def __init__(self, lines):
        self.begin = self.end = self.last = None
        self.fastest = self.longest_s = 0.0
        self.hardest = [0.0, 0.0]
        self.is_whole = True
        time, kept = 0.0, collections.deque()
        for row in rows(lines):
            if row is None:  # halsampler says so ahead of its first line too, which is not its first sample
                self.is_whole = self.begin is None
                continue
            time += 1e-9 * row[0]
            self.mark(time, row)
            kept.append((time, row))
            while len(kept) > 2 and time - kept[1][0] >= WINDOW_s:
                kept.popleft()
            self.accelerate(*kept[0], time, row)

    def mark(self, time, row):
        if row[1] and self.begin is None:
            self.begin = time
        if row[2] and self.end is None:
            self.end = time
        if self.begin is None:
            self.fastest = max(abs(v) for v in row[LINEAR])
            return
        self.longest_s = max(self.longest_s, 1e-9 * row[0])
        if any(abs(v) > 1e-6 for v in row[4:]):
            self.last = time

    def accelerate(self, since, then, time, row):
        if time - since < WINDOW_s:
            return
        for kind, part in enumerate((LINEAR, ROTARY)):
            steps = [abs(a - b) / (time - since) for a, b in zip(row[part], then[part])]
            self.hardest[kind] = max(self.hardest[kind], *steps)


def check(lines, stalled_ms, crowd, max_ms, max_linear, max_rotary):
    """An exit code, and what was seen in words."""
    seen = Seen(lines)
    if seen.begin is None or seen.end is None or not seen.is_whole:
        return VOID, "the sampler lost samples"
    period_ms = 1e3 * seen.longest_s
    moved_ms, deed_ms = 1e3 * ((seen.last or seen.begin) - seen.begin), 1e3 * (seen.end - seen.begin)
    words = (f"from {seen.fastest:.1f} mm/s; moved for {moved_ms:.1f} ms (the deed took {deed_ms:.1f}); "
             f"at most {seen.hardest[0]:.0f} mm/s2, {seen.hardest[1]:.0f} deg/s2; longest period {period_ms:.2f} ms, "
             f"latest wake-up {stalled_ms:.1f} ms")
    stall_ms = max(period_ms, stalled_ms)
    if stall_ms > STALL_ms or seen.fastest < SPEED:
        return VOID, words
    is_late = max_ms > 0 and moved_ms > max_ms + deed_ms
    if not is_late and seen.hardest[0] <= max_linear and seen.hardest[1] <= max_rotary:
        return FINE, words
    return (VOID if crowd > CROWD or stall_ms > CATCHING_UP_ms else BROKEN), words


if __name__ == "__main__":
    with open(sys.argv[1], encoding="ascii") as samples:
        stalled_ms, *limits = (float(word) for word in sys.argv[2:6])
        code, said = check(samples, stalled_ms, os.getloadavg()[0] / os.cpu_count(), *limits)
    print(said)
    sys.exit(code)
