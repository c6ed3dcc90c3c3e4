#!/usr/bin/env python3
"""How long each source took to compile, from the .ninja_log of a build folder.

    scripts/compile_times.py [BUILD] [--top N] [--limit SECONDS]

BUILD is build/release where none is given. Prints the sum and the N slowest sources; with --limit exits 1 if one took
longer, naming it. Measure on an idle machine, from nothing, and without a cache of objects:

    rm -rf build/release; CCACHE_DISABLE=1 ./test
"""
import argparse
import pathlib
import re
import sys

OBJECT = re.compile(r"(?:^|/)CMakeFiles/[^/]+\.dir/(.+)\.o$")


def compilations(log):
    """Source -> seconds of its last compilation."""
    seconds = {}
    for line in log.read_text().splitlines():
        words = line.split("\t")
        if len(words) < 4 or not OBJECT.search(words[3]):
            continue
        folder = words[3][:words[3].index("CMakeFiles/")]
        seconds[folder + OBJECT.search(words[3]).group(1)] = (int(words[1]) - int(words[0])) / 1000
    return seconds


def main():
    parser = argparse.ArgumentParser(description="How long each source took to compile, from .ninja_log.")
    parser.add_argument("build", nargs="?", default="build/release", type=pathlib.Path)
    parser.add_argument("--top", default=15, type=int, help="how many of the slowest (15)")
    parser.add_argument("--limit", type=float, help="seconds that none may take longer")
    arguments = parser.parse_args()
    log = arguments.build / ".ninja_log"
    if not log.is_file():
        sys.exit(f"compile_times: no {log}: build first")
    seconds = compilations(log)
    print(f"{len(seconds)} sources, {sum(seconds.values()):.0f} s of compilation")
    slowest = sorted(seconds, key=seconds.get, reverse=True)
    for name in slowest[:arguments.top]:
        print(f"{seconds[name]:7.1f} s  {name}")
    over = [name for name in slowest if arguments.limit and seconds[name] > arguments.limit]
    for name in over:
        print(f"compile_times: {name}: {seconds[name]:.1f} s is longer than {arguments.limit:g} s", file=sys.stderr)
    return 1 if over else 0


sys.exit(main())
