#!/usr/bin/env python3
"""Calibrates an open chain of axes (an arm): damped least squares of the measured poses.

One problem on standard input, one answer on standard output, both JSON (docs/calibration-plugins.md).
Nothing but Python 3 is needed. Every axis is moved as a whole by a small twist and gets a zero, tool and
work a small twist each; what the poses cannot tell, the damping leaves where it is.
"""
import json
import math
import sys

ITERATIONS = 12
STEP = 1e-6            # [mm] and [rad], of the numeric derivative
ARM_MM = 100.0         # a radian weighs as much as this
STEP_DONE_MM = 1e-7


def multiply(A, B):
    """Rigid motions as (R, p)."""
    (R, p), (S, q) = A, B
    return ([[sum(R[r][k] * S[k][c] for k in range(3)) for c in range(3)] for r in range(3)],
            [p[r] + sum(R[r][k] * q[k] for k in range(3)) for r in range(3)])


def inverse(A):
    R, p = A
    Rt = [[R[c][r] for c in range(3)] for r in range(3)]
    return Rt, [-sum(Rt[r][k] * p[k] for k in range(3)) for r in range(3)]


def turn(w):
    """exp of a rotation vector."""
    angle = math.sqrt(sum(x * x for x in w))
    if angle < 1e-12:
        return [[1, -w[2], w[1]], [w[2], 1, -w[0]], [-w[1], w[0], 1]]
    k = [x / angle for x in w]
    c, s = math.cos(angle), math.sin(angle)
    return [[c + k[0] * k[0] * (1 - c), k[0] * k[1] * (1 - c) - k[2] * s, k[0] * k[2] * (1 - c) + k[1] * s],
            [k[1] * k[0] * (1 - c) + k[2] * s, c + k[1] * k[1] * (1 - c), k[1] * k[2] * (1 - c) - k[0] * s],
            [k[2] * k[0] * (1 - c) - k[1] * s, k[2] * k[1] * (1 - c) + k[0] * s, c + k[2] * k[2] * (1 - c)]]


def rotation_vector(R):
    """Of a small rotation."""
    return [0.5 * (R[2][1] - R[1][2]), 0.5 * (R[0][2] - R[2][0]), 0.5 * (R[1][0] - R[0][1])]


