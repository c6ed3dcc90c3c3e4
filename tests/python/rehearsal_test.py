"""rehearse(): the command's bytes, arrays of the trace, errors and Ctrl-C."""
import json
import os
import shlex
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np
import understudy
from understudy import InputError

BOTTLE = str(Path("scenarios/song-bottle.gcode").resolve())
OPTIONS = dict(fixture="bottle", engine="quasistatic", seed=2, gap_control="start", as_built="sampled")


class TheCommandIsTheReference(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = Path(cls.folder.name)
        cls.record = understudy.rehearse(BOTTLE, **OPTIONS)
        words = shlex.split(cls.record.command)
        assert words[:2] == ["understudy", "rehearse"], words
        cls.run_command = subprocess.run([os.environ["UNDERSTUDY_COMMAND"], *words[1:]], cwd=cls.out,
                                         capture_output=True, text=True, check=False)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_a_record_repeats_to_the_byte_by_its_command(self):
        self.assertIn(self.run_command.returncode, (0, 1), self.run_command.stderr)
        theirs = self.out / "rehearsal"
        self.record.write(str(self.out / "mine"))
        for name in ("summary.json", "trace.csv", "as-built.yaml", "frames/approach.csv"):
            self.assertEqual((theirs / name).read_bytes(), (self.out / "mine" / name).read_bytes(), name)
        self.assertEqual((theirs / "summary.json").read_text(), self.record.summary_json)
        self.assertEqual((theirs / "trace.csv").read_text(), self.record.trace_csv)
        self.assertEqual({p.name for p in theirs.iterdir()}, {p.name for p in (self.out / "mine").iterdir()})

    def test_the_summary_is_that_of_the_file(self):
        self.assertEqual(self.record.summary, json.loads((self.out / "rehearsal/summary.json").read_text()))
        self.assertEqual(self.record.go, self.record.summary["verdict"] == "go")
        self.assertEqual(self.record.findings, self.record.summary["findings"])

    def test_arrays_of_the_trace_are_its_columns(self):
        table = np.genfromtxt(self.out / "rehearsal/trace.csv", delimiter=",", names=True)
        trace = self.record.trace
        np.testing.assert_allclose(trace["time"], table["time_s"], rtol=0, atol=1e-6)
        np.testing.assert_array_equal(trace["line"], table["line"].astype(int))
        np.testing.assert_array_equal(trace["extruding"], table["extruding"] == 1)
        # trace.csv keeps a tenth of what its instruments resolve: 0.1 um.
        np.testing.assert_allclose(1e3 * trace["tip"][:, 2], table["z_mm"], rtol=0, atol=1e-4)
        np.testing.assert_allclose(1e3 * trace["axes"][:, 0], table["l1_mm"], rtol=0, atol=1e-4)
        seen = np.isfinite(table["gap_mm"])
        np.testing.assert_allclose(1e3 * trace["gap"][seen], table["gap_mm"][seen], rtol=0, atol=1e-4)
        np.testing.assert_array_equal(trace["tip"], trace["pose"][:, :3])

    def test_views_outlive_the_record_and_cannot_be_written(self):
        record = understudy.rehearse(BOTTLE, engine="quasistatic", fixture="bottle", gap_control="off", pictures=False)
        tip, gap = record.trace["tip"], record.trace["gap"]
        copy = tip.copy()
        del record
        self.assertTrue((tip == copy).all())
        with self.assertRaises(ValueError):
            gap[0] = 0

    def test_frames_have_pictures_and_the_truth(self):
        frames = self.record.frames
        self.assertEqual(len(frames), self.record.summary["gap"]["frames"])
        last = frames[-1]
        height, width = last["image"].shape
        self.assertEqual((width, height), last["region"][2:])
        self.assertEqual(last["image"].dtype, np.uint8)
        self.assertLess(abs(last["reading"] - last["true_gap"]), 50e-6)  # the dot's noise is some um


class BadInput(unittest.TestCase):
    def test_errors_are_those_of_the_command(self):
        for options, flags in ((dict(engine="mujocco"), ["--engine", "mujocco"]),
                               (dict(machine="hexapode"), ["--machine", "hexapode"]),
                               (dict(fixture="botle"), ["--fixture", "botle"]),
                               (dict(gap_control="on"), ["--gap-control", "on"])):
            with self.subTest(flags), self.assertRaises(InputError) as raised:
                understudy.rehearse(BOTTLE, **options)
            run = subprocess.run([os.environ["UNDERSTUDY_COMMAND"], "rehearse", BOTTLE, *flags],
                                 cwd=tempfile.gettempdir(), capture_output=True, text=True, check=False)
            self.assertEqual(run.returncode, 2)
            self.assertEqual(f"understudy: {raised.exception}\n", run.stderr)

    def test_values_of_options_are_named(self):
        for options, words in ((dict(seed=-1), "seed -1: expected a whole number from 0"),
                               (dict(seed=1.5), "seed 1.5: expected a whole number"),
                               (dict(turn=400), r"turn 400: expected -360\.\.360"),
                               (dict(tip_tolerance=0), "tip_tolerance 0: expected a number above 0"),
                               (dict(place=(1, 2)), r"place \(1, 2\): expected 3 numbers"),
                               (dict(pictures="no"), "pictures 'no': expected True or False"),
                               (dict(fixture=""), "fixture is empty: leave the option out"),
                               (dict(b_sign=2), r"b_sign 2: expected"),
                               (dict(engine=3), "engine 3: expected a str or a path")):
            with self.subTest(words), self.assertRaisesRegex(InputError, words):
                understudy.rehearse(BOTTLE, **options)

    def test_a_file_that_is_none_has_its_place(self):
        with tempfile.NamedTemporaryFile("w", suffix=".gcode") as file:
            file.write("G21\nG1 X1 Y1 Z50 Q7\n")
            file.flush()
            with self.assertRaises(InputError) as raised:
                understudy.rehearse(file.name, strict=True, engine="quasistatic", gap_control="off")
        self.assertEqual((raised.exception.file, raised.exception.line), (file.name, 2))

    def test_nothing_is_left_where_a_folder_cannot_be_replaced(self):
        record = understudy.rehearse(BOTTLE, **OPTIONS, pictures=False)
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "mine.txt").write_text("a user's own")
            with self.assertRaises(InputError):
                record.write(folder)
            self.assertEqual(os.listdir(folder), ["mine.txt"])


