#!/usr/bin/env python3
"""The hexapod's inverse kinematics of many poses from NumPy against C++, in one run: turns are taken, the shortest of
each counts. Then two threads against one, with what the memory gives.

    PYTHONPATH=build/release/python bench/python/batch.py [POSE_ARRAY_BENCH] [--turns N]
"""
import csv
import io
import statistics
import subprocess
import sys
import time

import numpy as np

import understudy

GOAL = 1.2  # times of C++


def of_cpp(program, rows):
    run = subprocess.run([program, str(rows), "--repeat", "5"], capture_output=True, text=True, check=True)
    return {(row["layout"], int(row["threads"])): (float(row["ns"]), float(row["gb_per_s"]))
            for row in csv.DictReader(io.StringIO(run.stdout))}


def of_numpy(machine, poses, out, threads, repeat=5):
    best = 1e9
    for _ in range(repeat):
        start = time.perf_counter()
        machine.axes(poses, out=out, threads=threads)
        best = min(best, time.perf_counter() - start)
    return 1e9 * best / len(poses)


def measure(program, machine, rows, turns):
    random = np.random.default_rng(1)
    poses = np.tile(machine.home, (rows, 1))
    poses[:, :3] += random.uniform(-0.02, 0.02, (rows, 3))
    out = np.empty((rows, 6))
    mine, theirs = {1: [], 2: []}, {}
    for _ in range(turns):
        for key, figures in of_cpp(program, rows).items():
            theirs.setdefault(key, []).append(figures)
        for threads in mine:
            mine[threads].append(of_numpy(machine, poses, out, threads))
    best = {key: min(ns for ns, _ in figures) for key, figures in theirs.items()}
    rate = {key: max(gb for _, gb in figures) for key, figures in theirs.items()}
    here = {threads: min(values) for threads, values in mine.items()}
    print(f"{rows:8} poses: NumPy {here[1]:.1f} ns a pose, C++ {best['poses', 1]:.1f} (4 x 4 matrices), "
          f"{best['rows', 1]:.1f} (rows): {here[1] / best['poses', 1]:.2f} and {here[1] / best['rows', 1]:.2f} times")
    print(f"{'':8} two threads over one: NumPy {here[1] / here[2]:.2f}, C++ {best['poses', 1] / best['poses', 2]:.2f}, "
          f"{best['rows', 1] / best['rows', 2]:.2f}; memory {best['copy', 1] / best['copy', 2]:.2f} "
          f"({rate['copy', 1]:.1f} and {rate['copy', 2]:.1f} GB/s; C++ moves {rate['poses', 1]:.1f} and "
          f"{rate['poses', 2]:.1f}, rows {rate['rows', 1]:.1f} and {rate['rows', 2]:.1f})")
    return here[1] / best["poses", 1]


def main(arguments):
    turns = int(arguments.pop(arguments.index("--turns") + 1)) if "--turns" in arguments else 5
    programs = [word for word in arguments if not word.startswith("--")]
    program = programs[0] if programs else "build/release/bench/kinematics/pose_array_bench"
    machine = understudy.Machine("hexapod")
    ratios = [measure(program, machine, rows, turns) for rows in (10_000, 100_000, 1_000_000)]
    worst = max(ratios)
    print(f"goal {GOAL}: {'met' if worst <= GOAL else 'MISSED'}, {worst:.2f} at worst, {statistics.median(ratios):.2f} "
          "in the middle")
    return 0 if worst <= GOAL else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
