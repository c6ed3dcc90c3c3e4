"""Machines and the kinematics of arrays: answers of the command, in place, and bad arrays by their names."""
import os
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

import numpy as np
import understudy
from understudy import InputError, Machine


def poses_about_home(machine, count, seed=1, far=0.02):
    """Tips within `far` m and turns within 0.1 rad about home; (n, 7)."""
    random = np.random.default_rng(seed)
    poses = np.tile(machine.home, (count, 1))
    poses[:, :3] += random.uniform(-far, far, (count, 3))
    turn = random.uniform(-0.1, 0.1, (count, 3))
    w, (x, y, z) = poses[:, 3], poses[:, 4:].T
    by = np.hstack([np.sqrt(1 - (turn**2).sum(1) / 4)[:, None], turn / 2])
    a, b, c, d = by.T
    poses[:, 3:] = np.stack([a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y,
                             a * y - b * z + c * w + d * x, a * z + b * y - c * x + d * w], axis=1)
    return poses


def table_of(command, machine, header, rows):
    """What `understudy axes` or `poses` prints for the rows: numbers, and statuses in words."""
    text = header + "\n" + "\n".join(",".join(repr(float(v)) for v in row) for row in rows) + "\n"
    run = subprocess.run([os.environ["UNDERSTUDY_COMMAND"], command, "--machine", machine], input=text, text=True,
                         capture_output=True, check=True)
    lines = [line.split(",", len(rows[0]) if command == "axes" else 7) for line in run.stdout.splitlines()[1:]]
    return lines


class TheCommandIsTheReference(unittest.TestCase):
    def test_axes_are_those_of_the_command(self):
        for name in ("hexapod", "arm", "five-axis"):
            with self.subTest(name):
                machine = Machine(name)
                poses = poses_about_home(machine, 50)
                axes, status = machine.axes(poses)
                unit = np.array([1e3 if u == "m" else 180 / np.pi for u in machine.axis_units])
                in_mm = poses * np.array([1e3, 1e3, 1e3, 1, 1, 1, 1])
                told = table_of("axes", name, "x_mm,y_mm,z_mm,qw,qx,qy,qz", in_mm)
                broken = machine.limits_broken(poses, axes)
                for row, (line, words) in enumerate(zip(told, broken)):
                    *numbers, why = ",".join(line).split(",", len(unit))
                    if why == "ok":
                        self.assertEqual(understudy.SOLVE_STATUS[status[row]], "ok")
                        # The command prints 1 nm and 1e-6 degrees.
                        np.testing.assert_allclose(axes[row] * unit, np.array(numbers, float), rtol=0, atol=1e-6)
                    self.assertEqual(words or "ok", why)

    def test_poses_of_axes_of_poses_are_the_poses(self):
        for name in ("hexapod", "arm"):
            with self.subTest(name):
                machine = Machine(name)
                poses = poses_about_home(machine, 300)
                axes, status = machine.axes(poses)
                self.assertTrue((status == 0).all())
                back, again = machine.poses(axes)
                self.assertTrue((again == 0).all())
                signed = poses * np.where(np.arange(7) < 3, 1, np.sign(poses[:, 3:4]))
                # Newton's steps end 1e-12 m from a hexapod's strut lengths; its condition number is some tens.
                np.testing.assert_allclose(back, signed, rtol=0, atol=1e-9)

    def test_the_number_of_threads_changes_no_bit(self):
        machine = Machine("hexapod")
        poses = poses_about_home(machine, 40001)
        one, _ = machine.axes(poses, threads=1)
        for threads in (2, 3, 8):
            self.assertEqual(one.tobytes(), machine.axes(poses, threads=threads)[0].tobytes())


