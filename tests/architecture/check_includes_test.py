"""The include check, seen to fail: a small tree with one fault of each kind."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CHECK = ROOT / "scripts" / "check_includes.py"
TABLE = """
room core:
room sim: core
room report: core sim
inside sim/plant: sim
library mujoco/: sim/plant
"""


class CheckIncludes(unittest.TestCase):
    def check(self, files):
        """Status and output over a tree of {name: text}."""
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "rooms.txt").write_text(TABLE)
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text)
            done = subprocess.run([sys.executable, CHECK, root, root / "rooms.txt"], capture_output=True, text=True)
            self.assertEqual(done.stderr, "")
            return done.returncode, done.stdout

    def assert_fault(self, files, line):
        self.assertEqual(self.check(files), (1, line + "\n"))

    def test_what_the_table_allows_passes(self):
        files = {
            "core/a.h": "#include <vector>\n",
            "sim/b.h": '#include "core/a.h"\n',
            "sim/plant/c.cpp": '#include <mujoco/mujoco.h>\n#include "sim/b.h"\n',
            "report/d.cpp": '#include "sim/plant/c.h"\n',
        }
        self.assertEqual(self.check(files), (0, ""))

    def test_a_room_above(self):
        self.assert_fault(
            {"core/a.h": '#pragma once\n#include "sim/b.h"\n'},
            'core/a.h:2: core must not include sim: "sim/b.h"')

    def test_a_folder_of_the_same_room(self):
        self.assert_fault(
            {"sim/b.h": '#include "sim/plant/c.h"\n'},
            'sim/b.h:1: sim must not include sim/plant: "sim/plant/c.h"')

    def test_a_library_of_another_folder(self):
        self.assert_fault(
            {"sim/b.h": "#include <mujoco/mujoco.h>\n"},
            "sim/b.h:1: mujoco/ may be seen in sim/plant only: <mujoco/mujoco.h>")

    def test_a_library_in_quotes(self):
        self.assert_fault(
            {"sim/b.h": '#include "mujoco/mujoco.h"\n'},
            'sim/b.h:1: mujoco/ may be seen in sim/plant only: "mujoco/mujoco.h"')

    def test_a_library_that_nobody_has_allowed(self):
        self.assert_fault(
            {"core/a.h": "#include <boost/any.hpp>\n"},
            "core/a.h:1: a library that the table does not know: <boost/any.hpp>")

    def test_headers_that_include_each_other(self):
        self.assert_fault(
            {"core/a.h": '#include "core/b.h"\n', "core/b.h": '\n#include "core/a.h"\n'},
            "core/b.h:2: headers include each other: core/a.h -> core/b.h -> core/a.h")


if __name__ == "__main__":
    unittest.main()
