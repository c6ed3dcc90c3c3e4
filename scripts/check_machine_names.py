#!/usr/bin/env python3
"""Finds string literals of C++ sources that are the name of one machine or of its mechanism. What a machine can do, a
program asks its kinematics::Mechanism, ChainKind or description; a test for a name would leave out the next machine.

    scripts/check_machine_names.py [ROOT]

Names are the folders of models/ and the kinds of kinematics/chain/. One line a fault, with file and line, and for each
exception below that is no longer needed; status 1 when there is one. Python 3 alone.
"""
import re
import sys
from pathlib import Path

# Where machines have their names.
FREE = {"kinematics", "models", "tests", "bench", "docs", "examples", "build", "out"}
# (file, name): why it may stand there.
ALLOWED = {
    ("machine/default_machine.h", "hexapod"): "the machine of a command or request that names none",
    ("calibration/plugin/hexapod_exchange.cpp", "hexapod"): "a word of the exchange with plug-ins (docs/calibration-plugins.md)",
    ("cli/plan/plan_finishing.cpp", "finishing"): "the word of the planner, and of what it plans",
    ("cli/plan/plan_lattice.cpp", "arm"): "the default of --machine for lattices, whose struts need the tilt of an arm",
}
EVERY_LISTED_MACHINE = "chain"  # the mechanism of no machine in particular

TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|\'(?:\\.|[^\'\\\n])\'|"((?:\\.|[^"\\\n])*)"', re.S)


def machine_names(root):
    names = {file.parent.name for file in (root / "models").glob("*/machine.yaml")}
    for file in (root / "kinematics").rglob("*.cpp"):
        names.update(re.findall(r'\bkind\.name = "([^"]+)"', file.read_text()))
    return names - {EVERY_LISTED_MACHINE}


def literals(text):
    """Line and content of every string literal; comments and characters are passed over."""
    for token in TOKEN.finditer(text):
        if token[1] is not None:
            yield text.count("\n", 0, token.start()) + 1, token[1]


def main(arguments):
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    names, used, faults = machine_names(root), set(), []
    for room in sorted(p for p in root.iterdir() if p.is_dir() and p.name not in FREE and p.name[0] != "."):
        for file in sorted(p for p in room.rglob("*") if p.suffix in (".h", ".cpp")):
            name = file.relative_to(root).as_posix()
            for line, literal in literals(file.read_text(errors="replace")):
                if literal not in names:
                    continue
                if (name, literal) in ALLOWED:
                    used.add((name, literal))
                    continue
                faults.append(f'{name}:{line}: names the machine "{literal}": ask its mechanism or description what it can do')
    faults += [f'{file}: no longer names "{name}"; take it off the list of {Path(__file__).name}'
               for file, name in ALLOWED.keys() - used if (root / file).exists()]
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
