#!/usr/bin/env python3
"""Runs the commands of a Markdown page as they are written, in an empty folder, and compares what they print.

usage: run_page.py PAGE --understudy PROGRAM --source FOLDER [--slow]

```sh         a block that is run; its commands share one folder with the page's other blocks
```sh slow    the same, but only with --slow, which first runs the page's other blocks
```sh here    a block that is run in the source folder, only with --slow
```text       behind a block: each line must be among what the block printed; "..." stands for anything

A command that ends in "# exit 1" must end with that status, every other one with 0. The folder holds the shipped
scenarios, models and examples. Fails with one line that names page, line and command.
"""

import argparse
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

FENCE = re.compile(r"^```\s*(.*?)\s*$")
STATUS = re.compile(r"^(.*\S)\s+# exit (\d+)\s*$")
SHIPPED = ("scenarios", "models", "examples", "docs")


class Block:
    def __init__(self, info, line, text):
        self.words = info.split()
        self.line = line  # of its first command
        self.text = text

    def is_shell(self):
        return self.words[:1] == ["sh"]


def read_blocks(path):
    blocks, info, first, text = [], None, 0, []
    with open(path, encoding="utf-8") as page:
        for number, line in enumerate(page, 1):
            fence = FENCE.match(line)
            if fence and info is None:
                info, first, text = fence.group(1), number + 1, []
            elif fence and not fence.group(1):
                blocks.append(Block(info, first, text))
                info = None
            elif info is not None:
                text.append(line.rstrip("\n"))
    if info is not None:
        fail(path, first - 1, "the block does not end")
    return blocks


def fail(path, line, message):
    sys.exit(f"{path}:{line}: {message}")


def commands_of(block):
    """Single commands with their lines; a here-document and lines that end in \\ belong to their command."""
    commands, i = [], 0
    while i < len(block.text):
        first, text = i, block.text[i]
        here = re.search(r"<<\s*'?(\w+)'?", text)
        while text.endswith("\\") and i + 1 < len(block.text):
            i += 1
            text += "\n" + block.text[i]
        while here and block.text[i] != here.group(1) and i + 1 < len(block.text):
            i += 1
            text += "\n" + block.text[i]
        if text.strip() and not text.startswith("#"):
            commands.append((block.line + first, text))
        i += 1
    return commands


def run_block(page, block, folder, environment):
    printed = ""
    for line, command in commands_of(block):
        expected = STATUS.match(command)
        text, status = (expected.group(1), int(expected.group(2))) if expected else (command, 0)
        done = subprocess.run(["bash", "-c", text], cwd=folder, env=environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        printed += done.stdout
        print(f"{page}:{line}: $ {text}\n{done.stdout}", end="", flush=True)
        if done.returncode != status:
            fail(page, line, f"'{text.splitlines()[0]}' ended with status {done.returncode}, not {status}")
    return printed


def compare(page, block, printed):
    lines = {" ".join(line.split()) for line in printed.splitlines()}
    for offset, text in enumerate(block.text):
        wanted = " ".join(text.split())
        pattern = re.compile(".*".join(re.escape(part) for part in wanted.split("...")))
        if not any(pattern.fullmatch(line) for line in lines):
            fail(page, block.line + offset, f"nothing printed '{wanted}'")


def make_folder(arguments, folder):
    for name in SHIPPED:
        shutil.copytree(os.path.join(arguments.source, name), os.path.join(folder, name))
    programs = os.path.join(folder, ".bin")
    os.mkdir(programs)
    os.symlink(os.path.abspath(arguments.understudy), os.path.join(programs, "understudy"))
    environment = dict(os.environ)
    environment["PATH"] = programs + os.pathsep + environment["PATH"]
    return environment


def check_languages(page, blocks):
    """A command in a block of another language would never be run."""
    for block in blocks:
        if block.is_shell() and not set(block.words[1:]) <= {"slow", "here"}:
            fail(page, block.line - 1, f"unknown words after sh: {shlex.join(block.words[1:])}")
        for offset, text in enumerate([] if block.is_shell() else block.text):
            if re.match(r"(\$ )?(understudy |\./run|\./test)", text):
                fail(page, block.line + offset, "a command in a block that is not run: begin the block with ```sh")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("page")
    parser.add_argument("--understudy", required=True)
    parser.add_argument("--source", required=True)
    parser.add_argument("--slow", action="store_true")
    arguments = parser.parse_args()
    page = os.path.relpath(arguments.page, arguments.source)
    blocks = read_blocks(arguments.page)
    check_languages(page, blocks)
    if not any(block.is_shell() for block in blocks):
        fail(page, 1, "no command to run")
    with tempfile.TemporaryDirectory() as folder:
        environment = make_folder(arguments, folder)
        printed = None
        for block in blocks:
            if block.is_shell():
                wanted = arguments.slow or len(block.words) == 1
                where = arguments.source if "here" in block.words else folder
                printed = run_block(page, block, where, environment) if wanted else None
            elif block.words[:1] == ["text"] and printed is not None:
                compare(page, block, printed)


if __name__ == "__main__":
    main()
