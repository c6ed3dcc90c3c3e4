#!/usr/bin/env python3
"""What campaigns cost, measured on this machine.

workers   the bottle's line on N machines with 1 and with 2 workers: wall time, ratio, agreement of the tables; and the
          same N machines twice at once, by two commands that share nothing: the ratio that this computer can reach
overhead  cheap runs: wall time beyond the runs' own, per run; bytes of a row; merging
model     from `overhead`: a million runs on a thousand processors

usage: campaign_figures.py --understudy PROGRAM [--runs N] [--engine quasistatic|mujoco] [workers|overhead|model ...]
"""
import argparse
import os
import sqlite3
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]


def campaign(program, folder, name, out, workers):
    begin, before = time.time(), os.times()
    done = subprocess.run([program, "campaign", folder / f"{name}.yaml", "--workers", str(workers), "--out", folder / out],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(done.stdout)
    after = os.times()
    cpu = after.children_user + after.children_system - before.children_user - before.children_system
    with sqlite3.connect(folder / out / "runs.sqlite") as store:
        runs, seconds = store.execute("SELECT count(*), sum(seconds) FROM runs").fetchone()
    return {"wall": time.time() - begin, "cpu": cpu, "runs": runs, "seconds": seconds,
            "bytes": (folder / out / "runs.sqlite").stat().st_size}


def same(folder, a, b):
    return all((folder / a / t).read_bytes() == (folder / b / t).read_bytes() for t in ("table.csv", "campaign.json", "campaign.html"))


def workers(program, folder, runs, engine):
    scenario = SOURCE / "scenarios/song-bottle.yaml"
    (folder / "bottle.yaml").write_text(
        f"name: bottle\nscenarios: ['{os.path.relpath(scenario, folder)}']\nseeds: 1-{runs}\nparameters:\n"
        f"  - {{key: scenario.engine, values: [{engine}]}}\nmetrics: [gap.start_mm]\n")
    one = campaign(program, folder, "bottle", "one", 1)
    two = campaign(program, folder, "bottle", "two", 2)
    with ThreadPoolExecutor(2) as pool:
        apart = list(pool.map(lambda out: campaign(program, folder, "bottle", out, 1), ("apart-1", "apart-2")))
    limit = 2 * one["wall"] / max(a["wall"] for a in apart)
    print(f"bottle, {engine}, {runs} machines: 1 worker {one['wall']:.1f} s ({one['cpu']:.1f} s of processor), "
          f"2 workers {two['wall']:.1f} s ({two['cpu']:.1f} s); ratio {one['wall'] / two['wall']:.2f}, of two separate commands {limit:.2f}; "
          f"tables {'equal' if same(folder, 'one', 'two') else 'DIFFER'}")


def overhead(program, folder, runs, _engine):
    (folder / "line.gcode").write_text("M104 S230\nG1 X0 Y0 Z60 F3000\nG1 X1 Y0 Z60 E0.08 F600\n")
    (folder / "s.yaml").write_text(
        "name: line\ndescription: d\nsource: s\nmachine: hexapod\nprogram: line.gcode\nas_built: sampled\nseed: 1\n"
        "gap_control: off\nengine: quasistatic\nexpect:\n  - {metric: verdict, equals: go, source: a bench}\n")
    (folder / "line.yaml").write_text(f"name: line\nscenarios: [s.yaml]\nseeds: 1-{runs}\n")
    got = campaign(program, folder, "line", "line", 1)
    beyond = (got["wall"] - got["seconds"]) / got["runs"]
    print(f"cheap runs, {got['runs']}: {1e3 * got['seconds'] / got['runs']:.1f} ms a run, {1e3 * beyond:.1f} ms beyond "
          f"it with 1 worker (start, store, merge and tables); {got['bytes'] / got['runs']:.0f} bytes a row")
    return beyond, got["bytes"] / got["runs"]


def model(program, folder, runs, engine):
    beyond, size = overhead(program, folder, runs, engine)
    million, processors = 1_000_000, 1000
    print(f"a million runs on {processors} processors: {beyond * million / processors:.0f} s of overhead on each, "
          f"{size * million / 1e9:.1f} GB of store")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--understudy", required=True)
    parser.add_argument("--runs", type=int, default=200)
    parser.add_argument("--engine", default="quasistatic")
    parser.add_argument("what", nargs="*", default=["workers", "overhead"])
    options = parser.parse_args()
    program = str(Path(options.understudy).resolve())
    for what in options.what:
        with tempfile.TemporaryDirectory(prefix="understudy-bench-") as folder:
            {"workers": workers, "overhead": overhead, "model": model}[what](program, Path(folder), options.runs, options.engine)


if __name__ == "__main__":
    main()
