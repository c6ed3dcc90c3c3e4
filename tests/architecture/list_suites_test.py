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
    def listed(self, *left_out):
        """(filter, time limit, label) by name; left_out: the lines of files of patterns."""
        with tempfile.TemporaryDirectory() as folder:
            program, out = Path(folder) / "program", Path(folder) / "tests.cmake"
            program.write_text(f"#!/bin/sh\ncat <<'END'\n{LISTED}END\n")
            program.chmod(0o755)
            files = [Path(folder) / f"left_out_{i}.txt" for i in range(len(left_out))]
            for file, lines in zip(files, left_out):
                file.write_text(lines)
            patterns = ",".join(map(str, files))
            subprocess.run(["cmake", f"-DPROGRAM={program}", "-DPREFIX=room", "-DTIMEOUT=100", f"-DLEFT_OUT={patterns}", "-DPROPERTIES=",
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
        self.assertEqual(self.listed(), {"room.Fast": ("Fast.*", 160, ""), "room.Some/Typed/0": ("Some/Typed/0.*", 100, ""), **self.LABELLED})

    def test_a_suite_is_one_test_without_what_is_left_out(self):
        but = "-Fast.B:Typed.*"
        self.assertEqual(self.listed("# why\nFast.B\n\nTyped.*\n"),
                         {"room.Fast": (f"Fast.*{but}", 160, ""), "room.Some/Typed/0": (f"Some/Typed/0.*{but}", 100, ""), **self.LABELLED})

    def test_patterns_of_several_files_count(self):
        self.assertEqual(self.listed("Fast.A\n", "# why\nFast.B\n")["room.Fast"][0], "Fast.*-Fast.A:Fast.B")

    def test_what_the_sanitizers_leave_out_exists(self):
        sources = "".join(source.read_text() for source in SCRIPT.parents[1].glob("tests/**/*_test.cpp"))
        patterns = [line for name in ("sanitize_left_out.txt", "thread_left_out.txt")
                    for line in (SCRIPT.parent / name).read_text().splitlines() if not line.startswith("#")]
        self.assertTrue(patterns)
        for pattern in patterns:
            suite, test = pattern.split("/")[-2 if pattern.count("/") > 1 else -1].split(".")
            self.assertRegex(sources, rf"TEST\w*\({suite}, {test}\)", pattern)


if __name__ == "__main__":
    unittest.main()
