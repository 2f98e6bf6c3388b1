# SPDX-License-Identifier: Apache-2.0
"""Joints side by side: a column for each control, a row for each joint, its velocity as a share of its
limit over the time of the cut, all on the same scales. SVG."""
import math

import numpy

from figures import JOINTS, rates

LEFT, TOP, WIDTH, HEIGHT, GAP = 40, 30, 350, 80, 16
POINTS = 350  # a column is drawn as lowest and highest of that many spans
STYLE = ("text{font:12px sans-serif;fill:#222}polyline{fill:none;stroke:#1f5fa8;stroke-width:1}"
         ".limit{stroke:#b03030;stroke-dasharray:4 3}.zero{stroke:#bbb}rect{fill:#fafafa;stroke:#ccc}")


def line(x1, y1, x2, y2, kind):
    return f'<line class="{kind}" x1="{x1:.0f}" y1="{y1:.1f}" x2="{x2:.0f}" y2="{y2:.1f}"/>'


def text(x, y, words):
    return f'<text x="{x:.0f}" y="{y:.0f}">{words}</text>'


def curve(left, top, highest, longest_s, share):
    """Lowest and highest of each span, so that no peak is lost."""
    spans = numpy.array_split(share, min(POINTS, len(share)))
    points, n = [], 0
    for span in spans:
        x = left + WIDTH * (n + len(span) / 2) / 1000 / longest_s
        n += len(span)
        points += [f"{x:.1f},{top + HEIGHT / 2 * (1 - value / highest):.1f}"
                   for value in ((span.min(), span.max()) if span.max() > span.min() else span[:1])]
    return f'<polyline points="{" ".join(points)}"/>'


def draw(file, title, machine, cuts):
    """`cuts`: name of the control and its joints."""
    velocities = [(name, rates(machine, joints)[0]) for name, joints in cuts]
    longest_s = max(len(velocity) for _, velocity in velocities) / 1000
    highest = max(1.1, 1.05 * max(numpy.abs(velocity).max() for _, velocity in velocities))
    width = LEFT + len(cuts) * (WIDTH + GAP)
    height = TOP + len(JOINTS) * (HEIGHT + GAP) + 20
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}">',
           f"<title>{title}</title>",
           f"<style>{STYLE}</style>", f'<rect width="{width}" height="{height}" style="fill:#fff"/>']
    for column, (name, velocity) in enumerate(velocities):
        left = LEFT + column * (WIDTH + GAP)
        out.append(text(left, TOP - 10, f"{name}: {len(velocity) / 1000:.2f} s"))
        for row, joint in enumerate(JOINTS):
            top = TOP + row * (HEIGHT + GAP)
            out.append(f'<rect x="{left}" y="{top}" width="{WIDTH}" height="{HEIGHT}"/>')
            for share, kind in ((1, "limit"), (0, "zero"), (-1, "limit")):
                at = top + HEIGHT / 2 * (1 - share / highest)
                out.append(line(left, at, left + WIDTH, at, kind))
            out.append(curve(left, top, highest, longest_s, velocity[:, row]))
            if column == 0:
                out.append(text(12, top + HEIGHT / 2 + 4, joint))
        step = 10 ** math.floor(math.log10(longest_s))
        for n in range(int(longest_s / step) + 1):
            out.append(text(left + WIDTH * n * step / longest_s - 3, height - 18, f"{n * step:g}"))
    out.append(text(LEFT, height - 3, "Velocity of each joint over time in s; dashed: its limit."))
    file.write_text("\n".join([*out, "</svg>", ""]), encoding="utf-8")
