"""calibrate() of arrays, estimators in Python, and the benchmarks."""
import json
import os
import subprocess
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np
import understudy
from understudy import InputError, Machine


class Mine:
    """Newton's steps on the measured poses' errors, by differences of the twin's own model."""

    def __init__(self, steps=10):
        self.steps, self.threads = steps, set()

    def calibrate(self, problem):
        self.threads.add(threading.get_ident())
        whiten = np.linalg.inv(np.linalg.cholesky(problem.covariances))
        errors = lambda p: np.einsum("nij,nj->ni", whiten, problem.residuals(p)).ravel()  # noqa: E731
        parameters = problem.nominal
        for _ in range(self.steps):
            here = errors(parameters)
            rates = np.stack([(errors(parameters + 1e-5 * e) - errors(parameters - 1e-5 * e)) / 2e-5
                              for e in np.eye(len(parameters))], axis=1)
            by = np.linalg.lstsq(rates, -here, rcond=1e-7)[0]
            parameters = parameters + by
            if np.abs(by).max() < 1e-9:
                break
        return parameters, np.linalg.pinv(rates.T @ rates, rcond=1e-14)


class FromArrays(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.machine = Machine("hexapod")
        cls.axes, cls.poses = understudy.sample_poses(cls.machine, 24, as_built="manufactured", seed=3)

    def test_it_is_the_command_s_calibration(self):
        found = understudy.calibrate(self.machine, self.axes, self.poses, noise=(20e-6, 0.2e-3))
        header = "l1_mm,l2_mm,l3_mm,l4_mm,l5_mm,l6_mm,x_mm,y_mm,z_mm,qw,qx,qy,qz\n"
        rows = np.hstack([1e3 * self.axes, 1e3 * self.poses[:, :3], self.poses[:, 3:]])
        with tempfile.TemporaryDirectory() as folder:
            table = Path(folder) / "measured.csv"
            table.write_text(header + "".join(",".join(map(repr, row)) + "\n" for row in rows.tolist()))
            run = subprocess.run([os.environ["UNDERSTUDY_COMMAND"], "calibrate", table, "--machine", "hexapod",
                                  "--noise", "20", "0.2", "-o", f"{folder}/theirs.yaml"],
                                 capture_output=True, text=True, check=False)
            self.assertEqual(run.returncode, 0, run.stderr)
            found.write(f"{folder}/mine.yaml")
            theirs = Machine(f"{folder}/theirs.yaml")
            mine = Machine(f"{folder}/mine.yaml")
        there = theirs.axes(self.poses)[0]
        # Both files keep 1 nm; the commanded lengths come back through 24 joints' worth of such roundings.
        np.testing.assert_allclose(mine.axes(self.poses)[0], there, rtol=0, atol=1e-8)
        np.testing.assert_allclose(found.machine.axes(self.poses)[0], there, rtol=0, atol=1e-8)

    def test_what_is_told_of_it(self):
        found = understudy.calibrate(self.machine, self.axes, self.poses)
        self.assertEqual(len(found.names), 42)
        self.assertEqual(found.covariance.shape, (42 + 1, 42 + 1) if found.covariance.shape[0] == 43 else (42, 42))
        np.testing.assert_allclose(np.sqrt(np.diag(found.covariance))[:42], found.sigma, rtol=1e-6)
        self.assertEqual(found.residuals.shape, (24, 6))
        self.assertTrue(found.used.all())
        self.assertEqual(found.degrees_of_freedom, 24 * 6 - 42)
        # Chi-square of 102 degrees of freedom: six standard deviations about its mean.
        self.assertLess(abs(found.chi_square - 102), 6 * np.sqrt(2 * 102))
        self.assertLess(np.abs(found.residuals).max(), np.abs(found.residuals_before).max())

    def test_a_chain_is_calibrated_too(self):
        arm = Machine("arm")
        axes, poses = understudy.sample_poses(arm, 30, as_built="manufactured", seed=1)
        found = understudy.calibrate(arm, axes, poses)
        self.assertTrue(found.redundant)
        tips = found.machine.poses(axes)[0]
        off = np.linalg.norm(tips[:, :3] - poses[:, :3], axis=1)
        self.assertLess(np.sqrt((off**2).mean()), 60e-6)  # 20 um on each of three axes, 35 um, fitted
        before = np.linalg.norm(arm.poses(axes)[0][:, :3] - poses[:, :3], axis=1)
        self.assertGreater(before.mean(), 5 * off.mean())

    def test_what_the_poses_lack_is_told(self):
        with self.assertRaisesRegex(InputError, "poses"):
            understudy.calibrate(self.machine, self.axes[:5].copy(), self.poses[:5].copy())

    def test_bad_arguments_are_named(self):
        for change, words in ((dict(estimator="robusst"), "did you mean robust"),
                              (dict(estimator=3), "estimator: a int is neither a name nor"),
                              (dict(noise=(0, 1)), "noise: 0 m and 1 rad: both are above 0"),
                              (dict(noise="20um"), r"noise: expected \(position"),
                              (dict(noise=np.eye(6)), r"noise: expected .* covariances of shape \(24, 6, 6\)"),
                              (dict(approach=np.full((24, 6), 2.0)), "approach: 2 is none of -1, 0, 1"),
                              (dict(axes=self.axes[:9].copy()), r"poses: of shape \(24, 7\), expected \(9, 7\)")):
            arguments = dict(machine=self.machine, axes=self.axes, poses=self.poses) | change
            with self.subTest(words), self.assertRaisesRegex(InputError, words):
                understudy.calibrate(**arguments)


class WrittenInPython(unittest.TestCase):
    def test_it_finds_what_ours_finds(self):
        for name in ("hexapod", "arm"):
            with self.subTest(name):
                machine = Machine(name)
                axes, poses = understudy.sample_poses(machine, 24, as_built="manufactured", seed=3)
                ours = understudy.calibrate(machine, axes, poses)
                mine = understudy.calibrate(machine, axes, poses, estimator=Mine())
                self.assertEqual(mine.estimator, "Mine")
                # One likelihood has one maximum; the search ends at 1e-9 of it.
                self.assertAlmostEqual(mine.chi_square / ours.chi_square, 1, delta=1e-3)
                apart = mine.machine.poses(axes)[0] - ours.machine.poses(axes)[0]
                self.assertLess(np.abs(apart).max(), 1e-6)

    def test_what_it_raises_is_told(self):
        machine = Machine("hexapod")
        axes, poses = understudy.sample_poses(machine, 24)

        def refuses(problem):
            raise ArithmeticError("I give up")

        for estimator, words in ((refuses, "ArithmeticError: I give up"), (lambda p: "none", "it returned a str"),
                                 (lambda p: p.nominal[:41], "parameters: 41 numbers, expected 42"),
                                 (lambda p: p.nominal * np.nan, "not all of them are finite"),
                                 (lambda p: (p.nominal, np.eye(3)), r"covariance: of shape \(3, 3\), expected \(42, 42\)"),
                                 (lambda p: p.nominal * 0, "cannot reach pose 1")):
            with self.subTest(words), self.assertRaisesRegex(InputError, words):
                understudy.calibrate(machine, axes, poses, estimator=estimator)

    def test_a_problem_that_is_kept_is_whole(self):
        for name in ("hexapod", "arm"):
            machine, kept = Machine(name), []
            axes, poses = understudy.sample_poses(machine, 24, as_built="manufactured", seed=3)

            def keeps(problem):
                kept.append((problem, problem.poses, problem.residuals(problem.nominal)))
                return problem.nominal

            understudy.calibrate(machine, axes, poses, estimator=keeps)
            for problem, measured, residuals in kept:
                np.testing.assert_array_equal(problem.poses, measured)
                np.testing.assert_array_equal(problem.residuals(problem.nominal), residuals)

    def test_it_enters_the_benchmark_beside_ours(self):
        entrant = Mine()
        result = understudy.benchmark_calibration(
            "hexapod", ["maximum_likelihood", entrant], trials=3, poses=[12], disturbances=["none"], threads=2)
        text = json.dumps(result)
        self.assertIn("Mine", text)
        again = understudy.benchmark_calibration(
            "hexapod", ["maximum_likelihood", entrant], trials=3, poses=[12], disturbances=["none"], threads=1)
        for of in (result, again):
            of.pop("timing", None)
        self.assertEqual(result, again)

    def test_the_benchmark_of_ours_is_the_command_s(self):
        mine = understudy.benchmark_calibration("hexapod", ["robust"], trials=2, poses=[12], disturbances=["none"])
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([os.environ["UNDERSTUDY_COMMAND"], "benchmark", "calibration", "--estimators", "robust",
                            "--trials", "2", "--poses", "12", "--disturbances", "none", "--out", f"{folder}/b"],
                           capture_output=True, check=True)
            theirs = json.loads((Path(folder) / "b/benchmark.json").read_text())
        for of in (mine, theirs):
            of.pop("timing", None)
            of.pop("command", None)
            of.get("provenance", {}).pop("command", None)
        self.assertEqual(mine, theirs)


class TheGapBench(unittest.TestCase):
    def test_it_is_the_command_s(self):
        mine = understudy.benchmark_gap(parts=["approach"], trials=1, seed=4)
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([os.environ["UNDERSTUDY_COMMAND"], "benchmark", "gap", "--part", "approach", "--trials", "1",
                            "--seed", "4", "--out", f"{folder}/g"], capture_output=True, check=True)
            theirs = json.loads((Path(folder) / "g/gap.json").read_text())
        for of in (mine, theirs):
            of.pop("command", None)
            of.get("provenance", {}).pop("command", None)
        self.assertEqual(mine, theirs)


if __name__ == "__main__":
    unittest.main()
