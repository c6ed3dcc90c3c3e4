#!/usr/bin/env python3
"""Holds a bill of materials to the command: every library that it loads belongs to a component, every component has
a licence, a version and a name of its own. One line a fault; status 1 when there is one.

usage: check_bill.py BILL PROGRAM
"""
import json
import os
import re
import subprocess
import sys
from pathlib import Path

# Compiled in or embedded without a trace among the loaded libraries.
HEADERS_ONLY = {"libeigen3-dev", "nlohmann-json3-dev", "libcli11-dev"}


def files_of(package):
    """What dpkg installed for it, by its list of files and not by its index of names."""
    listed = subprocess.run(["dpkg-query", "-L", package], capture_output=True, text=True, check=True).stdout
    return {os.path.realpath(line) for line in listed.splitlines() if ".so" in line and not os.path.islink(line)}


def faults_of(bill, libraries, files):
    if (bill.get("bomFormat"), bill.get("specVersion")) != ("CycloneDX", "1.5"):
        yield "no CycloneDX 1.5"
    parts = bill["components"]
    refs = [part["bom-ref"] for part in parts]
    if len(set(refs)) != len(refs) or sorted(bill["dependencies"][0]["dependsOn"]) != sorted(refs):
        yield "references are not unique, or not those that the command depends on"
    for part in parts:
        names = [licence["license"].get("id") or licence["license"].get("name") for licence in part["licenses"]]
        if not names or not all(names):
            yield f"{part['name']} has no licence"
        if not re.match(r"[0-9]", part.get("version", "")) or not re.match("pkg:(deb/debian|npm)/", part["purl"]):
            yield f"{part['name']} has no version or no package URL"
    names = {part["name"] for part in parts if not part["purl"].startswith("pkg:npm/")}
    known = {file for name in names for file in files(name)}
    for library in libraries:
        if library not in known:
            yield f"{library} belongs to no component"
    for name in sorted(HEADERS_ONLY - names):
        yield f"{name} is compiled in and no component"
    for name in sorted(name for name in names if re.search("gtest|gmock|benchmark", name)):
        yield f"{name} is of tests and no part of the command"


def main(bill, program):
    loaded = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
    libraries = sorted({os.path.realpath(file) for file in re.findall(r"(/\S+) \(0x", loaded)})
    if len(libraries) < 10:
        yield f"ldd lists {len(libraries)} libraries only"
    yield from faults_of(json.loads(Path(bill).read_text()), libraries, files_of)


if __name__ == "__main__":
    found = list(main(*sys.argv[1:]))
    print("\n".join(found))
    sys.exit(1 if found else 0)