class WhileItRuns(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_progress_is_told(self):
        told = []
        understudy.rehearse(BOTTLE, **OPTIONS, progress=lambda share, what: told.append((share, what)))
        self.assertTrue(told)
        self.assertTrue(all(0 <= share <= 1 and what for share, what in told))

    def test_two_rehearsals_run_side_by_side(self):
        records = [None, None]

        def run(n):
            records[n] = understudy.rehearse(BOTTLE, **OPTIONS, pictures=False)

        threads = [threading.Thread(target=run, args=(n,)) for n in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(records[0].trace_csv, records[1].trace_csv)

    def test_ctrl_c_ends_it(self):
        # Two hours of motion, so that no computer is done with them before the signal arrives.
        moves = "G1 X10\nG1 X-10\n" * 1800
        program = self.folder / "long.gcode"
        program.write_text(f"G21\nG90\nG1 X0 Y0 Z60 F600\n{moves}")
        script = ("import understudy\nprint('started', flush=True)\n"
                  f"understudy.rehearse({str(program)!r}, engine='mujoco', gap_control='off')\n")
        process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True)
        self.assertEqual(process.stdout.readline(), "started\n")
        try:
            process.wait(1)
        except subprocess.TimeoutExpired:
            pass
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
        self.assertIn("KeyboardInterrupt", errors)
        self.assertNotEqual(process.returncode, 0)


if __name__ == "__main__":
    unittest.main()
