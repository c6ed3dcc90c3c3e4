"""`python3 -m understudy ...` is the command `understudy ...` of the same version."""
import os
import sys

from ._command import command


def main() -> None:
    program = command()
    os.execv(program, [program, *sys.argv[1:]])


if __name__ == "__main__":
    main()
