#!/usr/bin/env python3
"""Calibrates a hexapod strut by strut: Gauss-Newton on the inverse-kinematic residual (Zhuang 1998).

One problem on standard input, one answer on standard output, both JSON (docs/calibration-plugins.md).
Nothing but Python 3 is needed.
"""
import json
import math
import sys

ITERATIONS = 30
STEP_DONE_MM = 1e-9


def rotation(q):
    w, x, y, z = q
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


def residual(strut, deviation, pose, displacement):
    """Length by the pose less length by the drive [mm], and its derivative by (b, a, l0)."""
    b, a, offset = strut[0:3], strut[3:6], strut[6]
    p, R = pose
    d = [b[r] - p[r] - sum(R[r][c] * a[c] for c in range(3)) for r in range(3)]
    length = math.sqrt(sum(x * x for x in d) - deviation * deviation)
    n = [x / length for x in d]
    by_a = [-sum(R[r][c] * n[r] for r in range(3)) for c in range(3)]
    return length - offset - displacement, n + by_a + [-1.0]


def solve(A, y):
    """Gaussian elimination with pivots; A is changed."""
    n = len(y)
    for k in range(n):
        pivot = max(range(k, n), key=lambda r: abs(A[r][k]))
        if abs(A[pivot][k]) < 1e-12:
            raise ValueError("the poses do not tell all seven parameters of a strut")
        A[k], A[pivot] = A[pivot], A[k]
        y[k], y[pivot] = y[pivot], y[k]
        for r in range(k + 1, n):
            factor = A[r][k] / A[k][k]
            for c in range(k, n):
                A[r][c] -= factor * A[k][c]
            y[r] -= factor * y[k]
    x = [0.0] * n
    for k in reversed(range(n)):
        x[k] = (y[k] - sum(A[k][c] * x[c] for c in range(k + 1, n))) / A[k][k]
    return x


def fit_strut(strut, deviation, poses, displacements):
    for _ in range(ITERATIONS):
        A = [[0.0] * 7 for _ in range(7)]
        y = [0.0] * 7
        for pose, displacement in zip(poses, displacements):
            f, row = residual(strut, deviation, pose, displacement)
            for r in range(7):
                y[r] -= row[r] * f
                for c in range(7):
                    A[r][c] += row[r] * row[c]
        step = solve(A, y)
        strut = [s + d for s, d in zip(strut, step)]
        if max(abs(d) for d in step) < STEP_DONE_MM:
            return strut
    raise ValueError("the search did not settle")


def calibrate(problem):
    if problem["machine"] != "hexapod":
        raise ValueError("this program calibrates hexapods only")
    nominal, samples = problem["nominal"], problem["samples"]
    poses = [(s["position_mm"], rotation(s["quaternion_wxyz"])) for s in samples]
    if len(poses) < 7:
        raise ValueError("fewer than 7 poses")
    answer = {"schema": "understudy.calibration-answer/2",
              "base_joints_mm": [], "platform_joints_mm": [], "length_offsets_mm": []}
    for i in range(6):
        start = (nominal["base_joints_mm"][i] + nominal["platform_joints_mm"][i]
                 + [nominal["length_offsets_mm"][i]])
        strut = fit_strut(start, nominal["deviation_mm"], poses,
                          [s["displacements_mm"][i] for s in samples])
        answer["base_joints_mm"].append(strut[0:3])
        answer["platform_joints_mm"].append(strut[3:6])
        answer["length_offsets_mm"].append(strut[6])
    return answer


def main():
    try:
        answer = calibrate(json.load(sys.stdin))
    except ValueError as why:
        answer = {"schema": "understudy.calibration-answer/2", "failure": str(why)}
    json.dump(answer, sys.stdout)


if __name__ == "__main__":
    main()
