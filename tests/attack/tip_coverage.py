#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Whether everything that was recorded of a part on the machine lai, in however many pieces, covers
the tip path that its CL file programs, and what of it was cut twice. Shares nothing with the
project: its own reading of GOTO statements, its own forward kinematics (docs/kinematics.md, 2.2).

    tests/attack/tip_coverage.py PART.apt WATCH.csv --frame 20,-30,50
WATCH.csv is what `attacker watch` writes.
"""
import argparse
import bisect
import csv
import math
import sys

# Machine lai: e = a3 + b5 + l4, h = l3 + a2 - b1, l = l5 + tool length.
E_MM, H_MM, L5_MM = 60.0, 400.0, 140.0
TOLERANCE_MM = 0.02     # corner rounding of 0.01, and as much for the numbers of the recording
END_MM = 0.05           # of a line's ends that rounding may leave out


def tip_of(joints, tool_mm, frame):
    b3, b2, b4, t1, t2 = joints[:5]
    length = L5_MM + tool_mm
    u, v = b3 - length * math.sin(t2), b2 - E_MM
    c, s = math.cos(t1), math.sin(t1)
    return (c * u - s * v - frame[0], s * u + c * v - frame[1],
            H_MM - b4 - length * math.cos(t2) - frame[2])


def is_along(axis, begin, end):
    """Whether a line leads along the tool axis, down or up."""
    length = math.dist(begin, end)
    cosine = sum(k * (b - a) / length for k, a, b in zip(axis, begin, end))
    return abs(cosine) > 1 - 1e-6


def read_part(file):
    """Cut lines: [(line, from, to, whether it plunges)], where rapids lead to is in the positions
    alone. A plunge goes along the tool axis, as every approach does."""
    lines, text, begin = [], "", 0
    at, axis, is_rapid = None, (0.0, 0.0, 1.0), False
    with open(file) as source:
        for number, raw in enumerate(source, 1):
            begin = begin if text else number
            text += raw.strip()
            if text.endswith("$"):
                text = text[:-1].rstrip().rstrip(",") + ","  # some CAM systems leave the comma away
                continue
            word, _, rest = text.replace(" ", "").partition("/")
            text = ""
            if word == "RAPID":
                is_rapid = True
            elif word == "GOTO":
                numbers = [float(x) for x in rest.split(",") if x]
                to, axis = tuple(numbers[:3]), tuple(numbers[3:6]) or axis
                if at is not None and not is_rapid and math.dist(at, to) > 1e-9:
                    lines.append((begin, at, to, is_along(axis, at, to)))
                at, is_rapid = to, False
    return lines


class Piece:
    """What one service sent between its begin and its end."""

    def __init__(self):
        self.line, self.tip, self.due_ns, self.cycle = [], [], [], []


def read_watch(file, tool_mm, frame):
    pieces = {}
    with open(file, newline="") as rows:
        for row in csv.DictReader(rows):
            try:
                joints = [float(row[f"p{i}"]) for i in range(5)]
                piece = pieces.setdefault(int(row["service"]), Piece())
                piece.cycle.append(int(row["cycle"]))
                piece.due_ns.append(int(row["due_ns"]))
                piece.line.append(int(row["line"]))
                piece.tip.append(tip_of(joints, tool_mm, frame))
            except (TypeError, ValueError):
                continue  # torn
    return [pieces[n] for n in sorted(pieces)]


def covered(piece, segment, before, after):
    """Intervals of a line, in mm from its begin, that a piece passed along, and when it last did.
    Rows of the lines before and after count too: corners are rounded."""
    line, begin, end, _ = segment
    length = math.dist(begin, end)
    direction = [(b - a) / length for a, b in zip(begin, end)]
    found, last_ns, previous = [], None, None
    for i, (row_line, tip) in enumerate(zip(piece.line, piece.tip)):
        if row_line not in (before, line, after):
            previous = None
            continue
        offset = [p - a for p, a in zip(tip, begin)]
        along = sum(o * w for o, w in zip(offset, direction))
        off = math.sqrt(max(0.0, sum(o * o for o in offset) - along * along))
        if off > TOLERANCE_MM or not -END_MM <= along <= length + END_MM:
            previous = None
            continue
        is_next = previous is not None and piece.cycle[i] - piece.cycle[i - 1] <= 60
        if is_next and row_line == line and along >= previous - 1e-9:
            found.append((previous, along))
            if along > previous + 1e-6:
                last_ns = piece.due_ns[i]
        previous = along
    return merge(found), last_ns


def merge(intervals):
    joined = []
    for begin, end in sorted(intervals):
        if joined and begin <= joined[-1][1] + 1e-6:
            joined[-1] = (joined[-1][0], max(joined[-1][1], end))
        else:
            joined.append((begin, end))
    return joined


def length_of(intervals):
    return sum(end - begin for begin, end in intervals)


def check(part, watch, frame, tool_mm=110.0, ends=None):
    """(faults, account): `ends` says of each piece how it ended: "kill" (the journal may be 1.5 s
    old) or anything else."""
    lines = read_part(part)
    pieces = [p for p in read_watch(watch, tool_mm, frame) if p.line]
    account = {"lines": len(lines), "pieces": len(pieces), "rows": sum(len(p.line) for p in pieces),
               "skipped": [], "cut_again": [], "resumed": 0}
    numbers = [line for line, *_ in lines]
    by_piece = []
    for piece in pieces:
        passed = {}
        present = set(piece.line)
        for k, segment in enumerate(lines):
            if segment[0] not in present:
                continue
            passed[segment[0]] = covered(piece, segment, numbers[k - 1] if k else 0,
                                         numbers[k + 1] if k + 1 < len(lines) else 0)
        by_piece.append(passed)
    for segment in lines:
        line, length = segment[0], math.dist(segment[1], segment[2])
        whole = merge([i for passed in by_piece for i in passed.get(line, ([], None))[0]])
        clipped = [(max(b, 0.0), min(e, length)) for b, e in whole]
        if length_of(clipped) < length - 2 * END_MM - 1e-3:
            account["skipped"].append((line, round(length - length_of(clipped), 3)))
    for k, passed in enumerate(by_piece):
        moved = {line: ns for line, (intervals, ns) in passed.items() if length_of(intervals) > END_MM}
        earlier = {}
        for j in range(k):
            for line, (intervals, ns) in by_piece[j].items():
                if length_of(intervals) > END_MM:
                    earlier.setdefault(line, []).append((j, ns))
        if k and moved:
            account["resumed"] += 1
        # The line that the machine rested in: the last that any earlier piece moved along.
        rested = max(earlier, default=0)
        for line in sorted(moved):
            segment = lines[bisect.bisect_left(numbers, line)]
            if line >= rested or line not in earlier or segment[3]:
                continue  # the approach to the line after a plunge goes down the same line
            j, ns = max(earlier[line], key=lambda one: one[1] or 0)
            kind = ends[j] if ends and j < len(ends) else ""
            late_ns = max(pieces[j].due_ns) - (ns or 0)
            if kind == "kill" and late_ns <= 1_500_000_000:
                continue
            finished = merge([i for p in by_piece[:k] for i in p.get(line, ([], None))[0]])
            if length_of(finished) >= math.dist(segment[1], segment[2]) - 2 * END_MM - 1e-3:
                account["cut_again"].append((line, k, rested))
    return account


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("part")
    parser.add_argument("watch")
    parser.add_argument("--frame", default="0,0,0")
    parser.add_argument("--tool-mm", type=float, default=110.0)
    arguments = parser.parse_args()
    frame = tuple(float(x) for x in arguments.frame.split(","))
    account = check(arguments.part, arguments.watch, frame, arguments.tool_mm)
    print(f"{account['lines']} lines, {account['pieces']} pieces, {account['rows']} setpoints; "
          f"skipped {account['skipped']}, finished and cut again {account['cut_again']}")
    return 1 if account["skipped"] or account["cut_again"] else 0


if __name__ == "__main__":
    sys.exit(main())
