#!/usr/bin/env python3
"""Runs commands on a disk that fails them: full, without room for another file, read-only, with a limit on the size of files, and
with a folder that vanishes during the run.

Every command has an old result there. It must answer with one line and status 3, or 2 where the fault can be known before the
work; the old result must stay, and nothing unfinished beside it. Disks are small ones in memory, in name spaces of this process
(`unshare`); where these are not permitted, the table says so, and the faults that need none are tried.

usage: disk_study.py --understudy PATH [--command NAME...]
Exit status: 1 where anything of this does not hold.
"""
import argparse
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
MARK = ".understudy-unfinished"
PAGE = 4096
SIZE_LIMIT = 200  # bytes of a file; every result has a larger one
PATIENCE_S = 120
LINE = "G21\nG90\nM82\nG0 X0 Y0 Z60 F3000\nG1 X2 Y0 Z60 F600\n"
SCENARIO = """name: short
description: A short move above the table.
source: none
machine: five-axis
program: line.gcode
as_built: sampled
seed: 4
gap_control: "off"
engine: quasistatic
expect:
  - {metric: print.duration_s, min: 0.01, unit: s, source: "it moves"}
"""


@dataclass
class Command:
    words: str  # D stands for the folder on the failing disk
    makes_folder: bool = False  # what stands for D may be missing
    may_stay: list = field(default_factory=list)
    # How the folder vanishes during the run: while this input, a pipe, is waited for, or as soon as this file is there.
    pipe: str = ""
    begun: str = ""
    more: str = ""  # words for that
    vanished: tuple = (3,)


QUICK = "--machine five-axis --engine quasistatic --gap-control off --no-pictures"
COMMANDS = {
    "rehearse": Command(f"rehearse line.gcode {QUICK} --out D/out", True, begun="D/out.part/" + MARK),
    "as-printed": Command("rehearse bead.gcode --fixture bottle --engine quasistatic --no-pictures --as-printed D/part.stl --out out",
                          pipe="bead.gcode", vanished=(2, 3)),  # looks at its place soon after the program, before the print
    "sweep": Command("sweep bottle.yaml --samples 2 -j 2 --out D/out", True, ["out.journal"], begun="D/out.journal"),
    "junit": Command("scenario run short.yaml --junit D/junit.xml", begun="out/short.part/" + MARK, more=" --out out"),
    "calibrate": Command("calibrate poses.csv -o D/calibrated.yaml --report D/report", pipe="poses.csv"),
    "plan": Command("plan waypoints layer.txt --machine arm --place 10,20,0.13 -o D/layer.gcode", pipe="layer.txt"),
    "render": Command("render targets -o D/view.png"),
    "export": Command("export mjcf --machine hexapod -o D/machine.xml"),
    "benchmark": Command("benchmark calibration --trials 1 --poses 12 --noise 20um:0.2mrad --disturbances none --estimators robust "
                         "--out D/out", True, begun="D/out.part/" + MARK)}


def make_inputs(root, understudy):
    line = (SOURCE / "scenarios/song-bottle.gcode").read_text().splitlines()
    (root / "bead.gcode").write_text("\n".join(line[:20]) + "\n")
    (root / "line.gcode").write_text(LINE)
    (root / "short.yaml").write_text(SCENARIO)
    bottle = (SOURCE / "scenarios/song-bottle.yaml").read_text()
    (root / "bottle.yaml").write_text(bottle.replace("song-bottle.gcode", "bead.gcode").replace("engine: mujoco", "engine: quasistatic"))
    (root / "layer.txt").write_text("".join(f"{x} 5 0 0 0 1\n" for x in range(40)))
    subprocess.run([understudy, *"sample-poses --count 12 --as-built manufactured --seed 5 -o poses.csv".split()], cwd=root, check=True,
                   stdout=subprocess.DEVNULL)


def state_of(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file() and path.name != "filler"}


