#!/usr/bin/env python3
"""Slices three parts with the slicers that are installed and rehearses what they write, whole and spoilt as operators spoil parts.

    python3 tests/slicers/slicer_trial.py build/release/cli/understudy --out FOLDER [--slicer NAME] [--part NAME] [--whole] [--jobs N]

Slicers: Debian's prusa-slicer, slic3r, and cura-engine with the definitions of the package cura (--cura: where these lie). Profiles are
those that each slicer has by itself; Cura's is that of the Ender 3. `inspect` proposes the command, `rehearse` answers. A second program
of PrusaSlicer and Cura, with the limits of the machine, tells the slicer's estimate of time. Prints the table of docs/printing.md.
Exit status 1: a whole part is a NO-GO, a spoilt one a GO, or a time with equal limits is off by more than 3 %; 77: no slicer is there.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

from parts import PARTS, stl

MACHINE = "five-axis"
MOST_TIME = 3.0  # [%]
# The limits of models/five-axis/machine.yaml, in the words of two slicers.
PRUSA_LIMITS = {
    "gcode_flavor": "marlin2", "travel_speed": "100",
    **{f"machine_max_feedrate_{axis}": value for axis, value in zip("xyze", ("150,150", "150,150", "30,30", "1000,1000"))},
    **{f"machine_max_acceleration_{axis}": value for axis, value in zip("xyze", ("3000,3000", "3000,3000", "500,500", "100000,100000"))},
    **{f"machine_max_acceleration_{what}": value for what, value in (("extruding", "1000,1000"), ("retracting", "100000,100000"), ("travel", "1000,1000"))},
    **{f"machine_max_jerk_{axis}": value for axis, value in zip("xyze", ("8,8", "8,8", "0.4,0.4", "1000,1000"))},
}
CURA_LIMITS = {
    "acceleration_enabled": "false", "jerk_enabled": "false", "speed_travel": "100", "machine_acceleration": "1000",
    **{f"machine_max_feedrate_{axis}": value for axis, value in zip("xyze", ("150", "150", "30", "1000"))},
    **{f"machine_max_acceleration_{axis}": value for axis, value in zip("xyze", ("3000", "3000", "500", "100000"))},
    "machine_max_jerk_xy": "8", "machine_max_jerk_z": "0.4", "machine_max_jerk_e": "1000",
}
# CuraEngine by itself does not evaluate what depends on other settings, nor the words in braces of the printer's own blocks.
CURA_PLAIN = {"machine_center_is_zero": "true", "center_object": "true", "machine_start_gcode": "G28", "machine_end_gcode": "M107",
              "layer_height": "0.2", "layer_height_0": "0.2", "infill_line_distance": "4"}


def run(command, **options):
    done = subprocess.run(command, capture_output=True, text=True, **options)
    return done.returncode, done.stdout + done.stderr


def slice_with(slicer, part, program, cura, equal_limits):
    environment = dict(os.environ)
    if slicer == "cura":
        environment["CURA_ENGINE_SEARCH_PATH"] = f"{cura}/definitions:{cura}/extruders"
        settings = {**CURA_PLAIN, **(CURA_LIMITS if equal_limits else {})}
        command = ["CuraEngine", "slice", "-j", f"{cura}/definitions/creality_ender3.def.json"]
        command += [word for key, value in settings.items() for word in ("-s", f"{key}={value}")] + ["-o", program, "-l", part]
    elif slicer == "prusa":
        profile = pathlib.Path(program).with_suffix(".ini")
        profile.write_text("".join(f"{key} = {value}\n" for key, value in PRUSA_LIMITS.items()) if equal_limits else "")
        command = ["prusa-slicer", "--export-gcode", "--load", str(profile), "--center", "0,0", "-o", program, part]
    else:
        command = ["slic3r", "--print-center", "0,0", "-o", program, part]
    status, said = run(command, env=environment)
    if status != 0 or not pathlib.Path(program).exists():
        sys.exit(f"{slicer} does not slice {part}: {said.strip().splitlines()[-1:]}")


def proposed(understudy, program):
    """The words of the command that `inspect` proposes, and what it tells of the slicer's time [%]."""
    status, said = run([understudy, "inspect", program, "--machine", MACHINE])
    words = re.search(r"^to rehearse it: understudy (.*)$", said, re.M)
    if status != 0 or not words:
        sys.exit(f"inspect proposes no command for {program}:\n{said}")
    time = re.search(r"for the slicer \(([+-][\d.]+) %\)", said)
    return shlex.split(words[1]), float(time[1]) if time else None


def colder(text, kelvin):
    return re.sub(r"^(M10[49] .*S)(\d+)", lambda word: f"{word[1]}{int(word[2]) - kelvin}" if int(word[2]) > kelvin else word[0], text, flags=re.M)


