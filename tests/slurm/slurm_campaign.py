#!/usr/bin/env python3
"""Runs campaigns on a cluster of two nodes on this machine, and compares their tables with those of a local run.

smoke   20 runs; and the jobs of a campaign whose watcher was killed are found again
death   200 runs, and one of the two nodes dies in the middle, with all that runs on it
cancel  Ctrl-C takes the jobs out of the queue; --resume ends the campaign

usage: slurm_campaign.py (smoke|death|cancel) --understudy PROGRAM
"""
import argparse
import contextlib
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from cluster import Cluster, Unavailable

TABLES = ("table.csv", "campaign.json", "campaign.html")
SKIPPED = 77


def write_campaign(folder, seeds):
    (folder / "line.gcode").write_text("M104 S230\nG1 X0 Y0 Z60 F3000\nG1 X4 Y0 Z60 E0.3 F600\n")
    (folder / "s.yaml").write_text(
        "name: line\ndescription: d\nsource: s\nmachine: hexapod\nprogram: line.gcode\nas_built: sampled\nseed: 1\n"
        "gap_control: off\nengine: quasistatic\nexpect:\n  - {metric: verdict, equals: go, source: a test}\n")
    (folder / "c.yaml").write_text(
        f"name: line\nscenarios: [s.yaml]\nseeds: 1-{seeds}\nparameters:\n"
        "  - {key: machine.accuracy.tip_mm, values: [0.1, 0.5]}\nmetrics: [accuracy.tip_p95_um]\n")


class Trial:
    def __init__(self, program, folder, cluster, seeds):
        self.program, self.folder, self.cluster = program, folder, cluster
        write_campaign(folder, seeds)
        self.local = self.run("local")

    def words(self, out, *more):
        return [self.program, "campaign", str(self.folder / "c.yaml"), "--out", str(self.folder / out), *more]

    def start(self, out, *more):
        return subprocess.Popen(self.words(out, *more), env=self.cluster.environment(), stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def run(self, out, *more):
        begin = time.time()
        process = self.start(out, *more)
        told, _ = process.communicate(timeout=900)
        if process.returncode != 0:
            sys.exit(f"{out}: exit {process.returncode}: {told}")
        print(f"{out} {' '.join(more)}: {time.time() - begin:.1f} s", flush=True)
        return told

    def rows(self, out):
        count = 0
        for file in [self.folder / out / "runs.sqlite", *(self.folder / out / "parts").glob("*.sqlite")]:
            try:
                with contextlib.closing(sqlite3.connect(file, timeout=0)) as store:
                    count += store.execute("SELECT count(*) FROM runs").fetchone()[0]
            except sqlite3.Error:
                pass  # it is being written
        return count

    def same_tables(self, out):
        for table in TABLES:
            if (self.folder / "local" / table).read_bytes() != (self.folder / out / table).read_bytes():
                sys.exit(f"{table} of {out} is not that of the local run")
        print(f"{out}: the tables are those of the local run", flush=True)

    def queue(self):
        return self.cluster.run(["squeue", "-h", "--array", "-o", "%i %T"]).stdout.split("\n")[:-1]


def smoke(trial):
    trial.run("slurm", "--slurm", "--tasks", "2")
    trial.same_tables("slurm")
    trial.run("detached", "--slurm", "--tasks", "2", "--detach")
    if not trial.queue():
        sys.exit("nothing is in the queue")
    trial.run("detached", "--slurm", "--resume")
    trial.same_tables("detached")


def death(trial):
    process = trial.start("slurm", "--slurm", "--tasks", "8")
    end = time.time() + 120
    while trial.rows("slurm") < 30 and time.time() < end:
        time.sleep(0.2)
    done = trial.rows("slurm")
    running = [line for line in trial.queue() if "RUNNING" in line]
    trial.cluster.kill_node("n1")
    print(f"n1 died at {done} runs or more, with {len(running)} jobs running", flush=True)
    told, _ = process.communicate(timeout=900)
    if process.returncode != 0:
        sys.exit(f"exit {process.returncode}: {told}")
    trial.same_tables("slurm")


def cancel(trial):
    process = trial.start("slurm", "--slurm", "--tasks", "8")
    end = time.time() + 60
    while not trial.queue() and time.time() < end:
        time.sleep(0.2)
    time.sleep(2)
    process.send_signal(signal.SIGINT)
    told, _ = process.communicate(timeout=60)
    if process.returncode != -signal.SIGINT or "cancelled" not in told:
        sys.exit(f"exit {process.returncode}: {told}")
    end = time.time() + 60
    while trial.queue() and time.time() < end:
        time.sleep(0.5)
    if trial.queue():
        sys.exit(f"jobs are left: {trial.queue()}")
    trial.run("slurm", "--slurm", "--resume")
    trial.same_tables("slurm")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("trial", choices=("smoke", "death", "cancel"))
    parser.add_argument("--understudy", required=True)
    options = parser.parse_args()
    seeds, work = {"smoke": (10, smoke), "death": (100, death), "cancel": (100, cancel)}[options.trial]
    try:
        with Cluster() as cluster, tempfile.TemporaryDirectory(prefix="understudy-campaign-%a-") as folder:
            work(Trial(str(Path(options.understudy).resolve()), Path(folder), cluster, seeds))
    except Unavailable as why:
        print(f"skipped: {why}")
        return SKIPPED
    return 0


if __name__ == "__main__":
    sys.exit(main())
