"""The check that tests mirror the source, seen to fail."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CHECK = Path(__file__).resolve().parents[2] / "scripts" / "check_tests_mirror.py"


class CheckTestsMirror(unittest.TestCase):
    def check(self, names, exceptions=""):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for name in names:
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text("")
            (root / "tests").mkdir(exist_ok=True)
            (root / "tests/mirror.txt").write_text(exceptions)
            done = subprocess.run([sys.executable, CHECK, root], capture_output=True, text=True)
            self.assertEqual(done.stderr, "")
            return done.returncode, done.stdout

    def test_a_test_of_its_name_or_a_reason_passes(self):
        names = ["core/a.cpp", "tests/core/a_test.cpp", "core/b.cpp", "sim/x/c.cpp"]
        table = "core/b.cpp: tests/core/a_test.cpp: a is b written out\nsim/x/: tests/core/a_test.cpp: all of x\n"
        self.assertEqual(self.check(names, table), (0, ""))

    def test_a_source_without_either(self):
        status, text = self.check(["core/a.cpp"])
        self.assertEqual(status, 1)
        self.assertIn("core/a.cpp:1: no test: tests/core/a_test.cpp is missing", text)

    def test_a_line_whose_test_is_gone(self):
        self.assertEqual(
            self.check(["core/a.cpp"], "\ncore/a.cpp: tests/core/b_test.cpp: b calls it\n"),
            (1, "tests/mirror.txt:2: there is no test tests/core/b_test.cpp\n"))

    def test_a_line_whose_source_is_gone(self):
        status, text = self.check(["tests/core/a_test.cpp"], "core/a.cpp: tests/core/a_test.cpp: reason\n")
        self.assertEqual((status, text), (1, "tests/mirror.txt:1: there is no source core/a.cpp\n"))

    def test_a_line_without_a_reason(self):
        names = ["core/a.cpp", "core/b.cpp", "tests/core/a_test.cpp"]
        self.assertEqual(
            self.check(names, "core/b.cpp: tests/core/a_test.cpp\n"),
            (1, "tests/mirror.txt:1: core/b.cpp has no reason\n"))

    def test_a_test_in_a_folder_that_no_program_takes(self):
        names = ["core/x/a.cpp", "tests/core/x/a_test.cpp", "tests/core/CMakeLists.txt"]
        self.assertEqual(
            self.check(names),
            (1, "tests/core/x/a_test.cpp:1: no program: tests/core/CMakeLists.txt takes no folder below it (RECURSE)\n"))

    def test_a_line_that_is_no_longer_needed(self):
        status, text = self.check(["core/a.cpp", "tests/core/a_test.cpp"], "core/a.cpp: tests/core/a_test.cpp: x\n")
        self.assertEqual(
            (status, text), (1, "tests/mirror.txt:1: core/a.cpp has a test of its name; the line can go\n"))


if __name__ == "__main__":
    unittest.main()
