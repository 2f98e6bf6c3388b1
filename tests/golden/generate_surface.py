#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Golden data of NURBS surfaces and of cutters that touch them.

  generate_surface.py            writes surface_patch.csv beside this file
  generate_surface.py --check    says whether the file is what it would write (exit 1 if not, 77 without mpmath)

Independent of the code under test: points come from de Boor's corner cutting of the control net in
homogeneous coordinates, derivatives are differentiated numerically, principal curvatures are the
roots of det(II - k I) = 0, and the tip is found by letting the cutter's profile touch the tangent
plane: of all points of the corner circle the one that lies deepest along the normal, all with 60
digits. Inputs are doubles, taken exactly; outputs are printed with 17 significant digits. Debian:
python3-mpmath.
"""
import random

from golden_files import table, write_or_check
from mpmath import mp, mpf

mp.dps = 60
DEGREE_U, DEGREE_V = 3, 2
KNOTS_U = [0.0, 0.0, 0.0, 0.0, 0.375, 0.75, 0.75, 2.0, 2.0, 2.0, 2.0]
KNOTS_V = [-1.0, -0.5, 0.0, 0.5, 1.25, 1.5, 2.0]  # not clamped: the domain is 0 to 1.25
ROWS, COLUMNS = 7, 4


def net():
    draw = random.Random(7)
    return [[[draw.uniform(-3, 3) + 20 * i, draw.uniform(-3, 3) + 25 * j, draw.uniform(-12, 12),
              draw.uniform(0.5, 2)] for j in range(COLUMNS)] for i in range(ROWS)]


NET = net()


def cut_corners(knots, degree, points, t):
    """de Boor: the point of the curve of `points` at t."""
    s = max(i for i in range(degree, len(points)) if mpf(knots[i]) <= t and knots[i] < knots[i + 1])
    d = [list(points[s - degree + i]) for i in range(degree + 1)]
    for r in range(1, degree + 1):
        for j in range(degree, r - 1, -1):
            low, high = mpf(knots[j + s - degree]), mpf(knots[j + 1 + s - r])
            share = (t - low) / (high - low)
            d[j] = [(1 - share) * a + share * b for a, b in zip(d[j - 1], d[j])]
    return d[degree]


def surface(u, v):
    weighted = [[[mpf(p[3]) * mpf(x) for x in p[:3]] + [mpf(p[3])] for p in row] for row in NET]
    curve = [cut_corners(KNOTS_V, DEGREE_V, row, v) for row in weighted]
    x, y, z, w = cut_corners(KNOTS_U, DEGREE_U, curve, u)
    return [x / w, y / w, z / w]


def slope(f, t, h=mpf(10)**-12):
    """Central difference of fourth order: truncation 1e-48."""
    return [(a - 8 * b + 8 * c - d) / (12 * h)
            for a, b, c, d in zip(f(t - 2 * h), f(t - h), f(t + h), f(t + 2 * h))]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    n = mp.sqrt(dot(a, a))
    return [x / n for x in a]


def turned(a, axis, angle):
    c, s = mp.cos(angle), mp.sin(angle)
    return [c * x + s * y + (1 - c) * dot(axis, a) * z for x, y, z in zip(a, cross(axis, a), axis)]


def tip(contact, normal, axis, radius, corner):
    """The tip for which the deepest point of the cutter, against the normal, is the contact.

    A point of the corner's middle circle is (radius - corner) times a unit vector square to the
    axis, one corner radius above the tip; the cutter's point there is one corner radius further
    against the normal. Deepest is where that unit vector lies most against the normal."""
    first = unit(cross(axis, [0, 1, 0]))
    second = cross(axis, first)
    at = mp.atan2(-dot(second, normal), -dot(first, normal))
    out = [mp.cos(at) * a + mp.sin(at) * b for a, b in zip(first, second)]
    return [s + corner * n - (radius - corner) * o - corner * k
            for s, n, o, k in zip(contact, normal, out, axis)]


def rows():
    draw = random.Random(11)
    for n in range(40):
        u, v = draw.uniform(0.001, 1.999), draw.uniform(0.001, 1.249)
        if any(abs(u - k) < 1e-6 for k in KNOTS_U) or any(abs(v - k) < 1e-6 for k in KNOTS_V):
            continue  # a difference must not reach over a knot
        lead, tilt = draw.uniform(-0.5, 0.5), draw.uniform(-0.5, 0.5)
        corner = (5.0, 0.0, draw.uniform(0.2, 4.8))[n % 3]
        mu, mv = mpf(u), mpf(v)
        at = surface(mu, mv)
        du = slope(lambda t: surface(t, mv), mu)
        dv = slope(lambda t: surface(mu, t), mv)
        duu = slope(lambda t: slope(lambda s: surface(s, mv), t), mu)
        dvv = slope(lambda t: slope(lambda s: surface(mu, s), t), mv)
        duv = slope(lambda t: slope(lambda s: surface(s, t), mu), mv)
        normal = unit(cross(du, dv))
        e, f, g = dot(du, du), dot(du, dv), dot(dv, dv)
        l, m, n2 = dot(duu, normal), dot(duv, normal), dot(dvv, normal)
        a, b, c = e * g - f * f, -(e * n2 - 2 * f * m + g * l), l * n2 - m * m
        root = mp.sqrt(b * b - 4 * a * c)
        feed = unit(du)
        axis = turned(turned(normal, cross(normal, feed), mpf(lead)), feed, mpf(tilt))
        yield ([u, v] + at + du + dv + duu + duv + dvv + normal + [(-b - root) / (2 * a), (-b + root) / (2 * a)]
               + [lead, tilt, 10.0, corner] + axis + tip(at, normal, axis, mpf(5), mpf(corner)))


def number(x):
    return repr(x) if isinstance(x, float) else mp.nstr(x, 17, strip_zeros=False, min_fixed=-3, max_fixed=6)


def files():
    vectors = [a + b for a in ("s", "du", "dv", "duu", "duv", "dvv", "n") for b in "xyz"]
    columns = (["u", "v"] + vectors + ["k1", "k2", "lead", "tilt", "diameter", "corner"]
               + ["i", "j", "k", "tipx", "tipy", "tipz"])
    comments = ["A rational surface of degree 3 x 2: point, derivatives, unit normal, principal curvatures (1/mm);",
                "axis leant by lead and tilt (rad) from it, feed along u; tip of the cutter that touches. mm.",
                "net: " + ";".join(",".join(repr(x) for x in p) for row in NET for p in row),
                "knots_u: " + ",".join(repr(x) for x in KNOTS_U),
                "knots_v: " + ",".join(repr(x) for x in KNOTS_V)]
    yield table("surface_patch.csv", comments, columns, rows(), number)


if __name__ == "__main__":
    write_or_check(files())
