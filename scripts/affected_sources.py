#!/usr/bin/env python3
"""Which sources a change touches: reads names of changed .h and .cpp files, one a line, and prints every .cpp that
is one of them or includes one, directly or not. From the #include lines alone; nothing need be built.

    git diff --name-only main | scripts/affected_sources.py [--one-for-each-header]

--one-for-each-header: of a header's sources only the one of its own name, else the first, for checks that look at
headers through any source.
"""
import pathlib
import re
import subprocess
import sys

INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)


def includes():
    """File -> the project's files that it includes."""
    names = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", "*.h", "*.cpp"],
                           check=True, capture_output=True, text=True).stdout.split()
    known = {name for name in names if pathlib.Path(name).is_file()}
    return {name: {used for used in INCLUDE.findall(pathlib.Path(name).read_text()) if used in known} for name in known}


def users(graph):
    """File -> the files that include it."""
    turned = {name: set() for name in graph}
    for name, used in graph.items():
        for one in used:
            turned[one].add(name)
    return turned


def sources_of(name, used_by):
    """The sources that see the file, the nearest first."""
    seen, front, found = {name}, [name], []
    while front:
        found += sorted(one for one in front if one.endswith(".cpp"))
        front = [user for one in sorted(front) for user in sorted(used_by.get(one, ())) if user not in seen]
        seen.update(front)
    return list(dict.fromkeys(found))


def main():
    used_by = users(includes())
    changed = sorted(name for name in sys.stdin.read().split() if name in used_by)
    chosen = [name for name in changed if name.endswith(".cpp")]
    for header in (name for name in changed if name.endswith(".h")):
        sources = sources_of(header, used_by)
        if "--one-for-each-header" in sys.argv:
            own = header[:-2] + ".cpp"
            sources = [own] if own in sources else sources[:1]
        chosen += sources
    print("\n".join(dict.fromkeys(chosen)))


main()
