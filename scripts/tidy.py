#!/usr/bin/env python3
"""Lets clang-tidy look at sources as a build folder's compile_commands.json compiles them.

    scripts/tidy.py BUILD < names-of-sources

Prints each finding once and exits 1 if there is any. Passes over names, one a line, that the build does not compile.
Several sources are looked at as one text, so that the headers are parsed and searched once: Eigen and GoogleTest take
longer than the sources. They come from different name spaces, where names do not clash; those that do are looked at
in halves.
"""
import bisect
import concurrent.futures
import itertools
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

TOGETHER = 8
FINDING = re.compile(r"^(\S+?):(\d+)(:\d+: (?:error|warning): .*)")


def options(entry):
    """What clang needs of GCC's words: include paths, macros, the language."""
    words = shlex.split(entry["command"])
    kept = []
    for before, word in zip(words, words[1:]):
        if word.startswith(("-I", "-D", "-std=")) or word == "-isystem" or before == "-isystem":
            kept.append(word)
    return tuple(kept)


def entries(build):
    path = pathlib.Path(build) / "compile_commands.json"
    return {os.path.relpath(entry["file"]): entry for entry in json.loads(path.read_text())}


def name_space(name):
    """Sources with their own main() clash like those of one name space."""
    text = pathlib.Path(name).read_text()
    if re.search(r"^int main\(", text, re.MULTILINE):
        return "main"
    found = re.search(r"^namespace (understudy\S*)", text, re.MULTILINE)
    return found.group(1) if found else name


def macros(words):
    return dict(word[2:].partition("=")[::2] for word in words if word.startswith("-D"))


def agree(words, others):
    mine, theirs = macros(words), macros(others)
    return all(theirs.get(macro, value) == value for macro, value in mine.items())


def united(words, others):
    """-isystem stays with its path: both are one word after the other in either."""
    pairs = [(word, others[i + 1]) if word == "-isystem" else (word,)
             for i, word in enumerate(others) if i == 0 or others[i - 1] != "-isystem"]
    known = " " + " ".join(words) + " "
    return words + tuple(word for pair in pairs if f" {' '.join(pair)} " not in known for word in pair)


def batches(names, known):
    """(sources, options), at most TOGETHER sources of different name spaces each; the fullest name spaces first."""
    waiting = {}
    for name in sorted(names):
        waiting.setdefault(name_space(name), []).append(name)
    while waiting:
        sources, words = [], ()
        for space in sorted(waiting, key=lambda space: -len(waiting[space])):
            theirs = options(known[waiting[space][0]])
            if len(sources) == TOGETHER or not agree(theirs, words):
                continue
            sources.append(waiting[space].pop(0))
            words = united(words, theirs)
            if not waiting[space]:
                del waiting[space]
        yield sources, words


def write_together(sources, path):
    """The line before each source's first in one text of them all."""
    texts = [pathlib.Path(name).read_text() + "\n" for name in sources]
    path.write_text("".join(texts))
    return list(itertools.accumulate((text.count("\n") for text in texts), initial=0))[:-1]


def own_place(line, path, sources, before):
    """A finding in the text of them all at its place in the source that it stands in."""
    name, number, rest = FINDING.match(line).groups()
    if pathlib.Path(name).name == path.name:
        which = bisect.bisect_left(before, int(number)) - 1
        name, number = sources[which], int(number) - before[which]
    return f"{name}:{number}{rest}"


def parses(path, words):
    return subprocess.run(["clang++", "-fsyntax-only", "-w", "-ferror-limit=1", *words, str(path)], capture_output=True).returncode == 0


def findings_of(path, words, sources, before):
    run = subprocess.run(["clang-tidy", "--quiet", "--config-file=.clang-tidy", "--warnings-as-errors=*", str(path), "--", *words,
                          "-w"], capture_output=True, text=True)
    found = {own_place(line, path, sources, before) for line in run.stdout.splitlines() if FINDING.match(line)}
    if run.returncode != 0 and not found:
        found = {f"{sources[0]} and {len(sources) - 1} more: error: clang-tidy ended with status {run.returncode}: {run.stderr[:200]}"}
    return found


def look(sources, words, folder):
    """The findings of sources looked at together; in halves where they clash."""
    with tempfile.TemporaryDirectory(dir=folder) as own:
        path = pathlib.Path(own) / "together.cpp"
        before = write_together(sources, path)
        if len(sources) == 1 or parses(path, words):
            return findings_of(path, words, sources, before)
    half = len(sources) // 2
    return look(sources[:half], words, folder) | look(sources[half:], words, folder)


def main():
    build = sys.argv[1]
    known = entries(build)
    names = [name for name in sys.stdin.read().split() if name in known]
    found = set()
    done = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = {pool.submit(look, sources, words, build): sources for sources, words in batches(names, known)}
        for run in concurrent.futures.as_completed(runs):
            done += len(runs[run])
            found |= run.result()
            if os.environ.get("TIDY_PROGRESS"):
                print(f"tidy: {done} of {len(names)} {sorted(run.result())}", file=sys.stderr, flush=True)
    here = str(pathlib.Path.cwd()) + "/"
    for line in sorted(found):
        print(f"tidy: {line.removeprefix(here)}", file=sys.stderr)
    print(f"tidy: {len(names)} sources, {len(found)} findings")
    return 1 if found else 0


sys.exit(main())
