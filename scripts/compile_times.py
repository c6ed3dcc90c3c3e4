#!/usr/bin/env python3
"""How long each source took to compile, from the .ninja_log of a build folder.

    scripts/compile_times.py [BUILD] [--top N] [--again N] [--limit SECONDS]

BUILD is build/release where none is given. The log holds wall-clock times: of a build from nothing, on an idle machine
and without a cache of objects (rm -rf build/release; CCACHE_DISABLE=1 ./test), they are what a source costs. --again
compiles the N slowest anew, one after the other, and prints their processor time, which hardly depends on what else
runs. With --limit a source above it is named and the status is 1.
"""
import argparse
import json
import os
import pathlib
import re
import resource
import shlex
import subprocess
import sys

OBJECT = re.compile(r"^(.*/)?CMakeFiles/[^/]+\.dir/(.+)\.o$")


def logged(build):
    """Source -> seconds of its last compilation."""
    log = build / ".ninja_log"
    if not log.is_file():
        sys.exit(f"compile_times: no {log}: build first")
    seconds = {}
    for line in log.read_text().splitlines():
        words = line.split("\t")
        found = OBJECT.match(words[3]) if len(words) > 3 else None
        if found:
            seconds[os.path.normpath((found.group(1) or "") + found.group(2).replace("__", ".."))] = (int(words[1]) - int(words[0])) / 1000
    return seconds


def processor_time(entry):
    words = shlex.split(entry["command"])
    words[words.index("-o") + 1] = "/dev/null"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(words, cwd=entry["directory"], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def main():
    parser = argparse.ArgumentParser(description="How long each source took to compile.")
    parser.add_argument("build", nargs="?", default="build/release", type=pathlib.Path)
    parser.add_argument("--top", default=15, type=int, help="how many of the slowest to print (15)")
    parser.add_argument("--again", default=0, type=int, help="how many of the slowest to compile anew")
    parser.add_argument("--limit", type=float, help="seconds that none may take longer")
    arguments = parser.parse_args()
    seconds = logged(arguments.build)
    slowest = sorted(seconds, key=seconds.get, reverse=True)
    print(f"{len(seconds)} sources, {sum(seconds.values()):.0f} s of compilation")
    if arguments.again:
        entries = {os.path.relpath(entry["file"]): entry
                   for entry in json.loads((arguments.build / "compile_commands.json").read_text())}
        seconds = {name: processor_time(entries[name]) for name in slowest[:arguments.again] if name in entries}
        slowest = sorted(seconds, key=seconds.get, reverse=True)
    for name in slowest[:arguments.top]:
        print(f"{seconds[name]:7.1f} s  {name}")
    over = [name for name in slowest if arguments.limit and seconds[name] > arguments.limit]
    for name in over:
        print(f"compile_times: {name}: {seconds[name]:.1f} s is longer than {arguments.limit:g} s", file=sys.stderr)
    return 1 if over else 0


sys.exit(main())
