"""A gap controller in Python closes the gap on the twin, as the machine's own controller does before each bead.

It knows what a controller knows: the machine's description, the drawn part, and the pictures of the microscope. It
approaches the bottle from 2 mm along the tool axis, measures the laser's dot at every stop, turns it into a gap with
the local surface of the drawing, and goes on by a share of what is left. It stops where there is no dot.

    python3 examples/python/gap_controller.py [SEED]
"""
import sys

import numpy as np

import understudy
from understudy import Status

SHARE, SLOW_ZONE, TOLERANCE = 0.7, 0.15e-3, 8e-6  # of what is left; [m] above the aim; [m]
SETTLE = 0.05  # [s], rest before a picture


def must(status):
    if status != Status.ok:
        raise RuntimeError(f"the port answers {status.name}")


class Axis:
    """Straight moves of the tip along one line, the tool's orientation kept."""

    def __init__(self, twin, pose):
        self.twin, self.machine, self.pose = twin, twin.machine, pose.copy()

    def move(self, tip, speed=10e-3):
        """Goes to the tip [m] with a smooth start and end, and waits until the axes rest there."""
        way = tip - self.pose[:3]
        period = self.machine.cycle_time
        count = max(10, int(np.ceil(2 * np.linalg.norm(way) / speed / period)))
        t = np.arange(1, count + 1) / count
        poses = np.tile(self.pose, (count, 1))
        poses[:, :3] += (10 * t**3 - 15 * t**4 + 6 * t**5)[:, None] * way  # at rest at both ends
        axes, status = self.machine.axes(poses)
        if status.any():
            raise RuntimeError(f"no axes for the way: {understudy.SOLVE_STATUS[status.max()]}")
        velocities = np.gradient(axes, period, axis=0)
        velocities[-1] = 0
        times = self.twin.now + period * np.arange(1, count + 1)
        must(self.twin.submit(times, axes, velocities=velocities))
        must(self.twin.wait_until(times[-1] + SETTLE))
        self.pose[:3] = tip


class Eye:
    """Laser and microscope as the machine's file has them, inverted for the surface under the tool."""

    def __init__(self, machine, part, pose):
        self.laser, self.camera = understudy.laser(machine), understudy.microscope(machine)
        self.slope, self.curvature = part.surface_under(pose)

    def pixel(self, gap):
        """Where the dot of this gap is: beam, surface, camera, all in T."""
        X_TL, X_TC = self.laser["X_TL"], self.camera["X_TC"]
        origin, along = X_TL[:3, 3], X_TL[:3, 2]
        s = -origin[2] / along[2]
        for _ in range(20):  # where the beam meets z = -gap + slope . xy + 1/2 xy curvature xy
            xy = (origin + s * along)[:2]
            height = -gap + self.slope @ xy + 0.5 * xy @ self.curvature @ xy
            fall = along[2] - (self.slope + self.curvature @ xy) @ along[:2]
            s -= (origin[2] + s * along[2] - height) / fall
        x, y, z = X_TC[:3, :3].T @ (origin + s * along - X_TC[:3, 3])
        x, y = x / z, y / z
        k1, k2, p1, p2 = self.camera["distortion"]
        r2 = x * x + y * y
        radial = 1 + k1 * r2 + k2 * r2 * r2
        x, y = (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y)
        return self.camera["focal_px"] * np.array([x, y]) + self.camera["centre_px"]

    def gap(self, dot):
        """[m] of the gap whose dot is nearest to this one, by Gauss and Newton."""
        gap, step = 1e-3, 1e-6
        for _ in range(30):
            here = self.pixel(gap)
            rate = (self.pixel(gap + step) - here) / step
            by = rate @ (dot - here) / (rate @ rate)
            gap += by
            if abs(by) < 1e-9:
                return gap
        raise RuntimeError("no gap explains the dot")


def dot_in(image):
    """Centre of the brightest spot [px]: centroid above the surroundings in a window that follows it."""
    grey = image.astype(float)
    block = grey[:grey.shape[0] // 4 * 4, :grey.shape[1] // 4 * 4].reshape(grey.shape[0] // 4, 4, -1, 4).mean((1, 3))
    y, x = 4.0 * np.array(np.unravel_index(block.argmax(), block.shape)) + 1.5
    ground = np.median(grey)
    if block.max() < ground + 12:
        raise RuntimeError("no dot: nothing stands out of the picture")
    v, u = np.mgrid[:grey.shape[0], :grey.shape[1]]
    for _ in range(20):
        near = np.exp(-((u - x)**2 + (v - y)**2) / (2 * 12.0**2)) * np.clip(grey - ground - 6, 0, None)
        x, y = (near * u).sum() / near.sum(), (near * v).sum() / near.sum()
    return np.array([x, y])


def close_gap(twin, part, start):
    """From S' to the aim; returns the readings [m] and the time it took [s]."""
    limits, machine = twin.machine.gap_limits, twin.machine
    axis, eye = Axis(twin, machine.home), Eye(machine, part, start)
    up = np.array([0.0, 0.0, 1.0])
    axis.move(start[:3] + limits["standoff"] * up, speed=30e-3)
    began, readings = twin.now, []
    for _ in range(40):
        frames = 3 if readings and readings[-1] < limits["aim"] + SLOW_ZONE else 1
        seen = []
        for _ in range(frames):  # the tip creeps between them, so that the speckle changes
            status, frame = twin.capture()
            must(status)
            seen.append(eye.gap(dot_in(frame.image)))
            if frames > 1:
                axis.move(axis.pose[:3] - 2e-6 * up)
        readings.append(float(np.mean(seen)))
        left = readings[-1] - limits["aim"]
        if abs(left) < TOLERANCE:
            return readings, twin.now - began
        axis.move(axis.pose[:3] - (SHARE if left > 0 else 1) * left * up)
    raise RuntimeError("the gap does not close within 40 stops")


def above_ridge(machine, part, gap):
    """X_WT, upright, with this gap [m] to the bottle's ridge as it is drawn."""
    pose = machine.home
    pose[:2] = 0
    while (height := part.height_over(pose)) is None:  # it is asked within 20 mm
        pose[2] -= 10e-3
    pose[2] -= height - gap
    return pose


def main(seed):
    twin = understudy.Twin("hexapod", fixture="bottle", seed=seed)
    part = understudy.Part(twin.machine, "bottle")
    start = above_ridge(twin.machine, part, twin.machine.gap_limits["aim"])
    readings, seconds = close_gap(twin, part, start)
    band = [1e3 * twin.machine.gap_limits[end] for end in ("accepted_min", "accepted_max")]
    true, least = 1e3 * twin.true_gap(), 1e3 * twin.least_clearance()
    print("readings [mm]:", " ".join(f"{1e3 * reading:.3f}" for reading in readings))
    print(f"seed {seed}: the true gap is {true:.3f} mm after {len(readings)} stops and {seconds:.1f} s; the band is "
          f"{band[0]:.1f}..{band[1]:.1f} mm, the nozzle was never nearer than {least:.3f} mm")
    return 0 if band[0] <= true <= band[1] and least > 0 else 1


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 1))