class Trial:
    """One command on one disk."""

    def __init__(self, command, root, understudy, disk):
        self.command, self.root, self.understudy, self.disk = command, root, understudy, disk
        self.faults = []

    def path(self, name):
        return self.disk / name[2:] if name.startswith("D/") else self.root / name

    def begin(self, limit=None, more=""):
        def prepare():
            signal.signal(signal.SIGINT, signal.SIG_DFL)
            if limit:
                resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        words = (self.command.words + more).replace("D/", f"{self.disk}/").split()
        return subprocess.Popen([self.understudy, *words], cwd=self.root, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                                preexec_fn=prepare)

    def make_old(self):
        process = self.begin()
        errors = process.communicate(timeout=PATIENCE_S)[1]
        if process.returncode not in (0, 1):
            sys.exit(f"{self.command.words}: status {process.returncode}: {errors}")
        self.old = state_of(self.disk)

    def end(self, process, allowed, where):
        errors = process.communicate(timeout=PATIENCE_S)[1]
        lines = [line for line in errors.splitlines() if not line.startswith("goes on with ")]
        if process.returncode not in allowed:
            self.faults.append(f"status {process.returncode}, not {' or '.join(map(str, allowed))}: {errors.strip()}")
        elif process.returncode >= 2 and (len(lines) != 1 or "cannot write" not in lines[0]):
            self.faults.append(f"not one line that says what cannot be written: {errors.strip()}")
        after = state_of(where)
        for name in self.command.may_stay:
            after.pop(name, None)
        if process.returncode >= 2 and after != self.old:
            changed = sorted(name for name in set(after) | set(self.old) if after.get(name) != self.old.get(name))
            self.faults.append(f"the old result is not what it was, or something is left beside it: {changed}")
        if process.returncode < 2 and {n for n in after if "part-" in n or ".part/" in n}:
            self.faults.append("something unfinished is left")
        return process.returncode

    def run(self, allowed, limit=None):
        return self.end(self.begin(limit), allowed, self.disk)


def mount(disk, *options):
    subprocess.run(["mount", "-t", "tmpfs", "-o", ",".join(("size=16m", *options)), "none", str(disk)], check=True)


def fill(disk, pages_free):
    """Leaves room for so many pages."""
    filler = disk / "filler"
    with open(filler, "wb", buffering=0) as file:
        try:
            while file.write(b"\0" * (1 << 16)):
                pass
        except OSError:
            pass
        try:
            while file.write(b"\0" * PAGE):
                pass
        except OSError:
            pass
        os.truncate(filler, os.path.getsize(filler) - pages_free * PAGE)


def full(trial):
    states = []
    for pages in (0, 1, 4):
        fill(trial.disk, pages)
        states.append(trial.run([2, 3] if pages == 0 else [0, 1, 3]))
        (trial.disk / "filler").unlink()
        if states[-1] < 2:
            trial.old = state_of(trial.disk)
    if states[0] != 3:
        trial.faults.append(f"a full disk is no bad input: status {states[0]}")
    return states[0]


def no_room_for_a_name(trial):
    (trial.disk / "names").mkdir()
    made = 0
    try:
        while True:
            (trial.disk / "names" / str(made)).touch()
            made += 1
    except OSError:
        pass
    trial.old = state_of(trial.disk)
    return trial.run([3])


def read_only(trial):
    subprocess.run(["mount", "-o", "remount,ro", str(trial.disk)], check=True)
    return trial.run([2])


def too_large(trial):
    return trial.run([3], limit=SIZE_LIMIT)


def open_when_read(pipe, process):
    """The pipe's other end, as soon as the command reads it; None: it ends without that."""
    while process.poll() is None:
        try:
            return os.open(pipe, os.O_WRONLY | os.O_NONBLOCK)
        except OSError:
            time.sleep(1e-3)
    return None


