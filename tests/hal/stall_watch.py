#!/usr/bin/env python3
"""stall_watch.py FILE: how late an ordinary process wakes up, until it is ended.

Sleeps for a millisecond at a time on every processor it may run on, in turn, and writes the latest wake-up in ms into FILE: a host
that took the processors away for so long has disturbed whatever ran beside this.
"""
import os
import signal
import sys
import time

PERIOD_s = 0.001


def main(path):
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    processors, latest = sorted(os.sched_getaffinity(0)), 0.0
    try:
        while True:
            for processor in processors:
                os.sched_setaffinity(0, {processor})
                due = time.monotonic() + PERIOD_s
                time.sleep(PERIOD_s)
                latest = max(latest, time.monotonic() - due)
    finally:
        with open(path, "w", encoding="ascii") as out:
            out.write(f"{1e3 * latest:.1f}\n")


if __name__ == "__main__":
    main(sys.argv[1])
