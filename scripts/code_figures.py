#!/usr/bin/env python3
"""Prints the size of the code by room, the longest files, functions and parameter lists, and how many includes
cross a room or a sub-room.

usage: code_figures.py [ROOT]      functions are measured where universal-ctags is installed
"""
import collections
import json
import pathlib
import re
import shutil
import subprocess
import sys

ROOMS = ("core geometry kinematics machine toolpath vision calibration control drivers renderer sim rehearsal "
         "regression studies report cli models tests bench").split()
SHOWN = 5


def sources(root):
    listed = subprocess.run(["git", "-C", str(root), "ls-files", "*.h", "*.cpp"], check=True, capture_output=True,
                            text=True).stdout.split()
    return [name for name in listed if name.split("/")[0] in ROOMS]


def lines_by_room(root, names):
    count = collections.Counter()
    length = {}
    for name in names:
        length[name] = len((root / name).read_text().splitlines())
        count[name.split("/")[0]] += length[name]
    return count, length


def parameters(signature):
    """How many parameters a signature has; commas inside brackets do not count."""
    inner = signature[signature.find("(") + 1:signature.rfind(")")]
    depth, count = 0, 1 if inner.strip() not in ("", "void") else 0
    for letter in inner:
        depth += letter in "(<[{"
        depth -= letter in ")>]}"
        count += letter == "," and depth == 0
    return count


def functions(root, names):
    found = []
    command = ["ctags", "--output-format=json", "--fields=+neS", "--kinds-C++=fp", "-L", "-", "-f", "-"]
    out = subprocess.run(command, input="\n".join(names), cwd=root, check=True, capture_output=True, text=True).stdout
    for line in out.splitlines():
        tag = json.loads(line)
        size = tag.get("end", tag["line"]) - tag["line"] + 1
        found.append((tag["path"], tag["line"], tag["name"], size, parameters(tag.get("signature", ""))))
    return found


def crossings(root, names):
    rooms = subrooms = 0
    for name in names:
        here = name.split("/")[:-1]
        if here[0] in ("tests", "bench"):
            continue
        for used in re.findall(r'^#include "([^"]+)"', (root / name).read_text(), re.M):
            there = used.split("/")[:-1]
            if there and there[0] in ROOMS:
                rooms += there[0] != here[0]
                subrooms += there[0] == here[0] and there != here
    return rooms, subrooms


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    names = sources(root)
    count, length = lines_by_room(root, names)
    for room in ROOMS:
        if count[room]:
            files = sum(name.startswith(room + "/") for name in names)
            print(f"{room:12} {files:4} files {count[room]:6} lines")
    print(f"{'all':12} {len(names):4} files {sum(count.values()):6} lines")
    print("longest files")
    for name in sorted(length, key=length.get, reverse=True)[:SHOWN]:
        print(f"  {length[name]:4} {name}")
    rooms, subrooms = crossings(root, names)
    print(f"includes that cross rooms {rooms}, sub-rooms of one room {subrooms}")
    if not shutil.which("ctags"):
        print("functions: not measured, universal-ctags is not installed")
        return
    product = [name for name in names if name.split("/")[0] not in ("tests", "bench")]
    found = functions(root, product)
    print("longest functions")
    for path, line, name, size, _ in sorted(found, key=lambda f: -f[3])[:SHOWN]:
        print(f"  {size:4} lines {path}:{line} {name}")
    print("longest parameter lists")
    for path, line, name, _, many in sorted(found, key=lambda f: -f[4])[:SHOWN]:
        print(f"  {many:4} {path}:{line} {name}")
    print(f"functions with more than six parameters: {sum(f[4] > 6 for f in found)}")


if __name__ == "__main__":
    main()
