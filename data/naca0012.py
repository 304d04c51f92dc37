#!/usr/bin/python3
"""Writes a NACA 0012 wing section of 38 NURBS surfaces as IGES, entities 126 and 128 only.

The section lies in the (x, z) plane, chord 3 from x = 0 to x = 3, and runs along y to 1.5. The half thickness of
a section of chord 1 is

    z(x) = 0.6 (0.2969 sqrt(x) - 0.1260 x - 0.3516 x^2 + 0.2843 x^3 - 0.1036 x^4)

With s = sqrt(x) this is a polynomial of degree 8 in s, and x = s^2. Every patch is therefore the exact curve,
a Bezier curve of degree 8 in s, and not a fit: its poles are computed in rational numbers and rounded once,
so that neighbours share their border bit for bit. The leading edge (s = 0) is smooth: the two sides meet there
with the same tangent and curvature.

Patches: sharp trailing edge: 10 above, 9 below, twice along the span. Blunt (-0.1015 for -0.1036, 0.00252 of the chord thick):
9 above, 9 below and the base, twice along the span. Normals (dS/du x dS/dv) point out of the wing.
Each border is written once, as a curve of its own, flagged as construction geometry: it is no part of the model
beside the surfaces.
"""

import argparse
from fractions import Fraction
from math import comb

from iges import CONSTRUCTION, IgesFile

DEGREE = 8
CHORD = 3
SPAN = 1.5
SPAN_PATCHES = 2
LAST_COEFFICIENT = {"sharp": Fraction("-0.1036"), "blunt": Fraction("-0.1015")}


def thickness_coefficients(trailing_edge):
    """Coefficients of the half thickness in powers of s = sqrt(x), exactly."""
    coefficients = [Fraction(0)] * (DEGREE + 1)
    for power, value in ((1, "0.2969"), (2, "-0.1260"), (4, "-0.3516"), (6, "0.2843")):
        coefficients[power] = Fraction("0.6") * Fraction(value)
    coefficients[8] = Fraction("0.6") * LAST_COEFFICIENT[trailing_edge]
    return coefficients


def half_thickness(x, trailing_edge="sharp"):
    """Half thickness at 0 <= x <= 1 of a section of chord 1, in doubles: what meshes and tests need."""
    s = x**0.5
    return sum(float(c) * s**k for k, c in enumerate(thickness_coefficients(trailing_edge)))


def bezier_poles(coefficients, first, last):
    """Bezier poles on [first, last] of the polynomial with these power coefficients, exactly."""
    degree = len(coefficients) - 1
    width = last - first
    local = [sum(coefficients[k] * comb(k, j) * first ** (k - j) for k in range(j, degree + 1)) * width**j
             for j in range(degree + 1)]
    return [sum(local[j] * Fraction(comb(i, j), comb(degree, j)) for j in range(i + 1)) for i in range(degree + 1)]


def side(trailing_edge, count, sign):
    """Poles (x, z) of the patches of one side, from the leading edge (s = 0) to the trailing edge (s = 1)."""
    z = [sign * c for c in thickness_coefficients(trailing_edge)]
    x = [Fraction(0)] * (DEGREE + 1)
    x[2] = Fraction(1)
    stations = [Fraction(i, count) for i in range(count + 1)]
    return [list(zip(bezier_poles(x, a, b), bezier_poles(z, a, b))) for a, b in zip(stations, stations[1:])]


def section(trailing_edge):
    """The section's curves in order, from the trailing edge along the lower side, round the nose and back."""
    lower = side(trailing_edge, 9, -1)
    upper = side(trailing_edge, 10 if trailing_edge == "sharp" else 9, 1)
    curves = [poles[::-1] for poles in lower[::-1]] + upper
    if trailing_edge == "blunt":
        curves.append([curves[-1][-1], curves[0][0]])
    return curves


def clamped(degree):
    return [0.0] * (degree + 1) + [1.0] * (degree + 1)


def write(path, trailing_edge, chord, span):
    file = IgesFile(path.rsplit("/", 1)[-1], f"NACA 0012 section, {trailing_edge} trailing edge, 38 NURBS surfaces")
    curves = section(trailing_edge)
    stations = [float(span) * j / SPAN_PATCHES for j in range(SPAN_PATCHES + 1)]

    def lifted(curve, y):
        return [(float(chord * x), y, float(chord * z)) for x, z in curve]

    for y0, y1 in zip(stations, stations[1:]):
        for curve in curves:
            degree = len(curve) - 1
            file.surface((degree, 1), clamped(degree), clamped(1), [lifted(curve, y0), lifted(curve, y1)])
    for y in stations:
        for curve in curves:
            file.curve(len(curve) - 1, clamped(len(curve) - 1), lifted(curve, y), planar_normal=(0, 1, 0),
                       use=CONSTRUCTION)
    for y0, y1 in zip(stations, stations[1:]):
        for curve in curves:
            file.curve(1, clamped(1), lifted(curve[:1], y0) + lifted(curve[:1], y1), use=CONSTRUCTION)
    file.write(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--trailing-edge", choices=sorted(LAST_COEFFICIENT), default="sharp")
    parser.add_argument("--chord", type=Fraction, default=Fraction(CHORD), help="length along x (default %(default)s)")
    parser.add_argument("--span", type=float, default=SPAN, help="length along y (default %(default)s)")
    parser.add_argument("output", help="the .igs file")
    arguments = parser.parse_args()
    write(arguments.output, arguments.trailing_edge, arguments.chord, arguments.span)


if __name__ == "__main__":
    main()
