#!/usr/bin/env python3
"""Plans and rehearses every frame of a folder and prints the table of docs/lattices.md.

Each frame is planned with `understudy plan lattice` and, where it is planned, rehearsed with the quasistatic engine.
One row a frame: struts, longest side, time to plan, answer, verdict, collisions, and the reason where it is no.

usage: lattice_table.py FOLDER [--program understudy] [--machine arm] [--place 0,0,0.05] [--scale 1]
                        [--plan-options "..."] [--rehearse-up-to STRUTS] [--out FOLDER] [NAME ...]
"""
import argparse
import json
import resource
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

UNITS = {"millimeter": 1, "centimeter": 10, "meter": 1000, "inch": 25.4}


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*", help="frames by file name without .json; all of the folder unless given")
    parser.add_argument("--program", default="understudy")
    parser.add_argument("--machine", default="arm")
    parser.add_argument("--place", default="0,0,0.05")
    parser.add_argument("--scale", type=float, default=1)
    parser.add_argument("--plan-options", default="")
    parser.add_argument("--rehearse-up-to", type=int, default=100_000, metavar="STRUTS")
    parser.add_argument("--out", type=Path, help="where programs and reports stay; without it nothing stays")
    return parser.parse_intermixed_args()


def size_of(frame, scale):
    """struts, longest side in mm"""
    points = [[n["point"][k] * UNITS[frame["unit"]] * scale for k in "XYZ"] for n in frame["node_list"]]
    return len(frame["element_list"]), max(max(c) - min(c) for c in zip(*points))


def plan(path, program, options):
    """seconds of processor time, why it is refused"""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    words = [options.program, "plan", "lattice", str(path), "--machine", options.machine, "--place", options.place,
             "--scale", f"{options.scale:g}", "-o", str(program), *shlex.split(options.plan_options)]
    answer = subprocess.run(words, capture_output=True, text=True)
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    if answer.returncode == 0:
        return seconds, None
    return seconds, answer.stderr.strip().splitlines()[-1].removeprefix("understudy: ")


def rehearse(program, out, options):
    """verdict, collisions, the worst finding"""
    words = [options.program, "rehearse", str(program), "--machine", options.machine, "--engine", "quasistatic",
             "--no-pictures", "--max-time", "1000000", "--out", str(out)]
    answer = subprocess.run(words, capture_output=True, text=True)
    if answer.returncode not in (0, 1):
        return "-", "-", answer.stderr.strip().splitlines()[-1]
    summary = json.loads((out / "summary.json").read_text())
    errors = [f for f in summary["findings"] if f["severity"] == "error"]
    collisions = sum(f["kind"] == "collision" for f in summary["findings"])
    return summary["verdict"].upper(), collisions, errors[0]["message"] if errors else ""


def row(path, out, options):
    struts, side = size_of(json.loads(path.read_text()), options.scale)
    program = out / (path.stem + ".gcode")
    seconds, refused = plan(path, program, options)
    cells = [path.stem, struts, f"{side:.0f}", f"{seconds:.1f}"]
    if refused:
        return cells + ["refused", "", "", refused]
    if struts > options.rehearse_up_to:
        return cells + ["planned", "not rehearsed", "", ""]
    return cells + ["planned", *rehearse(program, out / path.stem, options)]


def main():
    options = arguments()
    paths = sorted(options.folder.glob("*.json"))
    if options.names:
        paths = [p for p in paths if p.stem in options.names]
    if not paths:
        sys.exit(f"{options.folder} holds no such frame")
    print("| frame | struts | mm | plan s | answer | rehearsal | collisions | why not |")
    print("|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as temporary:
        out = options.out or Path(temporary)
        out.mkdir(parents=True, exist_ok=True)
        for path in sorted(paths, key=lambda p: (size_of(json.loads(p.read_text()), 1)[0], p.name)):
            print("| " + " | ".join(str(cell) for cell in row(path, out, options)) + " |", flush=True)


if __name__ == "__main__":
    main()
