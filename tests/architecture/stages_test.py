"""What a stage of ./check says of tests that fail, of a ctest that only prints."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

STAGES = Path(__file__).resolve().parents[2] / "scripts" / "stages.sh"
# As ./check calls a stage.
SCRIPT = f"set -euo pipefail; . '{STAGES}'; stage=extended all=0; (set -e; run_tests release -L extended)"
SUMMARY = """50% tests passed, 1 tests failed out of 2
The following tests FAILED:
\t2 - room.Name (Failed)
Errors while running CTest
"""


class RunTests(unittest.TestCase):
    def run_tests(self, printed, status):
        """What the stage says of a ctest that prints this and ends with this status."""
        with tempfile.TemporaryDirectory() as folder:
            ctest = Path(folder) / "ctest"
            ctest.write_text(f"#!/bin/sh\ncat <<'END'\n{printed}END\nexit {status}\n")
            ctest.chmod(0o755)
            (Path(folder) / "build" / "release").mkdir(parents=True)
            return subprocess.run(["bash", "-c", SCRIPT], cwd=folder, text=True, capture_output=True,
                                  env={**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"})

    def assert_says(self, reason, printed):
        stage = self.run_tests(printed + SUMMARY, 8)
        self.assertEqual(stage.returncode, 1)
        self.assertEqual(stage.stderr, reason + SUMMARY + "extended: all of it: build/release/tests.log\n")

    def test_the_count_alone_where_all_pass(self):
        stage = self.run_tests("Passed 1 s\n100% tests passed, 0 tests failed out of 2\n", 0)
        self.assertEqual((stage.returncode, stage.stdout, stage.stderr), (0, "100% tests passed, 0 tests failed out of 2\n", ""))

    def test_the_place_of_a_failure_in_cpp(self):
        self.assert_says("/src/a_test.cpp:12: Failure\n", "[ RUN      ] Suite.Name\n/src/a_test.cpp:12: Failure\n  1\n")

    def test_the_reason_of_a_failure_in_python(self):
        self.assert_says("AssertionError: 1 != 2\nFAIL: test_name (__main__.Suite.test_name)\n",
                         "test_name ... FAIL\nFAIL: test_name (__main__.Suite.test_name)\nTraceback\nAssertionError: 1 != 2\n")

    def test_the_names_where_nothing_gives_a_reason(self):
        self.assert_says("", "understudy: ended\n")


if __name__ == "__main__":
    unittest.main()
