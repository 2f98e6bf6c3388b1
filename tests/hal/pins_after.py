#!/usr/bin/env python3
"""pins_after.py SAMPLES MAX_MS MAX_LINEAR MAX_ROTARY: what HAL's sampler saw after something was done to the machine.

One line of SAMPLES is one period of HAL's servo thread: its length in ns, mark before and after the deed, power, and the velocities
commanded to three linear (mm/s) and two rotary joints (deg/s). Prints for how long a joint moved after the deed began and the
largest acceleration over 5 ms (a busy host makes periods of microseconds behind a late one); exit code 1 where it moved for longer than MAX_MS (plus the time that the deed
itself took; 0: any time) or harder than these limits (mm/s2, deg/s2).
"""
import collections
import sys

LINEAR, ROTARY = slice(4, 7), slice(7, 9)
WINDOW_s = 0.005


def rows(path):
    for line in open(path):
        words = line.split()
        if len(words) == 9:
            yield [float(word) for word in words]


def main(path, max_ms, max_linear, max_rotary):
    time = begin = end = last = None
    kept, hardest, fastest, longest = collections.deque(), [0.0, 0.0], 0.0, 0.0
    for row in rows(path):
        dt = 1e-9 * row[0]
        time = dt if time is None else time + dt
        if row[1] and begin is None:
            begin = time
        if row[2] and end is None:
            end = time
        kept.append((time, row))
        while len(kept) > 2 and time - kept[1][0] >= WINDOW_s:
            kept.popleft()
        since, then = kept[0]
        if time - since >= WINDOW_s:
            for kind, part in enumerate((LINEAR, ROTARY)):
                steps = [abs(a - b) / (time - since) for a, b in zip(row[part], then[part])]
                hardest[kind] = max(hardest[kind], *steps)
        if begin is not None:
            longest = max(longest, dt)
            if any(abs(v) > 1e-6 for v in row[4:]):
                last = time
        else:
            fastest = max(abs(v) for v in row[LINEAR])
    if begin is None or end is None:
        sys.exit("the sampler missed the mark")
    moved_ms, deed_ms = 1e3 * ((last or begin) - begin), 1e3 * (end - begin)
    print(f"from {fastest:.1f} mm/s; moved for {moved_ms:.1f} ms (the deed took {deed_ms:.1f}); at most {hardest[0]:.0f} mm/s2, "
          f"{hardest[1]:.0f} deg/s2; longest period {1e3 * longest:.2f} ms")
    is_late = max_ms > 0 and moved_ms > max_ms + deed_ms
    sys.exit(1 if is_late or fastest < 1 or hardest[0] > max_linear or hardest[1] > max_rotary else 0)


main(sys.argv[1], *(float(word) for word in sys.argv[2:5]))
