"""Twin: a script is the controller. Statuses, truth apart from belief, and the gap that Python closes."""
import sys
import threading
import unittest
from pathlib import Path

import numpy as np
import understudy
from understudy import InputError, Status, Twin, UrgentCommand

sys.path.insert(0, str(Path("examples/python").resolve()))
import gap_controller  # noqa: E402


def move_up(twin, way=5e-3, seconds=0.5, end=1.0):
    """Queues a straight move of the tip along z, up to a share of it; the times of its setpoints."""
    period = twin.machine.cycle_time
    count = round(seconds / period)
    poses = np.tile(twin.machine.home, (count, 1))
    poses[:, 2] += way * (1 - np.cos(np.pi * np.arange(1, count + 1) / count)) / 2
    axes, _ = twin.machine.axes(poses)
    times = twin.now + period * np.arange(1, count + 1)
    velocities = np.gradient(axes, period, axis=0)
    velocities[-1] = 0
    count = int(end * count)
    return twin.submit(times[:count].copy(), axes[:count].copy(), velocities=velocities[:count].copy()), times[:count]


class ThePort(unittest.TestCase):
    def test_what_is_accepted_is_executed_when_its_time_has_passed(self):
        twin = Twin("hexapod", as_built="nominal")
        status, times = move_up(twin)
        self.assertEqual(status, Status.ok)
        self.assertEqual((twin.state.accepted, twin.state.executed), (len(times), 0))
        middle = times[len(times) // 2]
        self.assertEqual(twin.wait_until(middle), Status.ok)
        self.assertAlmostEqual(twin.now, middle, delta=2 * twin.machine.cycle_time)
        self.assertTrue(0 < twin.state.executed < len(times))
        self.assertTrue(twin.state.moving)
        self.assertEqual(twin.wait_until(times[-1] + 0.1), Status.ok)
        self.assertEqual(twin.state.executed, len(times))
        # A nominal twin is off by its play and its steps alone: some tens of um.
        np.testing.assert_allclose(twin.true_pose()[2] - twin.machine.home[2], 5e-3, rtol=0, atol=0.1e-3)

    def test_stop_drops_the_queue(self):
        twin = Twin("hexapod", as_built="nominal")
        _, times = move_up(twin)
        twin.wait_until(times[len(times) // 2])
        self.assertEqual(twin.urgent(UrgentCommand.stop), Status.ok)
        self.assertEqual(twin.wait_until(times[-1] + 0.5), Status.ok)
        self.assertFalse(twin.state.moving)
        self.assertLess(twin.true_pose()[2] - twin.machine.home[2], 4.5e-3)

    def test_refusals_are_statuses(self):
        twin = Twin("hexapod")
        axes = np.tile(twin.machine.home_axes, (2, 1))
        self.assertEqual(twin.submit(np.array([1.0, 1.0]), axes), Status.rejected)
        self.assertEqual(twin.submit(np.array([1.0, 2.0]), 10 * axes), Status.rejected)
        self.assertEqual(twin.state.accepted, 0)
        room = twin.state.free_slots
        times = twin.now + twin.machine.cycle_time * np.arange(1, 2 * room + 1)
        self.assertEqual(twin.submit(times[:room].copy(), np.tile(axes[:1], (room, 1))), Status.ok)
        self.assertEqual(twin.submit(times[room:].copy(), np.tile(axes[:1], (room, 1))), Status.queue_full)
        self.assertEqual(twin.state.accepted, room)

    def test_a_fault_is_sticky(self):
        twin = Twin("hexapod")
        _, times = move_up(twin, end=0.5)  # the queue runs empty while the axes move
        self.assertEqual(twin.wait_until(times[-1] + 1), Status.faulted)
        self.assertEqual(twin.state.fault, "queue underrun")
        self.assertEqual(move_up(twin)[0], Status.faulted)
        self.assertEqual(twin.urgent(UrgentCommand.clear_fault), Status.ok)
        self.assertEqual(twin.state.fault, "no fault")

    def test_bad_arrays_and_options_are_named(self):
        twin = Twin("hexapod")
        axes = twin.machine.home_axes[None, :].copy()
        for call, words in (
                (lambda: twin.submit(np.array([1.0]), axes[:, :5].copy()), r"positions: of shape \(1, 5\), expected \(1, 6\)"),
                (lambda: twin.submit(np.array([1]), axes), "times: of type int64, expected float64"),
                (lambda: twin.submit(np.array([1.0]), axes, line=[1, 2]), "line: 2 numbers for 1 setpoints"),
                (lambda: twin.wait_until(float("nan")), "time: it is not finite"),
                (lambda: Twin("hexapod", engine="bulet"), "unknown engine 'bulet'"),
                (lambda: Twin("corexy").capture(), "no microscope")):
            with self.subTest(words), self.assertRaisesRegex(InputError, words):
                call()

    def test_a_region_is_clipped_to_the_sensor_whatever_it_asks_for(self):
        twin = Twin("hexapod", fixture="bottle")
        _, whole = twin.capture()
        status, frame = twin.capture((10, 20, 2**31 - 1, 2**31 - 1))
        self.assertEqual(status, Status.ok)
        self.assertEqual(frame.region, (10, 20, whole.region[2] - 10, whole.region[3] - 20))
        wide = np.lib.stride_tricks.as_strided(np.zeros(1, np.uint8), (1, 70000), (0, 0))
        with self.assertRaisesRegex(InputError, "image: 70000 pixels a side, at most 65536"):
            understudy.measure_dot(twin.machine, wide)

    def test_it_belongs_to_its_thread(self):
        twin, raised = Twin("hexapod"), []

        def elsewhere():
            try:
                twin.capture()
            except InputError as error:
                raised.append(str(error))

        thread = threading.Thread(target=elsewhere)
        thread.start()
        thread.join()
        self.assertIn("belongs to the thread that made it", raised[0])

    def test_equal_seeds_give_equal_pictures(self):
        frames = []
        for _ in range(2):
            twin = Twin("hexapod", fixture="bottle", seed=5)
            status, frame = twin.capture()
            self.assertEqual(status, Status.ok)
            frames.append(frame)
        self.assertTrue((frames[0].image == frames[1].image).all())
        self.assertEqual(frames[0].image.shape, (frames[0].region[3], frames[0].region[2]))
        self.assertGreater(frames[0].received_at, frames[0].exposed_at)


class TruthIsNotBelief(unittest.TestCase):
    def test_the_built_machine_stands_elsewhere(self):
        twins = [Twin("hexapod", as_built="manufactured", seed=seed) for seed in (1, 2)]
        for twin in twins:
            self.assertEqual(twin.machine.home.tobytes(), understudy.Machine("hexapod").home.tobytes())
        self.assertGreater(np.abs(twins[0].true_pose() - twins[1].true_pose()).max(), 1e-6)


class TheGap(unittest.TestCase):
    def test_a_controller_in_python_closes_it_into_the_band(self):
        for seed in (1, 2, 3):
            with self.subTest(seed):
                self.assertEqual(gap_controller.main(seed), 0)

    def test_its_reading_is_that_of_ours(self):
        twin = Twin("hexapod", fixture="bottle", as_built="nominal")
        part = understudy.Part(twin.machine, "bottle")
        start = gap_controller.above_ridge(twin.machine, part, 1e-3)
        gap_controller.Axis(twin, twin.machine.home).move(start[:3], speed=30e-3)
        _, frame = twin.capture()
        ours = understudy.read_gap(twin.machine, part, start, frame.image, frame.region[:2])
        mine = gap_controller.Eye(twin.machine, part, start).gap(gap_controller.dot_in(frame.image))
        # Two centroids of one speckled dot; the speckle's own noise is some 10 um.
        self.assertLess(abs(mine - ours[0]), 20e-6)
        self.assertLess(abs(ours[0] - twin.true_gap()), 50e-6)


if __name__ == "__main__":
    unittest.main()
