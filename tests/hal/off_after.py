#!/usr/bin/env python3
"""off_after.py SAMPLES MAX_MS: for how long a pin stayed true after something was done to the machine.

One line of SAMPLES is one period of HAL's servo thread: its length in ns, mark before and after the deed, the pin. Prints the time
from the begin of the deed to the last period in which the pin is true; exit code 1 where that is more than MAX_MS and the time that
the deed itself took and the longest period since, or where the pin was not true before.
"""
import sys


def main(path, max_ms):
    time = longest = 0.0
    begin = end = last = None
    was_true = False
    for line in open(path):
        if len(line.split()) < 4:  # an overrun of the sampler
            continue
        words = [float(word) for word in line.split()]
        time += 1e-6 * words[0]
        if begin is None and not words[1]:
            was_true = bool(words[3])
            continue
        begin = time if begin is None else begin
        longest = max(longest, 1e-6 * words[0])
        if words[2] and end is None:
            end = time
        if words[3]:
            last = time
    if begin is None or end is None:
        sys.exit("the sampler missed the mark")
    on_ms, deed_ms = (last or begin) - begin, end - begin
    print(f"on for {on_ms:.1f} ms (the deed took {deed_ms:.1f}, longest period {longest:.2f} ms)")
    sys.exit(0 if was_true and on_ms <= max_ms + deed_ms + longest else 1)


main(sys.argv[1], float(sys.argv[2]))
