#!/usr/bin/env python3
"""Holds every #include to scripts/rooms.txt: room to room, folder to folder, third-party headers; and finds
headers that include each other in a circle. One line a fault, with file and line; status 1 when there is one.

usage: check_includes.py [ROOT [TABLE]]
"""
import re
import sys
from pathlib import Path, PurePosixPath

INCLUDE = re.compile(r'\s*#\s*include\s*([<"])([^>"]+)[>"]')


class Table:
    """The lines of rooms.txt."""

    def __init__(self, path):
        self.rooms, self.inside, self.libraries = {}, {}, {}
        kinds = {"room": self.rooms, "inside": self.inside, "library": self.libraries}
        for number, line in enumerate(path.read_text().splitlines(), 1):
            line = line.split("#")[0].strip()
            if not line:
                continue
            kind, _, rest = line.partition(" ")
            name, colon, words = rest.partition(":")
            if kind not in kinds or not colon:
                sys.exit(f"{path}:{number}: not 'room|inside|library NAME: WORDS'")
            kinds[kind][name.strip()] = words.split()


def includes_of(file):
    for number, line in enumerate(file.read_text(errors="replace").splitlines(), 1):
        found = INCLUDE.match(line)
        if found:
            yield number, found[1] == "<", found[2]


def ours(table, folder, header):
    """Why `folder` must not include our `header`; None when it may."""
    other = str(PurePosixPath(header).parent)
    room, other_room = folder.split("/")[0], other.split("/")[0]
    if other == folder:
        return None
    if room != other_room:
        return None if other_room in table.rooms[room] else f"{room} must not include {other_room}"
    return None if other in table.inside.get(folder, []) else f"{folder} must not include {other}"


def theirs(table, folder, header):
    """Why `folder` must not include a third party's `header`; None when it may."""
    if "/" not in header and "." not in header:
        return None  # the standard library
    for library, folders in table.libraries.items():
        if header.startswith(library):
            if "*" in folders or any(f"{folder}/".startswith(f"{f}/") for f in folders):
                return None
            return f"{library} may be seen in {', '.join(folders)} only"
    return "a library that the table does not know"


def broken_includes(root, table):
    for room in table.rooms:
        for file in sorted((root / room).rglob("*")):
            if file.suffix not in (".h", ".cpp"):
                continue
            name = file.relative_to(root).as_posix()
            folder = str(PurePosixPath(name).parent)
            for number, angled, header in includes_of(file):
                is_ours = not angled and header.split("/")[0] in table.rooms
                why = (ours if is_ours else theirs)(table, folder, header)
                if why:
                    mark = "<>" if angled else '""'
                    yield f"{name}:{number}: {why}: {mark[0]}{header}{mark[1]}"


def circles(root, tops):
    """Headers that include each other, each circle once."""
    graph = {}
    for top in tops:
        for file in sorted((root / top).rglob("*.h")):
            name = file.relative_to(root).as_posix()
            graph[name] = [(number, h) for number, angled, h in includes_of(file) if not angled]
    done, path = set(), []

    def visit(name):
        if name in done or name not in graph:
            return
        path.append(name)
        for number, header in graph[name]:
            if header in path:
                loop = path[path.index(header):] + [header]
                yield f"{name}:{number}: headers include each other: {' -> '.join(loop)}"
            else:
                yield from visit(header)
        path.pop()
        done.add(name)

    for name in graph:
        yield from visit(name)


def main(arguments):
    root = Path(arguments[0] if arguments else ".")
    table = Table(Path(arguments[1]) if len(arguments) > 1 else Path(__file__).with_name("rooms.txt"))
    faults = list(broken_includes(root, table)) + list(circles(root, [*table.rooms, "tests", "bench"]))
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
