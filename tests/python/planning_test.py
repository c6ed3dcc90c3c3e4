"""plan(): the command's programs, and its errors."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import understudy
from understudy import InputError

PLANS = {
    "spiral": (None, dict(machine="arm", radius=8, turns=1, temperature=210), ["--radius", "8", "--turns", "1", "--temperature", "210"]),
    "surface": ("bottle", dict(machine="hexapod", rows=2, tilt=(-10, 10), feed=4), ["--rows", "2", "--tilt", "-10", "10", "--feed", "4"]),
    "planar": ("slanted_box", dict(machine="hexapod", layer=0.3, walls=1), ["--layer", "0.3", "--walls", "1"]),
    "lattice": ("box:10x10x10", dict(machine="arm", strut=5), ["--strut", "5"]),
}


class ThePlanners(unittest.TestCase):
    def test_programs_are_those_of_the_command(self):
        for kind, (part, options, words) in PLANS.items():
            with self.subTest(kind), tempfile.TemporaryDirectory() as folder:
                program = understudy.plan(kind, part, **options)
                subprocess.run([os.environ["UNDERSTUDY_COMMAND"], "plan", kind, *([part] if part else []), *words,
                                "--machine", options["machine"], "-o", f"{folder}/{kind}.gcode"], check=True,
                               capture_output=True)
                theirs = (Path(folder) / f"{kind}.gcode").read_text().splitlines()
                mine = program.text.splitlines()
                # The first line repeats the command.
                self.assertIn("planned by: understudy plan", mine[0])
                self.assertEqual(mine[1:], theirs[1:])
                self.assertEqual(program.name, f"{kind}.gcode")

    def test_a_planned_program_is_rehearsed(self):
        program = understudy.plan("surface", "bottle", machine="hexapod", tilt=(-10, 10))
        record = understudy.rehearse(program, "hexapod", fixture="bottle", engine="quasistatic", pictures=False)
        self.assertGreater(record.summary["print"]["deposited_mm"], 0)
        self.assertEqual(record.title, "surface.gcode on hexapod")

    def test_errors_are_those_of_the_command(self):
        for kind, part, options, words in (("spiral", None, dict(radius=-1), "--radius -1 is outside 0..1000"),
                                           ("surface", "botle", {}, "bottle"),
                                           ("spiral", None, dict(radiuss=1), "--radiuss"),
                                           ("spirral", None, {}, "did you mean 'plan spiral'")):
            with self.subTest(words), self.assertRaisesRegex(InputError, words):
                understudy.plan(kind, part, **options)

    def test_a_command_of_another_version_is_refused(self):
        from understudy import _command
        with tempfile.TemporaryDirectory() as folder:
            other = Path(folder) / "understudy"
            other.write_text("#!/bin/sh\necho understudy 0.0.1\n")
            other.chmod(0o755)
            with self.assertRaisesRegex(InputError, "is 'understudy 0.0.1', this module is of version"):
                _command._check_version(str(other))


if __name__ == "__main__":
    unittest.main()
