#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""dense_points.py POINTS OUT [--step-mm 0.1] [--turn-deg 1]

Puts points on the lines of a plain path (x y z i j k feed per line, as `meridian cl` writes it): tip on the line, tool
axis on the great circle. The outside checker of recordings looks for its place at five points of each line. Where these
are farther apart than another line is away it takes up that one: a rapid that passes, or the way there where the way back
leaves at a sharp angle.
"""
import argparse
import math


def turned(a, b, part):
    cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    angle = math.atan2(math.sqrt(sum(c * c for c in cross)), sum(x * y for x, y in zip(a, b)))
    if angle < 1e-12:
        return b
    p, q = math.sin((1 - part) * angle) / math.sin(angle), math.sin(part * angle) / math.sin(angle)
    return [p * x + q * y for x, y in zip(a, b)]


def angle_deg(a, b):
    cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    return math.degrees(math.atan2(math.sqrt(sum(c * c for c in cross)), sum(x * y for x, y in zip(a, b))))


def main():
    ap = argparse.ArgumentParser()
    ap.add_argument("points"), ap.add_argument("out")
    ap.add_argument("--step-mm", type=float, default=0.1), ap.add_argument("--turn-deg", type=float, default=1.0)
    arg = ap.parse_args()
    last = None
    with open(arg.points) as points, open(arg.out, "w") as out:
        for text in points:
            row = [float(x) for x in text.split()]
            if last is not None:
                parts = max(1, math.ceil(math.dist(last[:3], row[:3]) / arg.step_mm),
                            math.ceil(angle_deg(last[3:6], row[3:6]) / arg.turn_deg))
                for n in range(1, parts):
                    tip = [x + (y - x) * n / parts for x, y in zip(last[:3], row[:3])]
                    axis = turned(last[3:6], row[3:6], n / parts)
                    print(*(repr(x) for x in tip + axis), repr(row[6]), file=out)
            print(text.strip(), file=out)
            last = row


if __name__ == "__main__":
    main()
