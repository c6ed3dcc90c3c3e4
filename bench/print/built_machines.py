#!/usr/bin/env python3
"""The bottle's line on built machines, each off in all that its tolerances name (--as-built manufactured), after the
calibrations that a lab would make of it and, last, with the part found first.

usage: built_machines.py UNDERSTUDY OUT.jsonl [--first SEED] [--last SEED] [--cases CASE...] [--jobs N] [--hold]
cases: drawn, geometry (calibrated), sensor (calibrated, too), registered (that, and the part found first)

A machine whose gap sensor cannot be calibrated (status 2: the nozzle hides a part of the dot, say) prints nothing with "sensor" and
"registered": it is counted among those that neither begin nor keep the line in the band.

OUT.jsonl gets a line for each machine; one that stands there with all its cases is not run again, so a run that was killed goes on by
the same command. Prints a table over all of them: machines that are GO, that begin in the band, that keep 99 % of the line in it, and
that touch, each with the 95 % interval of its share, by its scores. 26 s of processor time a machine: 200 take an hour and a half.
--hold: status 1 where the registered machines touch, or are too few to begin in the band (99 %) and to keep it under continuous
control (95 %), as far as their number can tell.
"""

import argparse
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

CASES = {"drawn": ("hexapod", []), "geometry": ("calibrated.yaml", []), "sensor": ("ready.yaml", []),
         "registered": ("ready.yaml", ["--register"])}
CONTROLS = ("off", "start", "continuous")
KEPT = 0.99  # of the line, in the band
BAND = (0.1, 0.2)  # [mm], the hexapod's accepted gaps
BEGIN, KEEP = 0.99, 0.95  # of registered machines


def run(folder, *words, may_end_with=(0,)):
    done = subprocess.run(words, cwd=folder, text=True, capture_output=True, check=False)
    if done.returncode not in may_end_with:
        sys.exit(f"{' '.join(words)}: status {done.returncode}\n{done.stderr}")
    return done


def refused(why):
    return {"go": False, "start_mm": None, "in_band": 0, "path_mm": [None, None], "clearance_mm": None, "why": why, "registration": None}


def rehearsal(understudy, folder, built, case, control):
    machine, register = CASES[case]
    run(folder, understudy, "rehearse", "line.gcode", "--machine", machine, "--fixture", "bottle", *built, *register, "--engine",
        "quasistatic", "--no-pictures", "--gap-control", control, "--out", f"{case}-{control}", may_end_with=(0, 1))
    with open(os.path.join(folder, f"{case}-{control}", "summary.json"), encoding="utf-8") as file:
        summary = json.load(file)
    gap = summary.get("gap", {})
    clearance = summary["collision"].get("nozzle_clearance_mm")
    errors = [f["message"] for f in summary["findings"] if f["severity"] == "error"]
    return {"go": summary["go"], "start_mm": gap.get("start_mm"), "in_band": gap.get("in_band_fraction", 0),
            "path_mm": [gap.get("path_min_mm"), gap.get("path_max_mm")], "clearance_mm": clearance,
            "why": errors[0] if errors else "", "registration": summary.get("registration")}


def machine_of(understudy, seed, cases):
    built = ["--as-built", "manufactured", "--seed", str(seed)]
    with tempfile.TemporaryDirectory() as folder:
        run(folder, understudy, "plan", "surface", "bottle", "--tilt", "-20", "20", "-o", "line.gcode")
        if set(cases) - {"drawn"}:
            run(folder, understudy, "sample-poses", "--count", "24", *built, "-o", "poses.csv")
            run(folder, understudy, "calibrate", "poses.csv", "-o", "calibrated.yaml")
        if set(cases) & {"sensor", "registered"}:
            run(folder, understudy, "sample-gaps", *built, "-o", "gaps")
            calibration = run(folder, understudy, "calibrate", "gap-sensor", "gaps/table.csv", "--machine", "calibrated.yaml", "-o",
                              "ready.yaml", may_end_with=(0, 2))
        prints = {}
        for case in cases:
            for control in CONTROLS:
                needs_sensor = CASES[case][0] == "ready.yaml"
                prints[f"{case} {control}"] = (refused(calibration.stderr.strip()) if needs_sensor and calibration.returncode
                                               else rehearsal(understudy, folder, built, case, control))
        return {"seed": seed, "prints": prints}


def interval(count, of):
    """In which the true share lies with 95 %: the scores that do not reject it."""
    z = statistics.NormalDist().inv_cdf(0.975)
    share, square = count / of, z * z / of
    middle, half = (share + square / 2) / (1 + square), z * math.sqrt(share * (1 - share) / of + square / of / 4) / (1 + square)
    return max(0.0, middle - half), min(1.0, middle + half)


