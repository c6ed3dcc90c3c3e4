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
ExtendedRun.
  I
DISABLED_Whole.
  G
Some/Typed/0.  # TypeParam = int
  H/0  # GetParam() = [1]
"""


class ListSuites(unittest.TestCase):
    def listed(self, each):
        """(filter, time limit, label) by name."""
        with tempfile.TemporaryDirectory() as folder:
            program, out = Path(folder) / "program", Path(folder) / "tests.cmake"
            program.write_text(f"#!/bin/sh\ncat <<'END'\n{LISTED}END\n")
            program.chmod(0o755)
            subprocess.run(["cmake", f"-DPROGRAM={program}", "-DPREFIX=room", "-DTIMEOUT=100", f"-DEACH={each}", "-DPROPERTIES=",
                            f"-DOUT={out}", "-P", SCRIPT], check=True)
            text = out.read_text()
        filters = dict(re.findall(r"add_test\(\[==\[(.*?)\]==\].*--gtest_filter=(.*?)\]==\]", text))
        limits = {name: (int(limit), "".join(re.findall(r"LABELS[; ](\w+)", rest)))
                  for name, limit, rest in re.findall(r"set_tests_properties\(\[==\[(.*?)\]==\] PROPERTIES TIMEOUT (\d+)(.*)\)", text)}
        self.assertEqual(filters.keys(), limits.keys())
        return {name: (filters[name], *limits[name]) for name in filters}

    LABELLED = {"room.SlowStudy.D": ("SlowStudy.D", 3600, "slow"), "room.SlowStudy.E": ("SlowStudy.E", 3600, "slow"),
                "room.ExtendedRun.I": ("ExtendedRun.I", 100, "extended")}

    def test_a_suite_is_one_test_and_each_of_a_labelled_suite(self):
        self.assertEqual(self.listed("OFF"), {"room.Fast": ("Fast.*", 160, ""), "room.Some/Typed/0": ("Some/Typed/0.*", 100, ""), **self.LABELLED})

    def test_each_test_is_one_under_a_sanitizer(self):
        self.assertEqual(self.listed("ON"), {"room.Fast.A": ("Fast.A", 100, ""), "room.Fast.B": ("Fast.B", 100, ""),
                                            "room.Some/Typed/0.H/0": ("Some/Typed/0.H/0", 100, ""), **self.LABELLED})


if __name__ == "__main__":
    unittest.main()
