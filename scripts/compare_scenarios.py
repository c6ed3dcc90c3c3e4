#!/usr/bin/env python3
"""Compares the results of two builds of understudy, byte for byte.

  scripts/compare_scenarios.py BEFORE AFTER [SCENARIO...]    default: every file of scenarios/ but studies/

BEFORE and AFTER are understudy commands, or folders in which an earlier call kept the results (--keep). Compared
are summary.json and trace.csv of each scenario. In summary.json the lines are left out that hold the wall clock, the
version, the command line and the checksums of input files. Exit status: 0 all equal, 1 some differ, 2 wrong use.
"""
import argparse
import difflib
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
UNCOMPARED = re.compile(r'^\s*"(real_time_factor|version|command|\w+_sha256)":')


def results(build: pathlib.Path, scenario: pathlib.Path, keep: pathlib.Path) -> pathlib.Path:
    """The folder with one scenario's results, run if `build` is a command."""
    if build.is_dir():
        return build / scenario.stem
    done = subprocess.run([build, 'scenario', 'run', scenario, '--out', keep], stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        sys.exit(f'compare_scenarios: {build} on {scenario}: exit status {done.returncode}: {done.stderr.strip()[-300:]}')
    return keep / scenario.stem


def lines(path: pathlib.Path) -> list[str]:
    try:
        text = path.read_text()
    except OSError as error:
        return [f'cannot be read: {error.strerror}']
    return [line for line in text.splitlines() if not UNCOMPARED.match(line)]


def first_difference(before: pathlib.Path, after: pathlib.Path) -> str | None:
    a, b = lines(before), lines(after)
    if a == b and before.exists():
        return None
    changed = [x for x in difflib.unified_diff(a[:100000], b[:100000], lineterm='', n=0) if x[:3] not in ('---', '+++')]
    return ' '.join(changed[:3])[:300] or f'{len(a)} lines against {len(b)}'


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('before', type=pathlib.Path)
    parser.add_argument('after', type=pathlib.Path)
    parser.add_argument('scenarios', type=pathlib.Path, nargs='*')
    parser.add_argument('--keep', type=pathlib.Path, help='folder for the results, with before/ and after/ in it')
    words = parser.parse_args()
    for build in (words.before, words.after):
        if not build.exists():
            parser.error(f'{build} does not exist: give a built understudy, or a folder of results')
    scenarios = words.scenarios or sorted(
        s for s in ROOT.glob('scenarios/**/*.yaml') if s.parent.name != 'studies')
    keep = words.keep or pathlib.Path(tempfile.mkdtemp(prefix='compare-scenarios-'))
    differing = 0
    for scenario in scenarios:
        folders = [results(build.absolute(), scenario.absolute(), keep / side)
                   for build, side in ((words.before, 'before'), (words.after, 'after'))]
        found = {name: first_difference(*(folder / name for folder in folders))
                 for name in ('summary.json', 'trace.csv')}
        for name, difference in found.items():
            if difference:
                print(f'{scenario.stem}: {name} differs: {difference}', flush=True)
        if not any(found.values()):
            print(f'{scenario.stem}: the same', flush=True)
        differing += any(found.values())
    return 1 if differing else 0


if __name__ == '__main__':
    sys.exit(main())