def counted(count, of):
    low, high = interval(count, of)
    return f"{count} ({100 * low:.0f} to {100 * high:.0f} %)"


def counts_of(prints):
    """GO, start in the band, line in the band, touch."""
    return (sum(p["go"] for p in prints),
            sum(p["start_mm"] is not None and BAND[0] <= p["start_mm"] <= BAND[1] for p in prints),
            sum(p["in_band"] >= KEPT for p in prints),
            sum(p["clearance_mm"] is not None and p["clearance_mm"] <= 0 for p in prints))


def by_case(machines):
    keys = dict.fromkeys(key for machine in machines for key in machine["prints"])
    return {key: [machine["prints"][key] for machine in machines if key in machine["prints"]] for key in keys}


def broken_promises(machines):
    prints = by_case(machines).get("registered continuous", [])
    _, begun, kept, touches = counts_of(prints)
    if not prints:
        yield "no machine was registered"
        return
    if interval(begun, len(prints))[1] < BEGIN:
        yield f"only {begun} of {len(prints)} begin in the band"
    if interval(kept, len(prints))[1] < KEEP:
        yield f"only {kept} of {len(prints)} keep the line in the band"
    if touches:
        yield f"{touches} of {len(prints)} touch"


def table(machines):
    columns = "".join(f"{name:>18}" for name in ("GO", "start in band", "line in band", "touch"))
    print(f"{'machine file':12} {'gap control':11} {'machines':>8}{columns}")
    for key, prints in by_case(machines).items():
        case, control = key.split()
        counts = "".join(f"{counted(count, len(prints)):>18}" for count in counts_of(prints))
        print(f"{case:12} {control:11} {len(prints):8}{counts}")
    for machine in machines:
        last = list(machine["prints"].values())[-1]
        if last["start_mm"] is None:
            print(f"machine {machine['seed']} did not begin: {last['why']}")
    found = [machine["prints"]["registered off"]["registration"] for machine in machines if "registered off" in machine["prints"]]
    found = [f for f in found if f and f.get("normal_error_rms_um") is not None]
    if found:
        rms = [f["normal_error_rms_um"] for f in found]
        scale = sum(f["chi_square"] for f in found) / sum(f["degrees_of_freedom"] for f in found)
        print(f"registered {len(found)}: surface off by {sum(r * r for r in rms) ** 0.5 / len(rms) ** 0.5:.1f} um RMS, the worst "
              f"machine {max(rms):.1f} um, any place {max(f['normal_error_max_um'] for f in found):.1f} um; "
              f"stated {max(f['normal_sigma_max_um'] for f in found):.1f} um at most; chi-square {scale:.2f} for a degree of freedom")


def known_machines(path):
    """Of the file's lines, the last of each machine; a line that a kill cut off goes."""
    machines = {}
    if not os.path.exists(path):
        return machines
    with open(path, "r+", encoding="utf-8") as file:
        text = file.read()
        whole = text[:text.rfind("\n") + 1]
        if whole != text:
            file.seek(0)
            file.truncate(len(whole.encode()))
    for machine in map(json.loads, whole.splitlines()):
        machines[machine["seed"]] = machine
    return machines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("understudy")
    parser.add_argument("out")
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--last", type=int, default=20)
    parser.add_argument("--cases", nargs="+", choices=CASES, default=list(CASES))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--hold", action="store_true")
    arguments = parser.parse_args()
    understudy = os.path.abspath(arguments.understudy)
    machines = known_machines(arguments.out)
    wanted = range(arguments.first, arguments.last + 1)
    asked = {f"{case} {control}" for case in arguments.cases for control in CONTROLS}
    missing = [seed for seed in wanted if not asked <= machines.get(seed, {"prints": {}})["prints"].keys()]
    with open(arguments.out, "a", encoding="utf-8") as file, ThreadPoolExecutor(arguments.jobs) as pool:
        for machine in pool.map(lambda seed: machine_of(understudy, seed, arguments.cases), missing):
            machines[machine["seed"]] = machine
            print(json.dumps(machine), file=file, flush=True)
            print(f"machine {machine['seed']} of {arguments.last}", file=sys.stderr, flush=True)
    table([machines[seed] for seed in wanted])
    broken = list(broken_promises([machines[seed] for seed in wanted])) if arguments.hold else []
    for promise in broken:
        print(f"built_machines.py: {promise}", file=sys.stderr)
    sys.exit(1 if broken else 0)


if __name__ == "__main__":
    main()
