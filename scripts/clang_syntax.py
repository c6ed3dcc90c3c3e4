#!/usr/bin/env python3
"""Lets clang parse sources as a build folder's compile_commands.json compiles them, warnings as errors.

    scripts/clang_syntax.py BUILD < names-of-sources

Prints each source's first error and exits 1 if there is any. Passes over names, one a line, that the build does not
compile.
"""
import concurrent.futures
import json
import os
import pathlib
import shlex
import subprocess
import sys

GCC_ONLY = {"-Wno-restrict", "-Wno-stringop-overflow", "-Wno-array-bounds"}


def command(entry):
    words = shlex.split(entry["command"])
    kept = []
    for word, before in zip(words[1:], words):
        if word in ("-o", "-c") or before == "-o" or word in GCC_ONLY:
            continue
        kept.append(word)
    # Clang counts sign conversions to -Wconversion, GCC does not (cmake/settings.cmake).
    return ["clang++", "-fsyntax-only", "-Werror", *kept, "-Wno-sign-conversion"]


def first_error(entry):
    run = subprocess.run(command(entry), cwd=entry["directory"], capture_output=True, text=True)
    if run.returncode == 0:
        return None
    lines = [line for line in run.stderr.splitlines() if "error:" in line] or run.stderr.splitlines() or ["clang failed"]
    return lines[0]


def entries(build):
    path = pathlib.Path(build) / "compile_commands.json"
    return {os.path.relpath(entry["file"]): entry for entry in json.loads(path.read_text())}


def main():
    known = entries(sys.argv[1])
    names = [name for name in sys.stdin.read().split() if name in known]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        errors = [error for error in pool.map(first_error, (known[name] for name in names)) if error]
    for error in errors:
        print(f"clang: {error}", file=sys.stderr)
    print(f"clang: {len(names)} sources parsed, {len(errors)} with errors")
    return 1 if errors else 0


sys.exit(main())
