#!/usr/bin/env python3
"""How long each source took to compile, from the .ninja_log of a build folder.

    scripts/compile_times.py [BUILD] [--top N] [--again N] [--apart TARGET] [--limit SECONDS]

BUILD is build/release where none is given. The log holds wall-clock times: of a build from nothing, on an idle machine
and without a cache of objects (rm -rf build/release; CCACHE_DISABLE=1 ./test), they are what a source costs. --again
compiles the N slowest anew, one after the other, and prints their processor time, which hardly depends on what else
runs. --apart compiles what is compiled together in a target (as in 'cli_test Unity/unity_1') once together and once
one by one. With --limit a source above it is named and the status is 1.
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

OBJECT = re.compile(r"^(.*/)?CMakeFiles/([^/]+)\.dir/(.+)\.o$")


def source_of(output):
    """The source of an object; of sources that are compiled together, target and number."""
    folder, target, source = OBJECT.match(output).groups()
    if "Unity/" in source:
        return f"{target} {source}"
    return os.path.normpath((folder or "") + source.replace("__", ".."))


def logged(build):
    """Object -> seconds of its last compilation, of those that the build still has."""
    log = build / ".ninja_log"
    if not log.is_file():
        sys.exit(f"compile_times: no {log}: build first")
    entries = entries_of(build)
    seconds = {}
    for line in log.read_text().splitlines():
        words = line.split("\t")
        if len(words) > 3 and words[3] in entries:
            seconds[words[3]] = (int(words[1]) - int(words[0])) / 1000
    return seconds


def entries_of(build):
    """Object -> its compile command."""
    entries = json.loads((build / "compile_commands.json").read_text())
    named = {re.search(r" -o (\S+)", entry["command"])[1]: entry for entry in entries}
    return {output: entry for output, entry in named.items() if OBJECT.match(output)}


def together_and_apart(entry):
    """Processor seconds of sources that are compiled together, and of each of them with the same command."""
    sources = re.findall(r'#include "([^"]+)"', pathlib.Path(entry["file"]).read_text())
    apart = [processor_time({**entry, "command": entry["command"].replace(entry["file"], source)}) for source in sources]
    return processor_time(entry), sum(apart), len(sources)


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
    parser.add_argument("--apart", default=[], action="append", metavar="TARGET", help="time sources that are compiled together also one by one")
    parser.add_argument("--limit", type=float, help="seconds that none may take longer")
    arguments = parser.parse_args()
    seconds = logged(arguments.build)
    slowest = sorted(seconds, key=seconds.get, reverse=True)
    print(f"{len(seconds)} compilations, {sum(seconds.values()):.0f} s")
    entries = entries_of(arguments.build)
    for part in arguments.apart:
        for output in (o for o in sorted(entries) if part in source_of(o) and "Unity/" in o):
            together, apart, count = together_and_apart(entries[output])
            print(f"{source_of(output)}: {count} sources, together {together:.0f} s, apart {apart:.0f} s")
    if arguments.apart:
        return 0
    if arguments.again:
        seconds = {name: processor_time(entries[name]) for name in slowest[:arguments.again]}
        slowest = sorted(seconds, key=seconds.get, reverse=True)
    for name in slowest[:arguments.top]:
        print(f"{seconds[name]:7.1f} s  {source_of(name)}")
    over = [name for name in slowest if arguments.limit and seconds[name] > arguments.limit]
    for name in over:
        print(f"compile_times: {source_of(name)}: {seconds[name]:.1f} s is longer than {arguments.limit:g} s", file=sys.stderr)
    return 1 if over else 0


sys.exit(main())
