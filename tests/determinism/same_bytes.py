#!/usr/bin/env python3
"""Runs the command in one environment after the other and compares the bytes of what it writes (docs/determinism.md).

usage: same_bytes.py UNDERSTUDY SOURCE

What says how long a run took is left out: timing.json, real_time_factor, and manifest.sha256, whose sums cover it.
"""
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

LEFT_OUT = ("manifest.sha256", "timing.json")
TIME = re.compile(rb'"real_time_factor": ?[^,}\n]+')

# Seven with other decimal points, groups of digits, letters and directions; with C, POSIX and C.UTF-8 there are ten.
LOCALES = {"de_DE": "ISO-8859-1", "fr_FR": "ISO-8859-1", "sv_SE": "ISO-8859-1", "tr_TR": "ISO-8859-9",
           "pl_PL": "ISO-8859-2", "ru_RU": "ISO-8859-5", "ar_EG": "ISO-8859-6"}

# A processor without fused multiplication, AVX and what came after, as the libraries see it.
PLAIN_PROCESSOR = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX", "GALLIUM_OVERRIDE_CPU_CAPS": "sse2",
                   "LP_NATIVE_VECTOR_WIDTH": "128",
                   "OPENCV_CPU_DISABLE": "SSSE3,SSE4.1,POPCNT,SSE4.2,FP16,AVX,AVX2,FMA3,AVX512F"}
OTHER_VECTORS = {"LP_NATIVE_VECTOR_WIDTH": "128", "OPENCV_CPU_DISABLE": PLAIN_PROCESSOR["OPENCV_CPU_DISABLE"]}


QUICK = ("line.gcode", "quasistatic", "axes.csv")


def quick(source, jobs):
    song = f"{source}/scenarios/song-bottle.gcode"
    return ["plan surface bottle --tilt -20 20 -o line.gcode",
            f"rehearse {song} --fixture bottle --seed 4 --engine quasistatic --no-pictures --gap-control off --out quasistatic",
            f"axes --machine hexapod < {source}/examples/poses.csv > axes.csv"]


def thorough(source, jobs):
    song, measured = f"{source}/scenarios/song-bottle.gcode", f"{source}/scenarios/calibration/hexapod-24-poses.csv"
    return quick(source, jobs) + [
        f"calibrate {measured} -o machine.yaml --report calibration",
        f"workspace --machine hexapod --tilt 20 --step 25 --out workspace -j {jobs}",
        f"rehearse {source}/scenarios/arm-square.gcode --machine arm --seed 4 --no-pictures --out arm",
        f"rehearse {song} --fixture bottle --seed 4 --engine bullet --gap-control continuous --out gap"]


class Place:
    """Where and how the command runs."""

    def __init__(self, name, commands=quick, jobs=2, **variables):
        self.name, self.commands, self.jobs, self.variables = name, commands, jobs, variables


def places(locales):
    yield Place("here", thorough)
    for name in ("C", "POSIX", "C.UTF-8", *LOCALES):
        yield Place(f"locale {name}", LC_ALL=name, LANG=name, LOCPATH=locales if name in LOCALES else None)
    for zone in ("Asia/Kolkata", "America/St_Johns", "nowhere"):
        yield Place(f"time zone {zone}", TZ=zone)
    yield Place("two numbers at a time", UNDERSTUDY_SIMD="sse2")
    yield Place("another user's home", HOME="/nonexistent", USER="nobody", XDG_CACHE_HOME=None)
    # All of that at once, for the long commands.
    yield Place("elsewhere", thorough, 3, LC_ALL="de_DE", LOCPATH=locales, TZ="Asia/Kolkata", HOME="/nonexistent",
                LP_NUM_THREADS="1", UNDERSTUDY_SIMD="sse2", **OTHER_VECTORS)
    yield Place("plain processor, asked for", thorough, 1, UNDERSTUDY_SIMD="scalar")
    yield Place("plain processor", thorough, 3, LP_NUM_THREADS="3", **PLAIN_PROCESSOR)


def make_locales(folder):
    for name, letters in LOCALES.items():
        made = subprocess.run(["localedef", "-i", name, "-f", letters, "--no-archive", f"{folder}/{name}"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        if made.returncode != 0:
            print(f"localedef cannot make {name}: package locales")


def contents(folder):
    """Bytes of each file, but for times and for the number of threads in the command that a record keeps."""
    return {file.relative_to(folder).as_posix(): re.sub(rb" -j [0-9]", b"", TIME.sub(b"", file.read_bytes()))
            for file in sorted(folder.rglob("*")) if file.is_file() and file.name not in LEFT_OUT}


def run(place, understudy, source, top):
    folder = Path(tempfile.mkdtemp(prefix="place-", dir=top))
    environment = {key: value for key, value in {**os.environ, **place.variables}.items() if value is not None}
    for words in place.commands(source, place.jobs):
        done = subprocess.run(f"{understudy} {words}", shell=True, cwd=folder, env=environment, capture_output=True, text=True)
        if done.returncode not in (0, 1):
            sys.exit(f"{place.name}: understudy {words}: {done.returncode}: {done.stderr}")
    return contents(folder)


def differences(ours, theirs):
    return [name for name in sorted(ours.keys() | theirs.keys()) if ours.get(name) != theirs.get(name)]


def main(understudy, source):
    with tempfile.TemporaryDirectory() as top:
        make_locales(top)
        everywhere = list(places(top))
        with ThreadPoolExecutor(2) as pool:
            results = list(pool.map(lambda place: run(place, understudy, source, top), everywhere))
    found = {place.name: files for place, files in zip(everywhere, results)}
    faults = 0
    for place, files in zip(everywhere, results):
        reference = found["plain processor, asked for" if place.name.startswith("plain") else "here"]
        if place.commands is quick:
            reference = {name: data for name, data in reference.items() if name.split("/")[0] in QUICK}
        different = differences(reference, files)
        faults += bool(different)
        print(f"{place.name}: " + (f"DIFFERS in {', '.join(different)}" if different else f"{len(files)} files, the same bytes"))
    changed = differences(found["here"], found["plain processor, asked for"])
    print(f"what this processor's own instructions change: {', '.join(changed) or 'nothing'}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