def pose_of(value):
    w, x, y, z = value["quaternion_wxyz"]
    return ([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
             [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
             [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]], list(value["position_mm"]))


def quaternion_of(R):
    """Whatever its angle: the largest of the four first."""
    t = [1 + R[0][0] + R[1][1] + R[2][2], 1 + R[0][0] - R[1][1] - R[2][2],
         1 - R[0][0] + R[1][1] - R[2][2], 1 - R[0][0] - R[1][1] + R[2][2]]
    k = max(range(4), key=lambda i: t[i])
    a, b, c = R[2][1] - R[1][2], R[0][2] - R[2][0], R[1][0] - R[0][1]
    d, e, f = R[1][0] + R[0][1], R[0][2] + R[2][0], R[2][1] + R[1][2]
    q = [[t[0], a, b, c], [a, t[1], d, e], [b, d, t[2], f], [c, e, f, t[3]]][k]
    length = math.sqrt(sum(x * x for x in q))
    return [x / length for x in q]


def motion(axis, q):
    d = axis["direction"]
    if axis["moves"] == "slides":
        return [[1, 0, 0], [0, 1, 0], [0, 0, 1]], [q * x for x in d]
    R, p = turn([q * x for x in d]), axis["point_mm"]
    return R, [p[r] - sum(R[r][k] * p[k] for k in range(3)) for r in range(3)]


class Machine:
    def __init__(self, axes, tool_axis, work_axis, tool, work):
        self.axes, self.tool_axis, self.work_axis, self.tool, self.work = axes, tool_axis, work_axis, tool, work

    def forward(self, readings):
        """The tool seen from the work."""
        links = []
        for axis, reading in zip(self.axes, readings):
            moved = motion(axis, reading + axis["zero_mm_rad"])
            links.append(moved if axis["parent"] < 0 else multiply(links[axis["parent"]], moved))
        tool = self.tool if self.tool_axis < 0 else multiply(links[self.tool_axis], self.tool)
        work = self.work if self.work_axis < 0 else multiply(links[self.work_axis], self.work)
        return multiply(inverse(work), tool)

    def parameters(self):
        return 7 * len(self.axes) + 12

    def moved(self, x):
        """By a twist (turn [rad] times ARM_MM, shift [mm]) and a zero for each axis, then tool and work."""
        axes = []
        for i, axis in enumerate(self.axes):
            X = turn([v / ARM_MM for v in x[7 * i:7 * i + 3]]), x[7 * i + 3:7 * i + 6]
            d, p = axis["direction"], axis["point_mm"]
            d = [sum(X[0][r][k] * d[k] for k in range(3)) for r in range(3)]
            length = math.sqrt(sum(v * v for v in d))
            scale = 1.0 if axis["moves"] == "slides" else 1 / ARM_MM
            axes.append({**axis, "direction": [v / length for v in d],
                         "point_mm": [p[r] + X[1][r] for r in range(3)],
                         "zero_mm_rad": axis["zero_mm_rad"] + scale * x[7 * i + 6]})
        ends = []
        for n, end in enumerate((self.tool, self.work)):
            y = x[7 * len(axes) + 6 * n:7 * len(axes) + 6 * n + 6]
            ends.append(multiply(end, (turn([v / ARM_MM for v in y[0:3]]), y[3:6])))
        return Machine(axes, self.tool_axis, self.work_axis, *ends)


def residuals(machine, samples):
    """Measured less model, over the standard deviation of each coordinate."""
    out = []
    for measured, readings, sigma in samples:
        model = machine.forward(readings)
        off = [measured[1][k] - model[1][k] for k in range(3)]
        off += rotation_vector(multiply((measured[0], [0] * 3), inverse((model[0], [0] * 3)))[0])
        out += [o / s for o, s in zip(off, sigma)]
    return out


def solve(A, y):
    """Cholesky: A is symmetric and, damped, positive."""
    n = len(y)
    L = [[0.0] * n for _ in range(n)]
    for r in range(n):
        for c in range(r + 1):
            rest = A[r][c] - sum(L[r][k] * L[c][k] for k in range(c))
            if r == c and rest <= 0:
                raise ValueError("the normal equations are singular")
            L[r][c] = math.sqrt(rest) if r == c else rest / L[c][c]
    z = []
    for r in range(n):
        z.append((y[r] - sum(L[r][k] * z[k] for k in range(r))) / L[r][r])
    x = [0.0] * n
    for r in reversed(range(n)):
        x[r] = (z[r] - sum(L[k][r] * x[k] for k in range(r + 1, n))) / L[r][r]
    return x


def step(machine, samples, e):
    n = machine.parameters()
    columns = []
    for k in range(n):
        x = [0.0] * n
        x[k] = STEP * ARM_MM
        ahead = residuals(machine.moved(x), samples)
        columns.append([(a - b) / x[k] for a, b in zip(ahead, e)])
    A = [[sum(p * q for p, q in zip(columns[r], columns[c])) if c <= r else 0.0 for c in range(n)] for r in range(n)]
    damping = 1e-9 * max(A[k][k] for k in range(n))
    for k in range(n):
        A[k][k] += damping
    return solve(A, [-sum(p * q for p, q in zip(columns[k], e)) for k in range(n)])


def calibrate(problem):
    nominal = problem["nominal"]
    machine = Machine(nominal["axes"], nominal["tool_axis"], nominal["work_axis"], pose_of(nominal["tool"]),
                      pose_of(nominal["work"]))
    samples = [(pose_of(s), s["readings_mm_rad"], [math.sqrt(s["covariance_mm_rad"][k][k]) for k in range(6)])
               for s in problem["samples"]]
    for _ in range(ITERATIONS):
        x = step(machine, samples, residuals(machine, samples))
        machine = machine.moved(x)
        if max(abs(v) for v in x) < STEP_DONE_MM:
            break
    return {"schema": "understudy.calibration-answer/2",
            "axes": [{k: axis[k] for k in ("direction", "point_mm", "zero_mm_rad")} for axis in machine.axes],
            "tool": {"position_mm": machine.tool[1], "quaternion_wxyz": quaternion_of(machine.tool[0])},
            "work": {"position_mm": machine.work[1], "quaternion_wxyz": quaternion_of(machine.work[0])}}


def main():
    problem = json.load(sys.stdin)
    try:
        if problem["machine"] != "chain":
            raise ValueError("this program calibrates open chains only")
        answer = calibrate(problem)
    except ValueError as why:
        answer = {"schema": "understudy.calibration-answer/2", "failure": str(why)}
    json.dump(answer, sys.stdout)


if __name__ == "__main__":
    main()
