#!/usr/bin/env python3
"""check_claims.py finds claims that do not hold. usage: check_claims_test.py CHECK"""

import os
import subprocess
import sys
import tempfile

CLAIM = """
[[command]]
name = "sag"
run = "echo sag {printed} um"
[[command.claim]]
page = "page.md"
text = "{text}"
prints = 'sag ([0-9.]+) um'
{bound}
"""
TEST = """
[[test]]
page = "page.md"
text = "{text}"
test = "a.b.c"
"""


def check(toml, *words):
    """Status and message for a page that says 'sags by 12.5 um'."""
    with tempfile.TemporaryDirectory() as folder:
        for name in ("scenarios", "models", "examples", "docs"):
            os.mkdir(os.path.join(folder, name))
        with open(os.path.join(folder, "page.md"), "w", encoding="utf-8") as page:
            page.write("The strand\nsags by 12.5 um.\n")
        claims = os.path.join(folder, "claims.toml")
        with open(claims, "w", encoding="utf-8") as file:
            file.write(toml)
        done = subprocess.run([sys.executable, sys.argv[1], claims, "--source", folder, "--understudy", "/bin/true", *words],
                              text=True, capture_output=True, check=False)
        return done.returncode, done.stderr


def expect(holds, part, toml, *words):
    status, message = check(toml, *words)
    if (status == 0) != holds or part not in message:
        sys.exit(f"{words}: status {status}, '{message.strip()}'; expected '{part}' for\n{toml}")


def main():
    said = "strand sags by {12.5} um"
    run = ("--only", "sag")
    expect(True, "", CLAIM.format(printed="10.1", text=said, bound=""), *run)
    expect(False, "says 12.5, the command prints 9.9", CLAIM.format(printed="9.9", text=said, bound=""), *run)
    expect(False, "prints 12.7", CLAIM.format(printed="12.7", text=said, bound="within = 0.01"), *run)
    expect(True, "", CLAIM.format(printed="17.4", text=said, bound="sigma = 2.5"), *run)
    expect(False, "prints 17.6", CLAIM.format(printed="17.6", text=said, bound="sigma = 2.5"), *run)
    expect(False, "nothing printed matches", CLAIM.format(printed="none", text=said, bound=""), *run)
    expect(True, "", CLAIM.format(printed="1", text=said, bound=""))
    expect(False, "the page does not say so", CLAIM.format(printed="1", text="sags by {12.6} um", bound=""))
    expect(False, "no figure in braces", CLAIM.format(printed="1", text="sags by 12.5 um", bound=""))
    expect(False, "at most 0.2", CLAIM.format(printed="1", text=said, bound="within = 0.3"))
    expect(False, "the page does not say so", TEST.format(text="sags by 3 um"))


if __name__ == "__main__":
    main()
