#!/usr/bin/env python3
"""Forward kinematics of URDF arms, computed here from the XML with sines and cosines alone, against `understudy`.

usage: urdf_forward.py UNDERSTUDY FILE.urdf|FOLDER... [--rows N] [--limit METRES]

Each file becomes a machine by `understudy new-machine`; random axis positions within its ranges go through
`understudy poses`, and through the joints of the file here. Prints a line for each arm; status 1 where one is
farther off than the limit, or is refused.
"""
import argparse
import math
import random
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path


def numbers(text, count=3):
    values = [float(word) for word in text.split()]
    assert len(values) == count, text
    return values


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def translation(x, y, z):
    return [[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z], [0, 0, 0, 1]]


def turn(axis, angle):
    """Rodrigues' formula."""
    length = math.sqrt(sum(v * v for v in axis))
    x, y, z = (v / length for v in axis)
    c, s = math.cos(angle), math.sin(angle)
    d = 1 - c
    return [[c + x * x * d, x * y * d - z * s, x * z * d + y * s, 0],
            [y * x * d + z * s, c + y * y * d, y * z * d - x * s, 0],
            [z * x * d - y * s, z * y * d + x * s, c + z * z * d, 0],
            [0, 0, 0, 1]]


def origin(element):
    """<origin>: roll, pitch, yaw about the fixed axes x, y, z."""
    found = element.find("origin")
    if found is None:
        return translation(0, 0, 0)
    roll, pitch, yaw = numbers(found.get("rpy", "0 0 0"))
    rotation = product(turn((0, 0, 1), yaw), product(turn((0, 1, 0), pitch), turn((1, 0, 0), roll)))
    return product(translation(*numbers(found.get("xyz", "0 0 0"))), rotation)


def inverse(pose):
    rotation = [[pose[j][i] for j in range(3)] for i in range(3)]
    p = [-sum(rotation[i][k] * pose[k][3] for k in range(3)) for i in range(3)]
    return [rotation[i] + [p[i]] for i in range(3)] + [[0, 0, 0, 1]]


class Arm:
    def __init__(self, path):
        self.joint_above = {}
        for joint in ElementTree.parse(path).getroot().findall("joint"):
            self.joint_above[joint.find("child").get("link")] = joint

    def way_to(self, link):
        way = []
        while link in self.joint_above:
            way.insert(0, self.joint_above[link])
            link = way[0].find("parent").get("link")
        return way

    def pose(self, link, positions):
        """Of the link in the root, joints that `positions` does not name at 0."""
        pose = translation(0, 0, 0)
        for joint in self.way_to(link):
            pose = product(pose, origin(joint))
            kind, q = joint.get("type"), positions.get(joint.get("name"), 0.0)
            axis = joint.find("axis")
            direction = numbers(axis.get("xyz")) if axis is not None else [1.0, 0.0, 0.0]
            if kind in ("revolute", "continuous"):
                pose = product(pose, turn(direction, q))
            elif kind == "prismatic":
                length = math.sqrt(sum(v * v for v in direction))
                pose = product(pose, translation(*(q * v / length for v in direction)))
        return pose

    def range_of(self, name):
        for joint in self.joint_above.values():
            if joint.get("name") != name:
                continue
            if joint.get("type") == "continuous":
                return -math.pi, math.pi
            limit = joint.find("limit")
            return float(limit.get("lower")), float(limit.get("upper"))
        raise KeyError(name)


def value_of(text, key):
    found = re.search(rf"^ +{key}: (.*?)(?: +#.*)?$", text, re.MULTILINE)
    return found[1].strip().strip("'\"") if found else None


def triple(text):
    return [float(word) for word in text.strip("[]").split(",")]


def run(words, given=None):
    return subprocess.run(words, input=given, capture_output=True, text=True, check=False)


def rows_of(header, arm, count):
    draw = random.Random(1)
    for _ in range(count):
        row = {}
        for column in header:
            name, unit = column.rsplit("_", 1)
            low, high = arm.range_of(name)
            low, high = (max(low, -math.pi), min(high, math.pi)) if unit == "deg" else (low, high)
            margin = 0.001 * (high - low)
            row[name] = (draw.uniform(low + margin, high - margin), unit)
        yield row


def largest_error(program, path, folder, count):
    """[m] and the number of rows compared and of axes; a text where the arm is refused."""
    made = run([program, "new-machine", str(path), "-o", str(folder)])
    if made.returncode != 0:
        return made.stderr.strip()
    file = folder / "machine.yaml"
    text = "".join(line for line in file.read_text().splitlines(True) if "condition_max" not in line)
    file.write_text(text)  # stretched postures are compared too
    header = run([program, "axes", "--machine", str(folder)], "x_mm,y_mm,z_mm,qw,qx,qy,qz\n0,0,0,1,0,0,0\n")
    names = header.stdout.splitlines()[0].split(",")[:-1]
    arm = Arm(path)
    rows = list(rows_of(names, arm, count))
    table = ",".join(names) + "\n"
    for row in rows:
        table += ",".join(repr(math.degrees(q) if unit == "deg" else 1e3 * q) for q, unit in row.values()) + "\n"
    answer = run([program, "poses", "--machine", str(folder)], table).stdout.splitlines()[1:]
    base, tool = value_of(text, "base_link"), value_of(text, "tool_link")
    tip = [1e-3 * v for v in triple(value_of(text, "tip_mm"))]
    at = [1e-3 * v for v in triple(value_of(text, "base_mm") or "[0, 0, 0]")]
    worst, compared = 0.0, 0
    for row, line in zip(rows, answer):
        cells = line.split(",")
        if cells[-1] != "ok":
            continue
        positions = {name: q for name, (q, _) in row.items()}
        seen = product(inverse(arm.pose(base, positions)), arm.pose(tool, positions))
        expected = product(seen, translation(*tip))
        error = math.dist([1e-3 * float(c) for c in cells[:3]], [expected[i][3] + at[i] for i in range(3)])
        worst, compared = max(worst, error), compared + 1
    if compared < 0.9 * count:
        return f"only {compared} of {count} rows have a pose: {answer[0] if answer else 'no answer'}"
    return worst, compared, len(names)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("paths", nargs="+", type=Path)
    parser.add_argument("--rows", type=int, default=200)
    parser.add_argument("--limit", type=float, default=1e-9)
    options = parser.parse_args()
    files = []
    for path in options.paths:
        files += sorted(path.glob("*.urdf")) if path.is_dir() else [path]
    wrong = not files
    for path in files:
        with tempfile.TemporaryDirectory() as folder:
            found = largest_error(options.program, path, Path(folder) / "arm", options.rows)
        if isinstance(found, str):
            print(f"{path.name}: {found}")
            wrong = True
            continue
        error, rows, axes = found
        print(f"{path.name}: {axes} axes, {rows} rows, at most {error:.1e} m off")
        wrong = wrong or not error <= options.limit
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
