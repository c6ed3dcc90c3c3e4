#!/usr/bin/env python3
"""Holds the figures of the pages to what commands print and tests assert, as claims.toml lists them.

usage: check_claims.py CLAIMS --source FOLDER --understudy PROGRAM [--build FOLDER] [--only NAME] | --list | --tests CTEST-FOLDER

[[command]]            a command in a folder that holds the shipped scenarios, models and examples
name = "..."           of the CTest
run = "..."            for bash; $SOURCE and $BUILD are the folders of the sources and of the build
slow = true            optional: minutes
[[command.claim]]      a figure that it prints
page = "docs/strand.md"
text = "sags by {12.5} um"    a passage of the page as it stands there; figures in braces
prints = "sag +([0-9.]+) um"  a regular expression for the output, one group for each figure in braces
within = 0.2           optional share of the figure, 0.2 at most; or
sigma = 1.5            1 sigma of a figure that is drawn: two of them are allowed
[[test]]               figures that a test asserts
page, text             as above
test = "strand.X.Y"    its name for CTest

--tests: every test that is named exists. Fails with one line for each claim that does not hold.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import tomllib

from run_page import make_folder

WITHIN_MOST = 0.2
FIGURE = re.compile(r"\{(-?[0-9.]+)\}")


def words(text):
    return " ".join(text.split())


def place(claims_file, claim):
    return f"{claims_file}: {claim['page']}: '{claim['text']}'"


def check_page(source, claim):
    """The passage stands on its page; nothing, or why not."""
    with open(os.path.join(source, claim["page"]), encoding="utf-8") as page:
        if words(FIGURE.sub(r"\1", claim["text"])) not in words(page.read()):
            return "the page does not say so"
    return None


def check_form(claim):
    figures = FIGURE.findall(claim["text"])
    groups = re.compile(claim["prints"]).groups
    if not figures:
        return "no figure in braces"
    if groups != len(figures):
        return f"{len(figures)} figures in braces, {groups} groups in 'prints'"
    if not 0 <= claim.get("within", WITHIN_MOST) <= WITHIN_MOST:
        return f"within {claim['within']}, at most {WITHIN_MOST}"
    return None


def check_figures(claim, printed):
    found = re.search(claim["prints"], printed, re.MULTILINE)
    if not found:
        return f"nothing printed matches '{claim['prints']}'"
    for said, got in zip(FIGURE.findall(claim["text"]), found.groups()):
        allowed = 2 * claim["sigma"] if "sigma" in claim else claim.get("within", WITHIN_MOST) * abs(float(said))
        if not abs(float(got) - float(said)) <= allowed + 1e-12:
            return f"says {said}, the command prints {got}, more than {allowed:.4g} off"
    return None


def run(command, environment, folder):
    done = subprocess.run(["bash", "-c", command["run"]], cwd=folder, env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    print(f"$ {command['run']}\n{done.stdout}", end="", flush=True)
    return done.stdout, done.returncode


def wrong_claims(arguments, claims):
    wrong = []
    for test in claims.get("test", []):
        problem = check_page(arguments.source, test)
        if problem:
            wrong.append(f"{place(arguments.claims, test)}: {problem}")
    for command in claims.get("command", []):
        for claim in command["claim"]:
            problem = check_form(claim) or check_page(arguments.source, claim)
            if problem:
                wrong.append(f"{place(arguments.claims, claim)}: {problem}")
    return wrong


def wrong_figures(arguments, command):
    with tempfile.TemporaryDirectory() as folder:
        environment = make_folder(arguments, folder)
        environment |= {"SOURCE": os.path.abspath(arguments.source), "BUILD": os.path.abspath(arguments.build or ".")}
        printed, status = run(command, environment, folder)
    if status > command.get("status", 0):
        return [f"{arguments.claims}: {command['name']}: ended with status {status}"]
    problems = [(claim, check_figures(claim, printed)) for claim in command["claim"]]
    return [f"{place(arguments.claims, claim)}: {problem}" for claim, problem in problems if problem]


def missing_tests(arguments, claims):
    """Claims whose test is none of CTest's, and none of a suite that is one of CTest's."""
    with tempfile.TemporaryDirectory() as folder:  # in the build's own folder ctest would begin the log of the running tests anew
        with open(os.path.join(folder, "CTestTestfile.cmake"), "w") as file:
            file.write(f'subdirs("{os.path.abspath(arguments.tests)}")\n')
        listed = subprocess.run(["ctest", "--test-dir", folder, "--show-only=json-v1"], text=True, stdout=subprocess.PIPE, check=True).stdout
    commands = {test["name"]: test.get("command", []) for test in json.loads(listed)["tests"]}

    def exists(name):
        if name in commands:
            return True
        suite, _, test = name.rpartition(".")
        if not commands.get(suite):
            return False
        program, only = commands[suite][0], f"--gtest_filter={suite.partition('.')[2]}.{test}"
        return bool(subprocess.run([program, "--gtest_list_tests", only], text=True, stdout=subprocess.PIPE, check=True).stdout.strip())

    return [f"{place(arguments.claims, t)}: there is no test {t['test']}" for t in claims.get("test", []) if not exists(t["test"])]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("claims")
    parser.add_argument("--source")
    parser.add_argument("--understudy")
    parser.add_argument("--build")
    parser.add_argument("--only")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--tests")
    arguments = parser.parse_args()
    with open(arguments.claims, "rb") as file:
        claims = tomllib.load(file)
    arguments.claims = os.path.basename(arguments.claims)
    commands = claims.get("command", [])
    if arguments.list:
        print(";".join(c["name"] + (":slow" if c.get("slow") else "") for c in commands))
        return
    if arguments.tests:
        wrong = missing_tests(arguments, claims)
    elif arguments.only:
        wrong = [w for c in commands if c["name"] == arguments.only for w in wrong_figures(arguments, c)]
    else:
        wrong = wrong_claims(arguments, claims)
    if wrong:
        sys.exit("\n".join(wrong))


if __name__ == "__main__":
    main()
