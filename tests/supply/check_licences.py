#!/usr/bin/env python3
"""Holds docs/licences.md to the files that a build installs and embeds. One line a fault; status 1 when there is one.

usage: check_licences.py SOURCE BUILD
"""
import fnmatch
import re
import subprocess
import sys
import tempfile
from pathlib import Path

OURS = "Apache-2.0"


def rows_of(page):
    """(patterns, licence) of each row of the first table."""
    rows = []
    for line in page.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if line.startswith("| `") and len(cells) == 3:
            rows.append((re.findall(r"`([^`]+)`", cells[0]), cells[2]))
    return rows


def source_name(installed):
    """models/arm/machine.yaml for share/understudy/models/arm/machine.yaml."""
    name = re.sub(r"^share/(doc/)?understudy/", "", installed)
    return "docs/licences.md" if name == "licences.md" else name


def faults_of(rows, names, exists):
    for name in names:
        if not any(fnmatch.fnmatch(name, pattern) for patterns, _ in rows for pattern in patterns):
            yield f"docs/licences.md: no row for {name}"
    for patterns, licence in rows:
        for pattern in patterns:
            if not fnmatch.filter(names, pattern):
                yield f"docs/licences.md: `{pattern}` is neither shipped nor embedded"
        notices = re.findall(r"`([^`]+)`", licence)
        if licence != OURS and not any(map(exists, notices)):
            yield f"docs/licences.md: `{patterns[0]}` is under {licence}, and no notice is shipped"


def main(source, build):
    embedded = [line for line in (build / "embedded.txt").read_text().splitlines() if line]
    # What the build wrote is build/web/report.js, whatever the folder's name.
    names = {line.replace(f"{build}/", "build/").removeprefix(f"{source}/") for line in embedded}
    names |= {file.relative_to(source).as_posix() for file in (source / "docs/pictures").iterdir()}
    with tempfile.TemporaryDirectory() as prefix:
        subprocess.run(["cmake", "--install", build, "--component", "program", "--prefix", prefix], check=True,
                       stdout=subprocess.DEVNULL)
        root = Path(prefix)
        names |= {source_name(file.relative_to(root).as_posix()) for file in root.rglob("*") if file.is_file()}
    for needed in ("bin/understudy", "models/arm/machine.yaml", "web/report/page.html"):
        if needed not in names:
            yield f"{needed} is neither installed nor embedded: the check sees too little"
    yield from faults_of(rows_of((source / "docs/licences.md").read_text()), sorted(names), names.__contains__)


if __name__ == "__main__":
    found = list(main(Path(sys.argv[1]), Path(sys.argv[2])))
    print("\n".join(found))
    sys.exit(1 if found else 0)
