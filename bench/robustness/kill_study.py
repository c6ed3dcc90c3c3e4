#!/usr/bin/env python3
"""Kills commands at random moments and looks at what lies under the names of their results.

Each command has an old result, is begun again with other input, and gets the signal: at a moment spread over its duration, within
its last 50 ms, or while it puts the new result in its place. Then the old result or the new one must lie there whole (its manifest
holds; a single file has the bytes of the old one or of the new one), and files of the user beside it must be untouched. A run
into the same place must be accepted, complete, and leave nothing else. After TERM and INT the command must end within a second
of the signal, with nothing unfinished left; where other programs keep it from the processor, within a second of its own.

usage: kill_study.py --understudy PATH [--command NAME...] [--runs N] [--seed S] [--signal KILL|TERM|INT]
Exit status: 1 where anything of this does not hold.
"""
import argparse
import hashlib
import json
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
MARK = ".understudy-unfinished"  # in a folder, for the next run only
MANIFEST = "manifest.sha256"
USERS = {"results/out-notes/thesis.tex": "precious", "results/.calibrated.part.yaml": "mine",
         "results/.calibrated.yaml.part-notes": "mine", "results/out.parts": "mine"}
PATIENCE_S = 120  # for a run that nothing ends
LAST_S = 0.05
PLACING_S = 0.002  # from a written manifest on
PROMISED_S = 1.0  # to end after TERM or INT
CROWDED_S = 10.0  # the same, beside other programs that take the processors


@dataclass
class Command:
    words: object  # of variant 0 or 1
    folders: list = field(default_factory=list)
    files: list = field(default_factory=list)
    exact: list = field(default_factory=list)  # files of the folders that are the same in every run of a variant
    may_stay: list = field(default_factory=list)  # after a kill
    beside: list = field(default_factory=list)  # what runs into one place go on with


RESULT = "results/out"
COMMANDS = {
    "rehearse": Command(lambda v: f"rehearse line.gcode --fixture bottle --engine quasistatic --no-pictures --seed {4 + v} --out {RESULT}",
                        [RESULT], exact=["trace.csv", "as-built.yaml"]),
    "sweep": Command(lambda v: f"sweep bottle.yaml --samples 3 -j 2 --first-seed {4 + v} --out {RESULT}", [RESULT],
                     exact=["sweep.csv", "table.txt"], may_stay=["results/out.journal"]),
    "scenario": Command(lambda v: f"scenario run {v}/short.yaml --out {RESULT} --junit results/junit.xml", [RESULT + "/short"],
                        ["results/junit.xml"], exact=["trace.csv", "as-built.yaml"],
                        beside=[RESULT + name for name in ("/index.html", "/history.jsonl", "/outcomes", "/outcomes/short.yaml")]),
    "calibrate": Command(lambda v: f"calibrate poses{v}.csv -o results/calibrated.yaml --report {RESULT}", [RESULT],
                         ["results/calibrated.yaml"]),
    "benchmark": Command(lambda v: f"benchmark calibration --trials 6 -j 2 --poses 12 --noise 20um:0.2mrad --disturbances none "
                         f"--seed {4 + v} --out {RESULT}", [RESULT])}

SHORT = """name: short
description: A short move above the table.
source: none
machine: five-axis
program: ../move.gcode
as_built: sampled
seed: {seed}
gap_control: "off"
engine: quasistatic
expect:
  - {{metric: print.duration_s, min: 0.01, unit: s, source: "it moves"}}
"""
MOVE = "G21\nG90\nM82\nG0 X0 Y0 Z60 F3000\nG1 X2 Y0 Z60 F600\n"


def make_inputs(root, understudy):
    line = (SOURCE / "scenarios/song-bottle.gcode").read_text().splitlines()
    (root / "line.gcode").write_text("\n".join(line[:20]) + "\n")
    bottle = (SOURCE / "scenarios/song-bottle.yaml").read_text()
    for old, new in (("song-bottle.gcode", "line.gcode"), ("engine: mujoco", "engine: quasistatic")):
        assert old in bottle, f"song-bottle.yaml lacks {old}"
        bottle = bottle.replace(old, new)
    (root / "bottle.yaml").write_text(bottle)
    (root / "move.gcode").write_text(MOVE)
    for variant in (0, 1):
        (root / str(variant)).mkdir()
        (root / str(variant) / "short.yaml").write_text(SHORT.format(seed=4 + variant))
        subprocess.run([understudy, *f"sample-poses --count 12 --as-built manufactured --seed {5 + variant}".split(), "-o",
                        f"poses{variant}.csv"], cwd=root, check=True, stdout=subprocess.DEVNULL)
    for name, text in USERS.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)


