#!/usr/bin/env python3
"""Every source has a test of its name under tests/, or a line in tests/mirror.txt that names the test that
covers it and says why; and every test is part of a program. One line a fault; status 1 when there is one.

A line of mirror.txt: `UNIT: TEST FILE: reason`; a UNIT that ends in / stands for all of a folder, the test
`none` says that nothing covers the unit.

usage: check_tests_mirror.py [ROOT]
"""
import re
import sys
from pathlib import Path

ROOMS = ("core geometry kinematics machine toolpath vision calibration control drivers renderer sim rehearsal "
         "regression studies report cli python models").split()


def read_exceptions(path):
    """unit -> (line, test file, reason)"""
    exceptions = {}
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if line.strip() and not line.startswith("#"):
            unit, test, reason = (re.split(r":\s+", line, maxsplit=2) + ["", ""])[:3]
            exceptions[unit] = (number, test, reason.strip())
    return exceptions


def faults_of(root):
    exceptions = read_exceptions(root / "tests/mirror.txt")
    used = set()
    for room in ROOMS:
        for source in sorted((root / room).rglob("*.cpp")):
            unit = source.relative_to(root).as_posix()
            has_test = (root / "tests" / unit).with_name(source.stem + "_test.cpp").is_file()
            folder = next((e for e in exceptions if e.endswith("/") and unit.startswith(e)), None)
            name = unit if unit in exceptions else folder
            if name:
                used.add(name)
            if has_test and name == unit:
                yield f"tests/mirror.txt:{exceptions[unit][0]}: {unit} has a test of its name; the line can go"
            elif not has_test and not name:
                yield (f"{unit}:1: no test: tests/{unit[:-4]}_test.cpp is missing, and tests/mirror.txt does not "
                       "say what covers it")
    yield from tests_without_program(root)
    for unit, (number, test, reason) in exceptions.items():
        if unit not in used:
            yield f"tests/mirror.txt:{number}: there is no source {unit}"
        if test != "none" and not (root / test).is_file():
            yield f"tests/mirror.txt:{number}: there is no test {test}"
        if not reason:
            yield f"tests/mirror.txt:{number}: {unit} has no reason"


def tests_without_program(root):
    """A program is of the sources beside its CMakeLists.txt; of those below where it says RECURSE, and of those named."""
    named = "".join(lists.read_text() for lists in (root / "tests").rglob("CMakeLists.txt"))
    for test in sorted((root / "tests").rglob("*_test.cpp")):
        lists = next((f / "CMakeLists.txt" for f in test.parents if (f / "CMakeLists.txt").is_file()), None)
        if lists and lists.parent != test.parent and "RECURSE" not in lists.read_text() and test.name not in named:
            yield (f"{test.relative_to(root).as_posix()}:1: no program: {lists.relative_to(root).as_posix()} "
                   "takes no folder below it (RECURSE)")


def main(arguments):
    faults = list(faults_of(Path(arguments[0] if arguments else ".")))
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