class ArraysStayWhereTheyAre(unittest.TestCase):
    def setUp(self):
        self.machine = Machine("hexapod")
        self.poses = poses_about_home(self.machine, 100)

    def test_answers_are_written_into_out(self):
        out = np.full((100, 6), -1.0)
        axes, _ = self.machine.axes(self.poses, out=out)
        self.assertIs(axes, out)
        self.assertTrue((out > 0).all())

    def test_the_input_is_read_and_left(self):
        before = self.poses.copy()
        self.poses.setflags(write=False)
        self.machine.axes(self.poses)
        self.assertTrue((self.poses == before).all())

    def test_a_row_without_an_answer_is_nan_and_says_why(self):
        self.poses[3, :3] = 10, 0, 0
        self.poses[4, 3:] = 0
        self.poses[5, 0] = np.nan
        axes, status = self.machine.axes(self.poses)
        self.assertEqual(understudy.SOLVE_STATUS[status[4]], "bad input")
        self.assertNotEqual(status[5], 0)
        self.assertTrue(np.isnan(axes[[4, 5]]).all())
        self.assertFalse(np.isnan(axes[6:]).any())
        self.assertIn("strut", self.machine.limits_broken(self.poses[3:4].copy(), axes[3:4].copy())[0])

    def test_no_rows_are_no_error(self):
        axes, status = self.machine.axes(np.empty((0, 7)))
        self.assertEqual((axes.shape, status.shape), ((0, 6), (0,)))

    def test_bad_arrays_are_named(self):
        p = self.poses
        for bad, words in ((p[:, :6].copy(), r"poses: of shape \(100, 6\), expected \(n, 7\): x y z \[m\], qw"),
                           (p[0], r"poses: of shape \(7,\), expected \(n, 7\)"),
                           (p.astype(np.float32), "poses: of type float32, expected float64"),
                           (np.asfortranarray(p), "poses: its rows do not lie one after the other.*ascontiguousarray"),
                           (p[::2], "poses: its rows do not lie one after the other"),
                           (p.tolist(), r"poses: a list is no numpy.ndarray; expected float64 of shape \(n, 7\)"),
                           (p.astype(">f8"), "poses: of type >f8, expected float64"),
                           (None, "poses: a NoneType is no numpy.ndarray")):
            with self.subTest(words), self.assertRaisesRegex(InputError, words):
                self.machine.axes(bad)
        with self.assertRaisesRegex(InputError, r"axes: of shape \(100, 5\), expected \(100, 6\): l1 \[m\] l2"):
            self.machine.axes(p, out=np.empty((100, 5)))
        fixed = np.empty((100, 6))
        fixed.setflags(write=False)
        with self.assertRaisesRegex(InputError, "axes: it may not be written"):
            self.machine.axes(p, out=fixed)
        with self.assertRaisesRegex(InputError, r"threads -1 is outside 0\.\.1024"):
            self.machine.axes(p, threads=-1)


class TheInterpreterIsFree(unittest.TestCase):
    def test_other_threads_run_meanwhile(self):
        machine = Machine("arm")
        poses = poses_about_home(machine, 60000)
        ticks = []
        done = threading.Event()

        def tick():
            while not done.is_set():
                ticks.append(time.perf_counter())
                time.sleep(0.001)

        ticking = threading.Thread(target=tick)
        ticking.start()
        start = time.perf_counter()
        machine.axes(poses, threads=1)
        end = time.perf_counter()
        done.set()
        ticking.join()
        # With the lock held there would be none between start and end, some 50 ms of them.
        self.assertGreater(sum(start + 0.005 < t < end - 0.001 for t in ticks), 0)


class Machines(unittest.TestCase):
    def test_home_is_where_the_home_axes_lead(self):
        for name in understudy.machine_names():
            with self.subTest(name):
                machine = Machine(name)
                home, status = machine.poses(machine.home_axes[None, :].copy())
                self.assertEqual(status[0], 0)
                np.testing.assert_allclose(home[0, :3], machine.home[:3], rtol=0, atol=1e-9)
                low, high = machine.axis_limits.T
                self.assertTrue((machine.home_axes >= low).all() and (machine.home_axes <= high).all())

    def test_errors_are_those_of_the_command(self):
        with self.assertRaises(InputError) as raised:
            Machine("hexapode")
        run = subprocess.run([os.environ["UNDERSTUDY_COMMAND"], "axes", "--machine", "hexapode"], input="", text=True,
                             capture_output=True, check=False)
        self.assertEqual(run.returncode, 2)
        self.assertEqual(f"understudy: {raised.exception}\n", run.stderr)
        self.assertIsInstance(raised.exception, ValueError)

    def test_an_error_of_a_file_has_its_place(self):

        text = Path(Machine("hexapod").file).read_text().replace("laser:", "lazer:", 1)
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            file.write(text)
            file.flush()
            with self.assertRaises(InputError) as raised:
                Machine(file.name)
        self.assertEqual(raised.exception.file, file.name)
        self.assertGreater(raised.exception.line, 0)


if __name__ == "__main__":
    unittest.main()
