#!/usr/bin/env python3
"""How far built hexapods spread along the nozzle's normal without gap control, to first order.

    scripts/open_loop_spread.py PROGRAM.gcode

Where the first bead of a program begins, for machine G4 (docs/reference.md#machine-g4): each strut's length is off by
the errors of both joints along it and of its zero, 0.04 mm each (`after_calibration` of the machine file), and the tip
by what these lengths give. Written out from the reference page, without Understudy.
"""
import re
import sys
from math import acos, cos, degrees, hypot, radians, sin, sqrt

BASE, PLATFORM, HEIGHT, JOINTS_ABOVE_TIP, DEVIATION = 80, 29, 256, 25, 15  # [mm]
TOLERANCE = 0.04  # [mm], 1 sigma of a joint's coordinate along the strut, and of a zero
STEP = 1e-4       # [mm] or [rad], of central differences


def circle(radius, half_angle, height):
    angles = [radians(120 * k + side * half_angle) for k in range(3) for side in (-1, 1)]
    return [(radius * cos(t), radius * sin(t), height) for t in angles]


BASE_JOINTS = circle(BASE, 43, HEIGHT)
BALL_JOINTS = circle(PLATFORM, 60 - 43, JOINTS_ABOVE_TIP)


def times(A, B):
    return [[sum(a * b for a, b in zip(row, column)) for column in zip(*B)] for row in A]


def lengths(tip, R):
    result = []
    for ball, base in zip(BALL_JOINTS, BASE_JOINTS):
        d = [p + sum(r * a for r, a in zip(row, ball)) - b for p, row, b in zip(tip, R, base)]
        result.append(sqrt(sum(x * x for x in d) - DEVIATION**2))
    return result


def turned(axis, angle):
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R = [[float(r == c) for c in range(3)] for r in range(3)]
    R[i][i] = R[j][j] = cos(angle)
    R[i][j], R[j][i] = -sin(angle), sin(angle)
    return R


def slopes(tip, R):
    """d(lengths)/d(tip, turn), one row for each of the six freedoms."""
    rows = []
    for k in range(3):
        ends = [lengths([p + side * STEP * (i == k) for i, p in enumerate(tip)], R) for side in (1, -1)]
        rows.append([(a - b) / (2 * STEP) for a, b in zip(*ends)])
    for k in range(3):
        ends = [lengths(tip, times(turned(k, side * STEP), R)) for side in (1, -1)]
        rows.append([(a - b) / (2 * STEP) for a, b in zip(*ends)])
    return rows


def solved(A, b):
    """Gauss and Jordan, with the largest pivot."""
    rows = [list(row) + [x] for row, x in zip(A, b)]
    for k in range(len(rows)):
        pivot = max(range(k, len(rows)), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [x / rows[k][k] for x in rows[k]]
        for i, row in enumerate(rows):
            if i != k:
                rows[i] = [x - row[k] * y for x, y in zip(row, rows[k])]
    return [row[-1] for row in rows]


def main():
    lines = open(sys.argv[1]).read().splitlines()
    first_bead = next(i for i, line in enumerate(lines) if line.startswith("G1") and "E" in line)
    words = {m[0]: float(m[1]) for m in re.findall(r"([XYZWIJK])([-0-9.]+)", lines[first_bead - 1])}
    w, x, y, z = (words[c] for c in "WIJK")
    R = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
         [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
         [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    normal = [row[2] for row in R]
    # n' C n = |J^-T n|^2 of independent lengths.
    by_length = solved(slopes([words[c] for c in "XYZ"], R), normal + [0, 0, 0])
    sigma = TOLERANCE * sqrt(3) * hypot(*by_length)
    print(f"{degrees(acos(normal[2])):.1f} degrees: {sigma:.4f} mm along the normal (1 sigma)")


main()