def higher(words, millimetres):
    if "--place" not in words:
        return words + ["--place", f"0,0,{millimetres}"]
    at = words.index("--place") + 1
    x, y, z = words[at].split(",")[:3]
    return words[:at] + [f"{x},{y},{float(z) + millimetres}"] + words[at + 1:]


def begun(text, height=2.5):
    """The program up to its first layer above `height` [mm], where what is spoilt has long been seen."""
    for word in re.finditer(r"^G[01] .*?Z([\d.]+).*$", text, re.M):
        if height < float(word[1]) < 2 * height:  # a lift or the way from home is higher
            return text[:word.start()]
    return text


# What an operator may do to a print: the program's text and the words of the command, spoilt.
SPOILT = {
    "first layer 0.15 mm too high": lambda text, words: (text, higher(words, 0.15)),
    "60 % of the flow": lambda text, words: ("M221 S60\n" + text, words),
    "40 K too cold": lambda text, words: (colder(text, 40), words),
    "over a clamp": lambda text, words: (text, words + ["--fixture", "slanted_box"]),
}


def verdict(understudy, program, words, out):
    words = [*words]
    words[words.index("--out") + 1] = str(out)
    words[1] = str(program)
    status, said = run([understudy, *words, "--engine", "quasistatic", "--no-pictures", "--quiet"])
    last = said.strip().splitlines()[-1] if said.strip() else ""
    if status not in (0, 1) or ": " not in last:
        sys.exit(f"{program} was not rehearsed: {said}")
    return last.rsplit(": ", 1)[1]


def trial(understudy, folder, slicer, part, cura, whole_only):
    """A row of the table, and whether it is as it should be."""
    program = folder / f"{slicer}-{part}.gcode"
    slice_with(slicer, str(folder / f"{part}.stl"), str(program), cura, False)
    words, _ = proposed(understudy, str(program))
    row = [verdict(understudy, program, words, folder / program.stem)]
    good = row[0] != "NO-GO"
    for name, spoil in {} if whole_only else SPOILT.items():
        text, spoilt_words = spoil(begun(program.read_text()), words)
        spoilt = folder / f"{program.stem}-{name.replace(' ', '-').replace('%', 'percent')}.gcode"
        spoilt.write_text(text)
        row.append(verdict(understudy, spoilt, spoilt_words, folder / spoilt.stem))
        good = good and row[-1] == "NO-GO"
    if slicer == "slic3r":
        row.append("tells none")
    else:
        equal = folder / f"{slicer}-{part}-equal-limits.gcode"
        slice_with(slicer, str(folder / f"{part}.stl"), str(equal), cura, True)
        off = proposed(understudy, str(equal))[1]
        row.append(f"{off:+.1f} %")
        good = good and abs(off) <= MOST_TIME
    return row, good


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("understudy")
    options.add_argument("--out", type=pathlib.Path, required=True)
    options.add_argument("--slicer", action="append", choices=["prusa", "slic3r", "cura"])
    options.add_argument("--part", action="append", choices=list(PARTS))
    options.add_argument("--whole", action="store_true", help="no spoilt parts")
    options.add_argument("--cura", default="/usr/share/cura/resources")
    options.add_argument("--jobs", type=int, default=1)
    asked = options.parse_args()
    there = {"prusa": shutil.which("prusa-slicer"), "slic3r": shutil.which("slic3r"),
             "cura": shutil.which("CuraEngine") and pathlib.Path(asked.cura).is_dir()}
    slicers = [slicer for slicer in asked.slicer or there if there[slicer]]
    for slicer in set(asked.slicer or there) - set(slicers):
        print(f"skipped: {slicer} is not installed", file=sys.stderr)
    if not slicers:
        sys.exit(77)
    asked.out.mkdir(parents=True, exist_ok=True)
    for part, triangles in PARTS.items():
        (asked.out / f"{part}.stl").write_bytes(stl(triangles))
    columns = [] if asked.whole else list(SPOILT)
    print("| slicer | part | whole | " + " | ".join(columns + ["time, equal limits"]) + " |")
    print("|---" * (len(columns) + 4) + "|")
    rows = [(slicer, part) for slicer in slicers for part in asked.part or PARTS]
    all_good = True
    with concurrent.futures.ThreadPoolExecutor(asked.jobs) as pool:
        answers = pool.map(lambda row: trial(asked.understudy, asked.out, *row, asked.cura, asked.whole), rows)
        for (slicer, part), (row, good) in zip(rows, answers):
            print(f"| {slicer} | {part} | " + " | ".join(row) + (" |" if good else " | <- "), flush=True)
            all_good = all_good and good
    sys.exit(0 if all_good else 1)


main()
