#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Golden data of chains, robots and actuator stages, without a closed form of any.

  generate_family.py            writes chain_pose.csv, robot_pose.csv and stage_pose.csv beside this file
  generate_family.py --check    says whether the files are what it would write (exit 1 if not, 77 without mpmath)

Chains: what each joint does to workpiece or tool is a 4x4 matrix about its axis as drawn; the workpiece's product is
inverted as a matrix. Robots: products of the elementary matrices of docs/kinematics.md, chapter 5. Stages: a slider stands
where its rod, or its slot, closes, found by Newton's method on the distance between slider and pin; the determinant is
differentiated numerically. 50 digits; inputs are short decimals, outputs have 17 significant digits. Debian:
python3-mpmath.
"""
import random

from golden_files import table, write_or_check
from mpmath import mp, mpf, matrix

mp.dps = 50
POSE = ["x_mm", "y_mm", "z_mm", "i", "j", "k"]


def text_of(x):
    return x if isinstance(x, str) else mp.nstr(mpf(x), 17, strip_zeros=True)


def decimal(draw, low, high, digits):
    return ("%%.%df" % digits) % draw.uniform(low, high)


def numbers(words):
    return [mpf(w) for w in words]


def unit(v):
    norm = mp.sqrt(sum(x * x for x in v))
    return [x / norm for x in v]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def shift(by):
    m = mp.eye(4)
    for i in range(3):
        m[i, 3] = by[i]
    return m


def turn(axis, angle):
    """Column by column: what the axis does to each base vector."""
    m = mp.eye(4)
    for i in range(3):
        e = [mpf(i == n) for n in range(3)]
        along = [x * dot(axis, e) for x in axis]
        across = [x - y for x, y in zip(e, along)]
        side = cross(axis, e)
        for n in range(3):
            m[n, i] = along[n] + mp.cos(angle) * across[n] + mp.sin(angle) * side[n]
    return m


def turn_about(axis, point, angle):
    return shift(point) * turn(axis, angle) * shift([-x for x in point])


def pose_of(m, tip, axis):
    p, k = m * matrix(tip + [1]), m * matrix(axis + [0])
    return [p[0], p[1], p[2], k[0], k[1], k[2]]


def chains(draw):
    count = 0
    while count < 60:
        kinds = ["rotary", "rotary", "linear", "linear", "linear"]
        draw.shuffle(kinds)
        tables = draw.randrange(6)  # so many stand on the workpiece's side
        words, q = [], []
        directions, points = [], []
        for kind in kinds:
            directions.append([decimal(draw, -1, 1, 2) for _ in range(3)])
            points.append([decimal(draw, -300, 300, 1) for _ in range(3)])
            q.append(decimal(draw, -400, 400, 3) if kind == "linear" else decimal(draw, -3, 3, 6))
        axis, gauge = [decimal(draw, -1, 1, 2) for _ in range(3)], [decimal(draw, -300, 300, 1) for _ in range(3)]
        tool = decimal(draw, 0, 200, 1)
        units = [unit(numbers(d)) for d in directions]
        k0 = unit(numbers(axis))
        slides = [u for u, kind in zip(units, kinds) if kind == "linear"]
        swivels = [u for u, kind in zip(units, kinds) if kind == "rotary"]
        if abs(dot(slides[0], cross(slides[1], slides[2]))) < 0.3:
            continue
        if abs(dot(*swivels)) > 0.9 or abs(dot(swivels[1], k0)) > 0.9:
            continue
        workpiece, head = mp.eye(4), mp.eye(4)
        for n, kind in enumerate(kinds):
            by = mpf(q[n])
            m = shift([x * by for x in units[n]]) if kind == "linear" else turn_about(units[n], numbers(points[n]), by)
            if n < tables:
                workpiece = m * workpiece  # what comes later carries what came before
            else:
                head = head * m
        tip0 = [g - mpf(tool) * k for g, k in zip(numbers(gauge), k0)]
        at = pose_of(workpiece ** -1 * head, tip0, k0)
        for n, kind in enumerate(kinds):
            words += [kind, "table" if n < tables else "head"] + directions[n] + points[n] + [q[n]]
        yield words + axis + gauge + [tool] + at
        count += 1


def robots(draw):
    ex, ey, ez = [mpf(1), mpf(0), mpf(0)], [mpf(0), mpf(1), mpf(0)], [mpf(0), mpf(0), mpf(1)]
    up = [-y for y in ey]  # E(t) = Ry(-t)
    for n in range(80):
        has_six = n % 2 == 1
        a, b, c, wrist, tool = (decimal(draw, low, high, 1) for low, high in
                                ((0, 500), (300, 900), (300, 900), (0, 150), (20, 200)))
        q = [decimal(draw, -3, 3, 6), decimal(draw, -1.5, 2.5, 6), decimal(draw, 0.2, 2.8, 6), decimal(draw, -3, 3, 6),
             decimal(draw, -1.4, 1.4, 6), decimal(draw, -3, 3, 6) if has_six else "0"]
        if abs(float(q[4])) < 0.05:
            q[4] = "0.3"
        if draw.random() < 0.5:
            q[2] = "-" + q[2]
        t = numbers(q)
        m = turn(ez, t[0]) * shift([0, 0, mpf(a)]) * turn(up, t[1]) * shift([mpf(b), 0, 0]) * turn(up, t[2]) * shift([mpf(c), 0, 0])
        if has_six:
            m = m * turn(ex, t[3]) * turn(up, t[4]) * turn(ex, t[5])
        else:
            m = m * turn(up, t[3]) * turn(ez, t[4])
        m = m * shift([mpf(wrist) + mpf(tool), 0, 0])
        yield ["6" if has_six else "5", a, b, c, wrist, tool] + q + pose_of(m, [mpf(0)] * 3, [mpf(-1), mpf(0), mpf(0)])


def stages(draw):
    for n in range(90):
        kind = ["trailing", "scissor", "pin-slot"][n % 3]
        r, h = decimal(draw, 80, 200, 1), decimal(draw, 60, 200, 1)
        length = decimal(draw, float(r) + float(h) + 5, 700, 1)
        side = draw.choice(["1", "-1"])
        s, phi = decimal(draw, -300, 300, 3), decimal(draw, -0.8, 0.8, 6)
        if kind == "scissor":
            h = "0"
        sides = (mpf(side), mpf(side) if kind == "trailing" else -mpf(side))

        def slider(which, at_s, at_phi):
            sign = 1 - 2 * which  # slider 1 on the rail at +h, with the pin on that side
            pin = [at_s - sign * mpf(r) * mp.sin(at_phi), sign * mpf(r) * mp.cos(at_phi)]
            if kind == "pin-slot":  # the slider's pin is on the slot's line through the table's middle
                return mp.findroot(lambda u: (u - at_s) * mp.cos(at_phi) + sign * mpf(h) * mp.sin(at_phi), at_s)
            apart = lambda u: (pin[0] - u) ** 2 + (pin[1] - sign * mpf(h)) ** 2 - mpf(length) ** 2
            return mp.findroot(apart, pin[0] - sides[which] * mpf(length))

        u = [slider(k, mpf(s), mpf(phi)) for k in (0, 1)]
        by_phi = [mp.diff(lambda x: slider(k, mpf(s), x), mpf(phi)) for k in (0, 1)]
        yield [kind, r, h, length, side, s, phi] + u + [by_phi[1] - by_phi[0]]


def files():
    draw = random.Random(20241103)
    joint = ["kind", "side", "dx", "dy", "dz", "px_mm", "py_mm", "pz_mm", "q"]
    yield table("chain_pose.csv",
                ["Chains of random joints from the workpiece to the tool; q in mm or rad. Directions are to be normalised.",
                 "k: tool axis at home, g: gauge point at home; then the pose in the workpiece."],
                [f"{x}{n}" for n in range(1, 6) for x in joint] + ["kx", "ky", "kz", "gx_mm", "gy_mm", "gz_mm", "tool_mm"] + POSE,
                chains(draw), text_of)
    yield table("robot_pose.csv", ["Articulated robots with five or six joints, elbow up and down."],
                ["joints", "a_mm", "b_mm", "c_mm", "wrist_mm", "tool_mm"] + [f"q{n}_rad" for n in range(1, 7)] + POSE, robots(draw), text_of)
    yield table("stage_pose.csv", ["Actuator stages; side: of the first rod, +1 ahead of its slider.",
                                   "det = d(u1, u2)/d(s, phi), mm/rad."],
                ["kind", "radius_mm", "rail_mm", "rod_mm", "side", "s_mm", "phi_rad", "u1_mm", "u2_mm", "det"], stages(draw), text_of)


if __name__ == "__main__":
    write_or_check(files())