def vanish_behind_a_pipe(trial, away):
    """While the command waits for its input."""
    source = trial.path(trial.command.pipe)
    text = source.read_bytes()
    source.unlink()
    os.mkfifo(source)
    process = trial.begin()
    descriptor = open_when_read(source, process)
    trial.disk.rename(away)
    if descriptor is not None:
        os.write(descriptor, text)
        os.close(descriptor)
    return process


def vanish_at_work(trial, away):
    """As soon as the command is at work; it is stopped until that has happened."""
    process = trial.begin(more=trial.command.more)
    while process.poll() is None and not trial.path(trial.command.begun).exists():
        time.sleep(1e-3)
    if process.poll() is None:
        process.send_signal(signal.SIGSTOP)
    trial.disk.rename(away)
    process.send_signal(signal.SIGCONT)
    return process


def vanishing(trial):
    """The folder moves away: its name is gone, and what it held can be looked at."""
    if not trial.command.pipe and not trial.command.begun:
        return None  # too quick
    away = trial.disk.with_name("away")
    process = (vanish_at_work if trial.command.begun else vanish_behind_a_pipe)(trial, away)
    # What the run had begun has gone with the folder.
    for part in away.glob("*.part"):
        shutil.rmtree(part)
    status = trial.end(process, trial.command.vanished, away)
    if trial.disk.exists():
        trial.faults.append(f"the folder that vanished is there again, with {sorted(state_of(trial.disk))}")
    return status


def missing(trial):
    """Known before the work, unless the command makes the folder."""
    if trial.command.makes_folder:
        return None
    away = trial.disk.with_name("away")
    trial.disk.rename(away)
    return trial.end(trial.begin(), [2], away)


# name: (the trial, whether it needs a disk of its own, with which options)
FAULTS = {"full": (full, True, ()), "no room for a name": (no_room_for_a_name, True, ("nr_inodes=200",)),
          "read-only": (read_only, True, ()), "too large": (too_large, False, ()), "vanishes": (vanishing, False, ()),
          "missing": (missing, False, ())}


def study(understudy, names, own_disks):
    faults = []
    print(f"{'command':12}" + "".join(f"{name:>20}" for name in FAULTS))
    if not own_disks:
        print("name spaces are not permitted here: no disk of its own; full, no room for a name and read-only were not tried")
    for name in names:
        cells = []
        for fault, (trial_of, own, options) in FAULTS.items():
            if own and not own_disks:
                cells.append("-")
                continue
            with tempfile.TemporaryDirectory(prefix="understudy-disk-") as folder:
                root = Path(folder)
                make_inputs(root, understudy)
                disk = root / "place" / "disk"
                disk.mkdir(parents=True)
                if own:
                    mount(disk, *options)
                try:
                    trial = Trial(COMMANDS[name], root, understudy, disk)
                    trial.make_old()
                    status = trial_of(trial)
                    cells.append("-" if status is None else str(status))
                    faults += [f"{name}, {fault}: {text}" for text in trial.faults]
                finally:
                    if own:
                        subprocess.run(["umount", str(disk)], check=True)
        print(f"{name:12}" + "".join(f"{cell:>20}" for cell in cells), flush=True)
    for text in faults:
        print(text, file=sys.stderr)
    return 1 if faults else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--understudy", required=True)
    parser.add_argument("--command", nargs="+", choices=COMMANDS, default=list(COMMANDS))
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if not arguments.inside:
        spaces = ["unshare", "--user", "--map-root-user", "--mount"]
        if shutil.which("unshare") and subprocess.run([*spaces, "mount", "-t", "tmpfs", "none", "/mnt"], check=False,
                                                      stderr=subprocess.DEVNULL).returncode == 0:
            os.execvp(spaces[0], [*spaces, sys.executable, __file__, *sys.argv[1:], "--inside"])
    return study(os.path.abspath(arguments.understudy), arguments.command, arguments.inside)


if __name__ == "__main__":
    sys.exit(main())