def masked(name, data):
    """Without what the clock says."""
    return re.sub(rb'time="[0-9.]*"', b"", data) if name.endswith(".xml") else data


def bytes_in(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*"))
            if path.is_file() and path.name != MARK}


def state_of(root, command):
    """What lies under the final names; None: nothing does."""
    state = {name: bytes_in(root / name) if (root / name).is_dir() else None for name in command.folders}
    return state | {name: {"": (root / name).read_bytes()} if (root / name).is_file() else None for name in command.files}


def fault_of_folder(files):
    """Why the folder is no whole result; empty: it is one."""
    named = {}
    for line in files.get(MANIFEST, b"").decode().splitlines():
        named[line[66:]] = line[:64]
    if set(files) - {MANIFEST} != set(named) or not named:
        return f"its manifest names {sorted(named)}, it holds {sorted(files)}"
    for name, digest in named.items():
        if hashlib.sha256(files[name]).hexdigest() != digest:
            return f"{name} is not what the manifest says"
        if name.endswith(".json"):
            json.loads(files[name])
    return ""


def is_new(name, files, command, reference):
    """Whole, and of the variant that was run."""
    if name in command.files:
        return masked(name, files[""]) == masked(name, reference[name][""])
    return (fault_of_folder(files) == "" and set(files) == set(reference[name])
            and all(files[f] == reference[name][f] for f in command.exact))


