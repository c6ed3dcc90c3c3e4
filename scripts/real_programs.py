#!/usr/bin/env python3
"""Shows programs of public repositories to `understudy inspect` and writes the table of docs/real-programs.md.

    python3 scripts/real_programs.py build/release/cli/understudy --clones FOLDER > table.md

Reads scripts/real_programs.csv: tool, repository (owner/name on GitHub), commit, path, machine, further options, and what is expected:
read, refused, or `read: crossing 1 -1`, the reading of its rotary words that comes first. FOLDER/owner+name is a clone
of the repository; one that is not there is fetched, without its files, from --from. Exit status 1: a program was answered otherwise than
its line says.
"""
import argparse
import csv
import pathlib
import re
import subprocess
import sys
import tempfile
import time

LIST = pathlib.Path(__file__).with_suffix(".csv")


def clone_of(repository, folder, source):
    clone = folder / repository.replace("/", "+")
    if not clone.exists():
        subprocess.run(["git", "clone", "--quiet", "--filter=blob:none", "--no-checkout", source + repository, str(clone)], check=True)
    return clone


def text_of(clone, commit, path):
    return subprocess.run(["git", "-C", str(clone), "show", f"{commit}:{path}"], check=True, capture_output=True).stdout


def reading_of(output):
    """The first one: coordinates and signs, `crossing 1 -1`."""
    first = re.search(r"^\s+((?:tip|machine|crossing|head|double-head)\S*)\s+(-?1)\s+(-?1\s)?", output, re.M)
    return " ".join(word.strip() for word in first.groups() if word) if first else ""


def answered(output, program):
    """What `inspect` says in one cell."""
    reading = reading_of(output)
    printed = re.search(r"prints (\d+) moves", output)
    layers = re.search(r"layers: the first ([\d.]+) mm.*?, then (\d+) of ([\d.]+) mm", output)
    unknown = re.findall(r"unknown word '([^']+)': (\d+) line", output)
    words = [f"prints {printed[1]} moves" if printed else "prints nothing"]
    if layers:
        words.append(f"{int(layers[2]) + 1} layers of {float(layers[3]):g} mm, the first {float(layers[1]):g} mm")
    if reading:
        words.append(f"rotary words read as `{reading}`")
    if unknown:
        words.append("unknown: " + ", ".join(f"`{word}` ({count})" for word, count in unknown))
    return "; ".join(words)


def refused_line(output):
    """The first line that a rehearsal refuses and --ignore does not pass over."""
    first = re.search(r"^  (line \d+) is refused, and left out here: (.*); mend it before you rehearse$", output, re.M)
    return f"{first[1]}: {first[2]}" if first else ""


def refused(errors, program):
    message = errors.strip().splitlines()[-1]
    return "refused: " + message.replace("understudy: ", "").replace(str(program) + ":", "line ")[:200].replace("|", "\\|")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("understudy")
    parser.add_argument("--clones", type=pathlib.Path, required=True)
    parser.add_argument("--from", dest="source", default="https://github.com/")
    arguments = parser.parse_args()
    command = str(pathlib.Path(arguments.understudy).resolve())
    arguments.clones.mkdir(parents=True, exist_ok=True)
    print("| tool | program | lines | machine | answer |")
    print("|---|---|---|---|---|")
    different, lines_all, seconds_all = 0, 0, 0.0
    with tempfile.TemporaryDirectory() as folder:
        for row in csv.DictReader(LIST.open(encoding="utf-8")):
            program = pathlib.Path(folder) / pathlib.PurePosixPath(row["path"]).name.replace(" ", "-")
            program.write_bytes(text_of(clone_of(row["repository"], arguments.clones, arguments.source), row["commit"], row["path"]))
            lines = program.read_bytes().count(b"\n")
            began = time.monotonic()
            run = subprocess.run([command, "inspect", program, "--machine", row["machine"], *row["options"].split()], capture_output=True,
                                 text=True, errors="replace")
            seconds = time.monotonic() - began
            if run.returncode not in (0, 2):
                sys.exit(f"{row['repository']} {row['path']}: exit status {run.returncode}\n{run.stderr}")
            line = refused_line(run.stdout)
            status = "read" if run.returncode == 0 and not line else "refused"
            _, _, reading = row["expected"].partition(": ")
            seen = status + (f": {reading_of(run.stdout)}" if reading else "")
            if seen != row["expected"]:
                different += 1
                print(f"{row['repository']} {row['path']}: {seen}, {row['expected']} is expected", file=sys.stderr)
            if status == "read":
                lines_all += lines
                seconds_all += seconds
            answer = answered(run.stdout, program) if status == "read" else refused(line or run.stderr, program)
            print(f"| {row['tool']} | `{row['repository']}/{row['path']}` @ {row['commit'][:7]} | {lines} | {row['machine']} | {answer} |")
    print(f"\n{lines_all} lines were read in {seconds_all:.1f} s: {1e5 * seconds_all / max(lines_all, 1):.2f} s for 100 000.")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
