# SPDX-License-Identifier: Apache-2.0
"""Distributions, recordings and tables."""
import csv
import math


def percentile(values, share):
    """The smallest value that `share` of all are not above."""
    ordered = sorted(values)
    return ordered[max(0, math.ceil(share * len(ordered)) - 1)] if ordered else float("nan")


def spread(values):
    return {"n": len(values), "p50": percentile(values, 0.5), "p99": percentile(values, 0.99),
            "p999": percentile(values, 0.999), "max": max(values, default=float("nan"))}


MOVING = ("approaching", "running", "starving", "jogging", "homing")


class Recording:
    """The columns of a service's recording that stops are checked by."""

    def __init__(self, file):
        self.due_ns, self.state, self.rate, self.flags, self.cycle = [], [], [], [], []
        self.speed = []
        with open(file, newline="") as rows:
            reader = csv.reader(rows)
            head = next(reader, None)
            if head is None:
                return
            at = {name: head.index(name) for name in
                  ("cycle", "due_ns", "state", "rate", "flags")}
            speeds = [i for i, name in enumerate(head) if name.endswith("_per_s")]
            for row in reader:
                if len(row) < len(head):
                    continue  # torn: the service was killed
                self.cycle.append(int(row[at["cycle"]]))
                self.due_ns.append(int(row[at["due_ns"]]))
                self.state.append(row[at["state"]])
                self.rate.append(float(row[at["rate"]]))
                self.flags.append(int(row[at["flags"]]))
                self.speed.append(math.sqrt(sum(float(row[i]) ** 2 for i in speeds)))

    def first_after(self, ns):
        low, high = 0, len(self.due_ns)
        while low < high:
            middle = (low + high) // 2
            if self.due_ns[middle] < ns:
                low = middle + 1
            else:
                high = middle
        return low

    def stop_after(self, written_ns, limit_ns, states):
        """Of a stop that was written then: (ms until a row of `states`, ms until the first slower
        setpoint, executed cycles between both). None where the machine goes on for longer than the
        limit, () where it is at rest then for another reason."""
        i = self.first_after(written_ns)
        if i == len(self.due_ns):
            return None
        before = self.state[max(0, i - 1)]
        while i < len(self.due_ns) and self.due_ns[i] < written_ns + limit_ns:
            if self.state[i] in states and self.state[i] != before:
                break
            i += 1
        else:
            # At rest by then, by a fault or since before: there was nothing to stop.
            last = min(i, len(self.due_ns) - 1)
            is_moving = self.state[last] in MOVING or self.flags[last] & 2
            return None if is_moving else ()
        seen = i
        seen_ms = 1e-6 * (self.due_ns[seen] - written_ns)
        moved = self.flags[max(0, seen - 1)] & 2
        if not moved:
            return seen_ms, seen_ms, 0
        # The first setpoint of the stop is the first that leaves the rate in force: where a stop
        # finds the axes speeding up, their jerk limits let the speed itself grow a little more.
        last = max(1, seen - 1)
        values = self.rate if before in ("running", "approaching", "starving") else self.speed
        slope = values[last] - values[last - 1]
        while i < len(self.due_ns) and i - seen <= 500 and \
                abs(values[i] - values[last] - (i - last) * slope) < 1e-7:
            i += 1
        return seen_ms, 1e-6 * (self.due_ns[min(i, len(self.due_ns) - 1)] - written_ns), i - seen


def table(head, rows):
    """A Markdown table."""
    def text(value):
        return f"{value:.2f}" if isinstance(value, float) else str(value)
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(text(value) for value in row) + " |" for row in rows]
    return "\n".join(lines)
