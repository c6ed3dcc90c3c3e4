#!/usr/bin/env python3
"""Support-free layers against level layers with supports: time and filament of the same part (Han 2024, table 1).

Level layers are PrusaSlicer's, with its supports where they are needed, and the paper's layer, line width and speed in every line;
support-free ones are `understudy plan support-free`, rehearsed. Both fill the part.

usage: against_supports.py UNDERSTUDY [PART.stl...]   (default: the bent parts of models/parts)
Needs prusa-slicer. Exit status: 0 where both answered for every part; 2 without prusa-slicer.
"""
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

PARTS = Path(__file__).resolve().parents[2] / "models/parts"
LAYER, WIDTH, SPEED = 0.2, 0.6, 12  # mm, mm, mm/s: Han 2024, table 1 (720 mm/min)
SPEEDS = ("perimeter external-perimeter small-perimeter infill solid-infill top-solid-infill support-material "
          "support-material-interface gap-fill first-layer bridge").split()
WIDTHS = "extrusion first-layer-extrusion perimeter-extrusion external-perimeter-extrusion infill-extrusion solid-infill-extrusion " \
         "top-infill-extrusion support-material-extrusion".split()


def seconds(text):
    units = {"d": 86400, "h": 3600, "m": 60, "s": 1}
    return sum(int(number) * units[unit] for number, unit in re.findall(r"(\d+)([dhms])", text))


def with_supports(part, folder):
    """(s, mm of filament), as the slicer states them."""
    out = folder / "supports.gcode"
    words = ["prusa-slicer", "-g", str(part), "--support-material", "--gcode-flavor", "marlin2", "--layer-height", str(LAYER),
             "--first-layer-height", str(LAYER), "--perimeters", "1", "--fill-density", "100%", "--fill-pattern", "rectilinear",
             "--skirts", "0", "--filament-diameter", "1.75", "--nozzle-diameter", "0.4", "--center", "0,0", "-o", str(out)]
    for speed in SPEEDS:
        words += [f"--{speed}-speed", str(SPEED)]
    for width in WIDTHS:
        words += [f"--{width}-width", str(WIDTH)]
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    text = out.read_text()
    return (seconds(re.search(r"estimated printing time \(normal mode\) = (.*)", text).group(1)),
            float(re.search(r"filament used \[mm\] = ([0-9.]+)", text).group(1)))


def support_free(understudy, part, folder):
    """(s, mm of filament, verdict), as rehearsed."""
    program = folder / "support-free.gcode"
    subprocess.run([understudy, "plan", "support-free", str(part), "--machine", "five-axis", "--layer", str(LAYER), "--width", str(WIDTH), "--feed",
                    str(SPEED), "-o", str(program)], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([understudy, "rehearse", str(program), "--machine", "five-axis", "--engine", "quasistatic", "--no-pictures",
                    "--out", str(folder / "rehearsal")], check=False, stdout=subprocess.DEVNULL)
    summary = json.loads((folder / "rehearsal/summary.json").read_text())
    return summary["print"]["duration_s"], summary["print"]["extruded_mm"], summary["verdict"]


def main():
    if len(sys.argv) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    if not shutil.which("prusa-slicer"):
        print("against_supports.py: prusa-slicer is not installed", file=sys.stderr)
        return 2
    parts = [Path(word) for word in sys.argv[2:]] or [PARTS / f"{name}.stl" for name in ("bent_cylinder", "bent_bar", "s_tube")]
    print(f"{'part':15} {'supports':>20} {'support-free':>20} {'time':>8} {'filament':>9}  verdict")
    for part in parts:
        with tempfile.TemporaryDirectory() as name:
            time_s, filament = with_supports(part, Path(name))
            own_s, own_filament, verdict = support_free(sys.argv[1], part, Path(name))
        print(f"{part.stem:15} {time_s / 60:6.1f} min {filament:6.0f} mm {own_s / 60:6.1f} min {own_filament:6.0f} mm "
              f"{100 * (own_s / time_s - 1):6.1f} % {100 * (own_filament / filament - 1):7.1f} %  {verdict}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