def processor_seconds(pid):
    """Of a process that runs, or has ended and was not waited for."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Study:
    def __init__(self, name, understudy, root, random_source, number):
        self.command, self.understudy, self.root, self.random, self.signal = COMMANDS[name], understudy, root, random_source, number
        self.counts = dict.fromkeys(("kills", "old result", "new result", "lost", "unreadable", "left after next run"), 0)
        self.faults, self.slowest_end, self.slowest_own = [], 0.0, 0.0
        make_inputs(root, understudy)
        self.inputs = self.entries()
        self.references, self.durations = {}, []
        for variant in (1, 0):
            self.complete(variant)
            self.references[variant] = state_of(root, self.command)
        self.lies_there = 0

    def entries(self):
        return {path.relative_to(self.root).as_posix() for path in self.root.rglob("*")}

    def begin(self, variant):
        # A shell's background job would ignore SIGINT, and hand that on.
        return subprocess.Popen([self.understudy, *self.command.words(variant).split()], cwd=self.root, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True,
                                preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))

    def fault(self, kind, text):
        self.counts[kind] += 1
        self.faults.append(f"{kind}: {text}")

    def complete(self, variant):
        """A run that nothing ends: accepted, whole, and alone with the user's files."""
        began = time.monotonic()
        process = self.begin(variant)
        errors = process.communicate(timeout=PATIENCE_S)[1]
        self.durations.append(time.monotonic() - began)
        if process.returncode not in (0, 1):
            self.fault("unreadable", f"the next run ends with {process.returncode}: {errors.strip()}")
            return
        state = state_of(self.root, self.command)
        if self.references.get(variant):
            for name, files in state.items():
                if files is None or not is_new(name, files, self.command, self.references[variant]):
                    self.fault("unreadable", f"{name} of the next run is not whole, or not what it is without a kill")
        self.look_at_the_rest(allowed=set())
        self.lies_there = variant

    def look_at_the_rest(self, allowed):
        """Nothing beside inputs and results but what may stay, and the user's files as they were."""
        for name, text in USERS.items():
            path = self.root / name
            if not path.is_file() or path.read_text() != text:
                self.fault("lost", f"{name}, a file of the user")
        results = tuple(self.command.folders + self.command.files)
        parents = {parent.as_posix() for name in results for parent in Path(name).parents}
        strange = {name for name in self.entries() - self.inputs - allowed - parents - set(self.command.beside)
                   if not any(name == r or name.startswith(r + "/") for r in results)}
        marks = {name for name in self.entries() if Path(name).name == MARK}
        for name in sorted(strange | marks):
            self.fault("left after next run", name)

    def moment(self):
        """[s] after the beginning, and whether the clock starts when the new result is about to take its place."""
        duration = sorted(self.durations)[len(self.durations) // 2]
        kind = self.random.random()
        if kind < 0.5:
            return self.random.uniform(0, duration), False
        if kind < 0.7:
            return max(0.0, duration - self.random.uniform(0, LAST_S)), False
        return self.random.uniform(0, PLACING_S), True

    def kill(self, variant):
        """False: the run had ended before."""
        after, from_placing = self.moment()
        process = self.begin(variant)
        began = time.monotonic()
        if from_placing:
            manifest = self.root / (self.command.folders[0] + ".part") / MANIFEST
            while process.poll() is None and not manifest.exists():
                time.sleep(1e-4)
            began = time.monotonic()
        while process.poll() is None and time.monotonic() - began < after:
            time.sleep(min(1e-3, max(0.0, after - (time.monotonic() - began))))
        if process.poll() is None:
            process.send_signal(self.signal)
        sent = time.monotonic()
        errors, own = self.end_of(process)
        if process.returncode in (0, 1):
            self.lies_there = variant
            return False
        self.counts["kills"] += 1
        if process.returncode != -self.signal:
            self.fault("unreadable", f"ends with {process.returncode}: {errors.strip()}")
        elif self.signal != signal.SIGKILL:
            self.slowest_end = max(self.slowest_end, time.monotonic() - sent)
            self.slowest_own = max(self.slowest_own, own)
        self.look_at(variant)
        return True

    def end_of(self, process):
        """What it printed, and the seconds of processor that it took from now on."""
        if process.returncode is not None:  # it was waited for
            return process.communicate()[1], 0.0
        used = processor_seconds(process.pid)
        errors = process.stderr.read()  # until it ends
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
        own = processor_seconds(process.pid) - used
        process.communicate(timeout=PATIENCE_S)
        return errors, own

    def look_at(self, variant):
        new = self.references[variant]
        replaced = []
        for name, files in state_of(self.root, self.command).items():
            if files is None:
                self.fault("lost", f"nothing lies under {name}")
            elif files == self.before[name]:
                replaced.append(False)
            elif is_new(name, files, self.command, new):
                replaced.append(True)
            else:
                kind = "lost" if name in self.command.files else "unreadable"
                self.fault(kind, f"{name} is neither the old result nor the new one: {fault_of_folder(files) if kind != 'lost' else ''}")
        self.counts["new result" if any(replaced) else "old result"] += 1
        if replaced and all(replaced):
            self.lies_there = variant
        for name in USERS:
            if not (self.root / name).is_file():
                self.fault("lost", f"{name}, a file of the user")
        if self.signal != signal.SIGKILL:
            self.look_at_the_rest(allowed=set(self.command.may_stay))

    def run(self, kills):
        began = 0
        while self.counts["kills"] < kills and began < 4 * kills + 20:
            began += 1
            self.before = state_of(self.root, self.command)
            # After the old result the same variant again: a journal is gone on with.
            killed = self.kill(1 - self.lies_there)
            if killed and (self.counts["kills"] % 10 == 0 or self.counts["kills"] == kills):
                self.complete(1 - self.lies_there)
        if self.counts["kills"] < kills:
            self.faults.append(f"only {self.counts['kills']} of {kills} runs were still going on when their moment came")
        if self.slowest_end > (PROMISED_S if self.slowest_own > PROMISED_S else CROWDED_S):
            self.faults.append(f"it took {self.slowest_end:.2f} s to end, {self.slowest_own:.2f} s of them on a processor")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--understudy", required=True)
    parser.add_argument("--command", nargs="+", choices=COMMANDS, default=list(COMMANDS))
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--signal", choices=("KILL", "TERM", "INT"), default="KILL")
    arguments = parser.parse_args()
    number = signal.Signals["SIG" + arguments.signal]
    faults = []
    print(f"{'command':10} {'kills':>6} {'old result':>11} {'new result':>11} {'lost':>5} {'unreadable':>11} {'left after next run':>20}"
          + ("" if number == signal.SIGKILL else f" {'slowest end s':>14} {'of processor':>13}"))
    for name in arguments.command:
        with tempfile.TemporaryDirectory(prefix="understudy-kill-") as folder:
            study = Study(name, os.path.abspath(arguments.understudy), Path(folder), random.Random(f"{arguments.seed} {name}"), number)
            study.run(arguments.runs)
        c = study.counts
        print(f"{name:10} {c['kills']:6} {c['old result']:11} {c['new result']:11} {c['lost']:5} {c['unreadable']:11} "
              f"{c['left after next run']:20}"
              + ("" if number == signal.SIGKILL else f" {study.slowest_end:14.2f} {study.slowest_own:13.2f}"), flush=True)
        faults += [f"{name}: {text}" for text in study.faults]
    for text in faults[:50]:
        print(text, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
