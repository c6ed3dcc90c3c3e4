#!/usr/bin/env python3
"""Gives commands changed inputs, and looks at the answers.

Each input is a good one with a number, a word, lines or bytes changed, or cut off; with --inputs it is one that `./fuzz` keeps. A
command must end within its time, and not by a signal. A refusal (status 2) is one line that names the input, and leaves nothing
behind. What is accepted can be used: a rehearsal's folder is whole, its figures are numbers, a no-go has its reason, and the
result of a planner or a calibration goes through a rehearsal or `axes` of its own, which again answers or refuses. No input ends
a command with status 3, but a built machine that cannot do what the program asks: the line names its file.

usage: input_study.py --understudy PATH [--reader NAME...] [--runs N] [--seed S] [--inputs FOLDER] [--keep FOLDER]
  --inputs FOLDER  take FOLDER/READER/* (or FOLDER/READER/corpus/*) instead of changed inputs
  --keep FOLDER    put inputs with a fault there
Exit status: 1 where anything of this does not hold.
"""
import argparse
import collections
import os
import random
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from changed_input import changed
from input_readers import READERS
from input_trial import KINDS, Trial, good_input


def inputs_of(arguments, name):
    """(kind of change, number of the case, bytes) of each trial."""
    cases = READERS[name]
    if arguments.inputs:
        folder = Path(arguments.inputs) / name
        files = sorted(path for path in folder.glob("corpus/*" if (folder / "corpus").is_dir() else "*") if path.is_file())
        random.Random(f"{arguments.seed} {name}").shuffle(files)
        for i, path in enumerate(files[:arguments.runs]):
            yield "kept", i % len(cases), path.read_bytes()
        return
    for i in range(arguments.runs):
        source = random.Random(f"{arguments.seed} {name} {i}")
        case = i % len(cases)
        kind, data = changed(source, good_input(arguments.understudy, cases[case]))
        yield kind, case, data


def unchanged_faults(arguments, names):
    """A case whose good input is refused tells nothing of changed ones."""
    for name in names:
        for number, case in enumerate(READERS[name]):
            trial = Trial(arguments.understudy, case, good_input(arguments.understudy, case))
            trial.run()
            for fault in [*trial.faults, *([] if trial.outcome in ("good", "no") else [f"{trial.outcome}: {trial.errors.strip()}"])]:
                yield f"{name}, case {number}, unchanged: {fault}"


def keep(folder, name, number, data):
    place = Path(folder) / name
    place.mkdir(parents=True, exist_ok=True)
    (place / str(number)).write_bytes(data)


def study(arguments, name):
    """The row of a reader, and its faults."""
    def one(task):
        kind, case, data = task
        trial = Trial(arguments.understudy, READERS[name][case], data)
        trial.run()
        return kind, trial
    counts, kinds, faults, slowest = collections.Counter(), collections.Counter(), [], 0.0
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for number, (kind, trial) in enumerate(pool.map(one, inputs_of(arguments, name))):
            counts[trial.outcome] += 1
            kinds[kind] += 1
            slowest = max(slowest, trial.seconds)
            for fault in trial.faults:
                faults.append(f"{name} {number} ({kind}): {fault}")
            if trial.faults and arguments.keep:
                keep(arguments.keep, name, number, trial.data)
    print(f"{name:14}{sum(counts.values()):7}" + "".join(f"{counts[kind]:9}" for kind in KINDS) + f"{slowest:11.1f}  "
          + ", ".join(f"{kind} {n}" for kind, n in sorted(kinds.items())), flush=True)
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--understudy", required=True)
    parser.add_argument("--reader", nargs="+", choices=READERS, default=list(READERS))
    parser.add_argument("--runs", type=int, default=20, help="of each reader")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--inputs")
    parser.add_argument("--keep")
    arguments = parser.parse_args()
    arguments.understudy = os.path.abspath(arguments.understudy)
    faults = list(unchanged_faults(arguments, arguments.reader))
    print(f"{'reader':14}{'inputs':>7}" + "".join(f"{kind:>9}" for kind in KINDS) + f"{'slowest s':>11}  changes")
    for name in arguments.reader:
        faults += study(arguments, name)
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
