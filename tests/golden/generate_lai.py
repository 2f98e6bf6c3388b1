#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Golden data of the Lai machine, from its corrected Denavit-Hartenberg table.

  generate_lai.py            writes lai_pose.csv, lai_jacobian.csv and lai_path.csv beside this file
  generate_lai.py --check    says whether the files are what it would write (exit 1 if not, 77 without mpmath)

Nothing here is a closed form of the machine: poses are products of the link matrices of the table
(docs/kinematics.md, table 2.1), the Jacobian and the derivatives along a path are differentiated
numerically, and inverse solutions are found by Newton's method on the matrix product, all with 60
digits. Inputs are doubles, taken exactly; outputs are printed with 17 significant digits. Debian:
python3-mpmath.
"""
import random

from golden_files import table, write_or_check
from mpmath import mp, mpf, matrix

mp.dps = 60
CONSTANTS = ["b1", "a2", "a3", "l3", "l4", "b5", "l5", "lt"]
JOINTS = ["b3_mm", "b2_mm", "b4_mm", "theta1_rad", "theta2_rad"]
POSE = ["x_mm", "y_mm", "z_mm", "i", "j", "k"]


def identity():
    return [[mpf(r == n) for n in range(4)] for r in range(4)]


def times(a, b):
    return [[sum((a[r][k] * b[k][n] for k in range(4) if a[r][k] and b[k][n]), mpf(0)) for n in range(4)] for r in range(4)]


def translate(axis, by):
    m = identity()
    m[axis][3] = mpf(by)
    return m


def rotate(axis, by):
    m = identity()
    p, q = (axis + 1) % 3, (axis + 2) % 3
    m[p][p] = m[q][q] = mp.cos(by)
    m[q][p] = mp.sin(by)
    m[p][q] = -m[q][p]
    return m


def link(b, theta, a, alpha, length):
    """L(1): Tz(b) Rz(theta) Tx(a) Rx(alpha) Tz(l)."""
    m = translate(2, b)
    for step in (rotate(2, theta), translate(0, a), rotate(0, alpha), translate(2, length)):
        m = times(m, step)
    return m


def pose(c, q):
    """Tip and tool axis: fourth and third column of the product of the corrected table."""
    b3, b2, b4, t1, t2 = q
    quarter = mp.pi / 2
    rows = [(-c["b1"], t1, 0, -quarter, 0), (b2, -quarter, c["a2"], -quarter, 0),
            (b3, quarter, c["a3"], quarter, c["l3"]), (-b4, quarter, 0, -quarter, -c["l4"]),
            (-c["b5"], t2, 0, quarter, -c["l5"]), (0, 0, 0, 0, -c["lt"])]
    m = identity()
    for row in rows:
        m = times(m, link(*row))
    return [m[0][3], m[1][3], m[2][3], m[0][2], m[1][2], m[2][2]]


def derivative(f, order, h=mpf(10)**-8):
    """Central differences of a list-valued f at 0: truncation of order h**4, 1e-32."""
    weights = {1: ((-2, 1), (-1, -8), (1, 8), (2, -1)), 2: ((-2, -1), (-1, 16), (0, -30), (1, 16), (2, -1)),
               3: ((-3, 1), (-2, -8), (-1, 13), (1, -13), (2, 8), (3, -1))}[order]
    scale = {1: 12 * h, 2: 12 * h**2, 3: 8 * h**3}[order]
    at = [(w, f(k * h)) for k, w in weights]
    return [sum(w * v[i] for w, v in at) / scale for i in range(len(at[0][1]))]


def jacobian(c, q):
    columns = [derivative(lambda t, n=n: pose(c, [x + (t if k == n else 0) for k, x in enumerate(q)]), 1)
               for n in range(5)]
    return [[columns[n][r] for n in range(5)] for r in range(6)]


def solve(c, want, q, slope=None):
    """Newton's method on all six rows of the pose, least squares, from joints nearby; with `slope`,
    the Jacobian there, it is not computed anew in every step."""
    q = list(q)
    for _ in range(60):
        error = [a - b for a, b in zip(want, pose(c, q))]
        j = matrix(slope or jacobian(c, q))
        step = mp.lu_solve(j.T * j, j.T * matrix(error))
        q = [a + b for a, b in zip(q, step)]
        if max(abs(x) for x in step) < mpf(10)**-50:
            return q
    raise ArithmeticError("Newton's method did not settle")


def number(x):
    if isinstance(x, str):
        return x
    if not isinstance(x, float) and abs(x) < mpf(10)**-30:  # a zero that was differentiated
        return "0.0"
    return repr(x) if isinstance(x, float) else mp.nstr(x, 17, strip_zeros=False, min_fixed=-3, max_fixed=6)


def exact(values):
    return [mpf(x) for x in values]


def poses(draw):
    """Random constants of either sign in every row; ordinary tilts, tilts near the pole, the pole itself."""
    kinds = ["random"] * 96 + ["near"] * 48 + ["pole"] * 8
    for n, kind in enumerate(kinds):
        c = [round(draw.uniform(-200, 200), 3) for _ in CONSTANTS]
        tilt = {"random": draw.choice((-1, 1)) * draw.uniform(0.02, 1.04),
                "near": (-1)**n * 10.0**-(1 + n % 12) * draw.uniform(0.5, 1), "pole": 0.0}[kind]
        q = [draw.uniform(-300, 300), draw.uniform(-300, 300), draw.uniform(-300, 300), draw.uniform(-3.14, 3.14), tilt]
        named = dict(zip(CONSTANTS, exact(c)))
        p = pose(named, exact(q))
        if kind == "random":  # the other branch: Newton from a rough guess of it
            e = named["a3"] + named["b5"] + named["l4"]
            guess = [-mpf(q[0]), 2 * e - q[1], mpf(q[2]), mpf(q[3]) + (mp.pi if q[3] < 0 else -mp.pi), mpf("0.001") - q[4]]
            alt = solve(named, p, guess, jacobian(named, guess))
        else:
            alt = [""] * 5
        yield [kind] + c + q + p + alt


def jacobians(draw):
    for _ in range(20):
        c = [round(draw.uniform(-200, 200), 3) for _ in CONSTANTS]
        q = [draw.uniform(-300, 300) for _ in range(3)] + [draw.uniform(-3.14, 3.14), draw.uniform(-1.04, 1.04)]
        j = jacobian(dict(zip(CONSTANTS, exact(c))), exact(q))
        jm = matrix(j)
        yield c + q + [x for row in j for x in row] + [mp.sqrt(mp.det(jm.T * jm))]


def paths(draw):
    """Joints and their first three derivatives along tip = p + v s, axis on a great circle, at s = 0."""
    for _ in range(20):
        c = [round(draw.uniform(-200, 200), 3) for _ in CONSTANTS]
        named = dict(zip(CONSTANTS, exact(c)))
        q = [draw.uniform(-300, 300) for _ in range(3)]
        q += [draw.uniform(-3.14, 3.14), draw.choice((-1, 1)) * draw.uniform(0.2, 1.0)]
        at = pose(named, exact(q))
        tip, axis = [float(x) for x in at[:3]], [float(x) for x in at[3:]]  # the path's own doubles
        slope = [draw.uniform(-1, 1) for _ in range(3)]
        side = [draw.uniform(-1, 1) for _ in range(3)]
        turn = draw.uniform(0.001, 0.02)  # rad per mm
        ax, sd = exact(axis), exact(side)
        norm = mp.sqrt(sum(x * x for x in ax))
        ax = [x / norm for x in ax]
        dot = sum(x * y for x, y in zip(ax, sd))
        sd = [y - dot * x for x, y in zip(ax, sd)]
        norm = mp.sqrt(sum(x * x for x in sd))
        sd = [float(x / norm) for x in sd]
        axis = [float(x) for x in ax]

        slope_there = jacobian(named, exact(q))

        def joints(s):
            k = [mp.cos(turn * s) * mpf(a) + mp.sin(turn * s) * mpf(b) for a, b in zip(axis, sd)]
            length = mp.sqrt(sum(x * x for x in k))
            want = [mpf(a) + mpf(b) * s for a, b in zip(tip, slope)] + [x / length for x in k]
            return solve(named, want, exact(q), slope_there)

        yield (c + tip + axis + slope + sd + [turn] + ["0" if q[4] > 0 else "1"] + joints(mpf(0))
               + [x for order in (1, 2, 3) for x in derivative(joints, order)])


def files():
    draw = random.Random(20240611)
    constants = [x + "_mm" for x in CONSTANTS]
    yield table("lai_pose.csv",
                ["Poses of the Lai machine; alt_ is the solution on the other branch (random rows).",
                 "near: theta2 within 1e-1 .. 1e-12 rad of the pole; pole: theta2 = 0."],
                ["kind"] + constants + JOINTS + POSE + ["alt_" + x for x in JOINTS], poses(draw), number)
    yield table("lai_jacobian.csv", ["Jacobian, row-major: rows x y z i j k, columns " + " ".join(JOINTS) + "; measure."],
                constants + JOINTS + [f"j{r}{n}" for r in range(6) for n in range(5)] + ["measure"], jacobians(draw), number)
    yield table("lai_path.csv",
                ["Joints and three derivatives by s at s = 0 of tip = (x, y, z) + (vx, vy, vz) s and",
                 "axis = cos(turn s) (i, j, k) + sin(turn s) (ni, nj, nk), on `branch`."],
                constants + POSE + ["vx", "vy", "vz", "ni", "nj", "nk", "turn_rad_per_mm", "branch"] + JOINTS
                + [f"d{order}_{x}" for order in (1, 2, 3) for x in JOINTS], paths(draw), number)


if __name__ == "__main__":
    write_or_check(files())
