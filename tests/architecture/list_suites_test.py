"""What CTest reads of a test program, of a program that only lists tests."""
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "cmake" / "list_suites.cmake"
LISTED = r"""Fast.
  A
  B  # GetParam() = 2;3
  DISABLED_C
SlowStudy.
  D
  E
  DISABLED_F
DISABLED_Whole.
  G
Some/Typed/0.  # TypeParam = int
  H/0  # GetParam() = [1]
"""


class ListSuites(unittest.TestCase):
    def listed(self, each):
        """(filter, time limit, is slow) by name."""
        with tempfile.TemporaryDirectory() as folder:
            program, out = Path(folder) / "program", Path(folder) / "tests.cmake"
            program.write_text(f"#!/bin/sh\ncat <<'END'\n{LISTED}END\n")
            program.chmod(0o755)
            subprocess.run(["cmake", f"-DPROGRAM={program}", "-DPREFIX=room", "-DTIMEOUT=100", f"-DEACH={each}", "-DPROPERTIES=",
                            f"-DOUT={out}", "-P", SCRIPT], check=True)
            text = out.read_text()
        filters = dict(re.findall(r"add_test\(\[==\[(.*?)\]==\].*--gtest_filter=(.*?)\]==\]", text))
        limits = {name: (int(limit), bool(re.search("LABELS[; ]slow", rest)))
                  for name, limit, rest in re.findall(r"set_tests_properties\(\[==\[(.*?)\]==\] PROPERTIES TIMEOUT (\d+)(.*)\)", text)}
        self.assertEqual(filters.keys(), limits.keys())
        return {name: (filters[name], *limits[name]) for name in filters}

    SLOW = {"room.SlowStudy.D": ("SlowStudy.D", 3600, True), "room.SlowStudy.E": ("SlowStudy.E", 3600, True)}

    def test_a_suite_is_one_test_and_each_of_a_slow_suite(self):
        self.assertEqual(self.listed("OFF"), {"room.Fast": ("Fast.*", 160, False), "room.Some/Typed/0": ("Some/Typed/0.*", 100, False), **self.SLOW})

    def test_each_test_is_one_under_a_sanitizer(self):
        self.assertEqual(self.listed("ON"), {"room.Fast.A": ("Fast.A", 100, False), "room.Fast.B": ("Fast.B", 100, False),
                                            "room.Some/Typed/0.H/0": ("Some/Typed/0.H/0", 100, False), **self.SLOW})


if __name__ == "__main__":
    unittest.main()
