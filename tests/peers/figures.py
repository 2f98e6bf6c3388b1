# SPDX-License-Identifier: Apache-2.0
"""What a recording did with its path, worked out here and by nothing of Meridian: tip and axis from the
joints of a trunnion table (C on B), differences of the joints over one, two and three periods against
their limits of velocity, acceleration and jerk.

Each setpoint is held against the point of the path that is nearest to its tip: the tip's distance from
the polyline of the CL points, the axis' angle from the great circle between their axes.
"""
import csv
import dataclasses

import numpy

JOINTS = "XYZCB"  # columns of a recording
CHUNK = 200       # setpoints, looked at together
AHEAD = 80        # segments, farther than the tip gets in them


@dataclasses.dataclass
class Figures:
    time_s: float
    tip_um: float
    axis_deg: float
    shares: dict  # joint: velocity, acceleration, jerk; 1 is the limit


def read(file):
    """Joints of the cut in mm and rad, a row per period, from rest to rest."""
    names = [f"{joint}_{'mm' if joint in 'XYZ' else 'rad'}" for joint in JOINTS]
    with open(file, encoding="ascii") as text:
        rows = [[float(row[name]) for name in names] for row in csv.DictReader(text)
                if row.get("kind") != "approach"]
    joints = numpy.array(rows)
    moving = numpy.flatnonzero(numpy.any(numpy.diff(joints, axis=0), axis=1))
    return joints[moving[0]:moving[-1] + 2]


def rates(machine, joints, period_s=0.001):
    """Velocity, acceleration and jerk of every joint as shares of their limits."""
    rows = numpy.array(joints)
    rows[:, 3:] = numpy.degrees(rows[:, 3:])
    limits = numpy.array([machine.limits(joint) for joint in JOINTS]).T
    return [numpy.diff(rows, n, axis=0) / period_s**n / limit for n, limit in enumerate(limits, 1)]


def poses(machine, joints):
    """Tips (mm) and axes in the workpiece."""
    x, y, z, c, b = joints.T

    def on_table(x, y, z):
        x, z = numpy.cos(b) * x - numpy.sin(b) * z, numpy.sin(b) * x + numpy.cos(b) * z
        return numpy.stack([numpy.cos(c) * x + numpy.sin(c) * y,
                            numpy.cos(c) * y - numpy.sin(c) * x, z], axis=1)

    tips = on_table(x, -y, z + machine.tip_at_home_mm - machine.pivot_mm)
    return tips + [0, 0, machine.pivot_mm], on_table(0 * x, 0 * x, 0 * x + 1)


def angles(a, b):
    return numpy.arctan2(numpy.linalg.norm(numpy.cross(a, b), axis=-1), (a * b).sum(-1))


def between(a, b, share):
    """On the great circle from a to b."""
    share, whole = share[:, None], angles(a, b)[:, None]
    is_turn = whole > 1e-9
    on_arc = numpy.sin((1 - share) * whole) * a + numpy.sin(share * whole) * b
    return numpy.where(is_turn, on_arc / numpy.where(is_turn, numpy.sin(whole), 1), a)


def deviations(points, tips, axes):
    """The farthest of every tip (mm) and axis (rad) from the path."""
    path, normal = points[:, :3], points[:, 3:6]
    tip_mm = axis_rad = 0.0
    first = 0
    for n in range(0, len(tips), CHUNK):
        tip, axis = tips[n:n + CHUNK], axes[n:n + CHUNK]
        last = min(first + AHEAD, len(path) - 1)
        begin, step = path[first:last], numpy.diff(path[first:last + 1], axis=0)
        square = numpy.maximum((step**2).sum(1), 1e-30)
        share = numpy.clip(((tip[:, None] - begin) * step).sum(2) / square, 0, 1)
        off = numpy.linalg.norm(tip[:, None] - begin - share[..., None] * step, axis=2)
        at, row = off.argmin(1), numpy.arange(len(tip))
        tip_mm = max(tip_mm, off[row, at].max())
        want = between(normal[first + at], normal[first + at + 1], share[row, at])
        axis_rad = max(axis_rad, angles(axis, want).max())
        first = max(first, min(first + at[-1], len(path) - 2) - 1)
    return tip_mm, axis_rad


def check(machine, points, joints):
    """Figures of the cut `joints` of the CL points `points` (x y z i j k feed)."""
    tip_mm, axis_rad = deviations(numpy.array(points), *poses(machine, joints))
    worst = [numpy.abs(rate).max(axis=0) for rate in rates(machine, joints)]
    return Figures((len(joints) - 1) / 1000, 1000 * tip_mm, numpy.degrees(axis_rad),
                   {joint: tuple(w[n] for w in worst) for n, joint in enumerate(JOINTS)})
