#!/usr/bin/env python3
"""Plans random blocks in five directions and rehearses each: whether anything is run into, travel included.

A block is a base of random size with an arm of random size and place on none to four of its sides; no size is a multiple of the
strut. The rehearsal's collision check knows nothing of the plan: it holds the machine's bodies against the beads that the twin laid.

usage: random_blocks.py UNDERSTUDY [--seed 1] [--count 20] [--first 1] [--machine arm] [--out FOLDER]
Exit status: 0 where every part is planned and printed without a contact, else 1.
"""
import argparse
import itertools
import json
import random
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOM = 31.5  # mm above the table: below, a tool that lies on its side would meet it


def random_block(rng):
    """Boxes (lower, upper) in mm: the base, and its arms. An arm is at least two struts wide and thick, or as wide as the base."""
    x, y, z = rng.uniform(6, 14), rng.uniform(6, 14), rng.uniform(44, 50)
    boxes = [((0, 0, 0), (x, y, z))]
    for side in rng.sample(["Y-", "Y+", "X-", "X+"], rng.randint(0, 4)):
        wide = x if side[0] == "Y" else y
        width = wide if wide < 10 else rng.uniform(10, wide)
        a, out = rng.uniform(0, wide - width), rng.uniform(6, 14)
        z0 = rng.uniform(ROOM, 34)
        z1 = rng.uniform(z0 + 10, z)
        if side[0] == "Y":
            low, high = ((-out, 0) if side == "Y-" else (y, y + out))
            boxes.append(((a, low, z0), (a + width, high, z1)))
        else:
            low, high = ((-out, 0) if side == "X-" else (x, x + out))
            boxes.append(((low, a, z0), (high, a + width, z1)))
    return boxes


def write_stl(boxes, path):
    """The surface of all boxes together, on the grid of all their faces."""
    cuts = [sorted({box[end][k] for box in boxes for end in (0, 1)}) for k in range(3)]
    filled = {cell for cell in itertools.product(*(range(len(c) - 1) for c in cuts))
              if any(all(low[k] <= cuts[k][cell[k]] and cuts[k][cell[k] + 1] <= high[k] for k in range(3)) for low, high in boxes)}
    triangles = []
    for cell in filled:
        for axis, side in itertools.product(range(3), (0, 1)):
            neighbour = tuple(c + (2 * side - 1) * (k == axis) for k, c in enumerate(cell))
            if neighbour in filled:
                continue
            u, v = (axis + 1) % 3, (axis + 2) % 3
            quad = []
            for du, dv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                corner = list(cell)
                corner[axis] += side
                corner[u] += du
                corner[v] += dv
                quad.append(tuple(cuts[k][corner[k]] for k in range(3)))
            quad = quad if side else quad[::-1]
            triangles += [(quad[0], quad[1], quad[2]), (quad[0], quad[2], quad[3])]
    with open(path, "wb") as file:
        file.write(b"random block, millimetres".ljust(80) + struct.pack("<I", len(triangles)))
        for triangle in triangles:
            file.write(struct.pack("<3f", 0, 0, 0) + b"".join(struct.pack("<3f", *p) for p in triangle) + b"\0\0")


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("understudy")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=20, help="parts that are drawn")
    parser.add_argument("--first", type=int, default=1, help="the first of them that is printed")
    parser.add_argument("--machine", default="arm")
    parser.add_argument("--out", type=Path)
    words = parser.parse_args()
    folder = words.out or Path(tempfile.mkdtemp(prefix="random-blocks-"))
    folder.mkdir(parents=True, exist_ok=True)
    rng = random.Random(words.seed)
    print("| part | mm | arms | struts | print min | verdict | contacts | clearance mm | tip um |\n|---|---|---|---|---|---|---|---|---|")
    bad = 0
    for n in range(1, words.count + 1):
        boxes = random_block(rng)
        if n < words.first:
            continue
        part, program, record = folder / f"{n}.stl", folder / f"{n}.gcode", folder / f"{n}"
        write_stl(boxes, part)
        size = " x ".join(f"{high - low:.1f}" for low, high in zip(*boxes[0]))
        planned = subprocess.run([words.understudy, "plan", "lattice", part, "--directions", "five", "--turn", "45", "--machine",
                                  words.machine, "--diameter", "0.475", "--dwell", "0", "-o", program], capture_output=True, text=True)
        if planned.returncode != 0:
            bad += 1
            print(f"| {n} | {size} | {len(boxes) - 1} | {planned.stderr.strip()} |", flush=True)
            continue
        begin = time.monotonic()
        subprocess.run([words.understudy, "rehearse", program, "--machine", words.machine, "--as-built", "nominal", "--engine",
                        "quasistatic", "--no-pictures", "--out", record], capture_output=True, text=True)
        summary = json.loads((record / "summary.json").read_text())
        contacts = sum(f["kind"] == "collision" for f in summary["findings"])
        bad += summary["verdict"] != "go" or contacts > 0
        print(f"| {n} | {size} | {len(boxes) - 1} | {planned.stdout.split(': ')[1].split()[0]} | {summary['print']['duration_s'] / 60:.0f} "
              f"| {summary['verdict']} | {contacts} | {summary['collision']['min_clearance_mm']:.2f} ({summary['collision']['closest']}) "
              f"| {summary['accuracy']['tip_max_um']:.0f} |", flush=True)
        print(f"{n}: {time.monotonic() - begin:.0f} s", file=sys.stderr, flush=True)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
