#!/usr/bin/env python3
"""Estimates the time of a program of PrusaSlicer by the rules of its own estimator, and by others, one after the other.

    python3 scripts/slicer_estimate.py scenarios/planar/box.gcode

The estimator: trapezoids with the acceleration and the jerk of each axis, as Marlin plans them (GCodeProcessor of PrusaSlicer 2.5, normal mode).
Limits are those of the comments at the program's end. The differences are the figures of docs/print-time.md.
"""
import argparse
import math
import re
from pathlib import Path

AXES = "XYZE"
MODES = {"M83": ("relative", True), "M82": ("relative", False)}


class Limits:
    def __init__(self, text):
        def first(key):
            return float(re.search(rf"^; {key} = ([\d.]+)", text, re.M)[1])

        self.feed, self.acceleration, self.jerk = ([first(f"machine_max_{what}_{axis.lower()}") for axis in AXES]
                                                   for what in ("feedrate", "acceleration", "jerk"))
        self.extruding, self.retracting = first("machine_max_acceleration_extruding"), first("machine_max_acceleration_retracting")

    def without_extruder(self):
        self.feed[3] = self.acceleration[3] = self.jerk[3] = self.retracting = 1e9


def moves(text):
    """Feed [mm/s] and way of each axis [mm] of every move."""
    position, feed, modes = [0.0] * 4, 0.0, {"relative": False}
    for line in text.splitlines():
        words = line.split(";")[0].split()
        if not words:
            continue
        values = {w[0]: float(w[1:]) for w in words[1:] if re.fullmatch(r"[A-Z]-?[\d.]+", w)}
        if words[0] in MODES:
            modes.update([MODES[words[0]]])
        elif words[0] == "G92":
            position = [values.get(axis, at) for axis, at in zip(AXES, position)]
        elif words[0] == "G28":
            position[:3] = [0.0] * 3
        elif words[0] in ("G0", "G1"):
            feed = values.get("F", 60 * feed) / 60
            end = [values.get(axis, at) for axis, at in zip(AXES, position)]
            if modes["relative"]:
                end[3] = position[3] + values.get("E", 0)
            way = [b - a for a, b in zip(position, end)]
            position = end
            if any(way) and feed > 0:
                yield feed, way


def change(before, after, whole):
    """Of an axis' speed at a junction; Marlin allows each side of a reversal the jerk."""
    if whole or (before > 0) == (after > 0):
        return abs(before - after)
    return max(abs(before), abs(after))


class Block:
    def __init__(self, feed, way, limits):
        still = not any(way[:3])
        self.length = abs(way[3]) if still else math.hypot(*way[:3])
        slopes = [w / self.length for w in way]
        self.cruise = min([feed] + [v / abs(s) for v, s in zip(limits.feed, slopes) if s])
        self.acceleration = min([limits.retracting if still else limits.extruding] +
                                [a / abs(s) for a, s in zip(limits.acceleration, slopes) if s])
        self.feed, self.speeds = feed, [self.cruise * s for s in slopes]
        self.safe = min([self.cruise] + [j for j, v in zip(limits.jerk, self.speeds) if abs(v) > j])
        self.entry = self.safe

    def junction(self, before, limits, whole, one_speed):
        share = min(1.0, self.cruise / before.feed)
        speed, factor = min(self.cruise, before.feed), 1.0
        for v, w, jerk in zip(before.speeds, self.speeds, limits.jerk):
            step = change(v * share * factor, w * factor, whole)
            factor *= min(1.0, jerk / step) if step else 1.0
        speed *= factor
        # "The machine will stop and start the movements anyway": with the start's speed, whatever the stop's was.
        if not one_speed and min(before.safe, self.safe) > 0.99 * speed:
            speed = self.safe
        self.entry = speed

    def reach(self, speed):
        """From `speed` at one end, at the other."""
        return math.sqrt(speed**2 + 2 * self.acceleration * self.length)

    def time(self, end):
        v, a = self.cruise, self.acceleration
        ramps = (2 * v * v - self.entry**2 - end**2) / (2 * a)
        if ramps <= self.length:
            return (2 * v - self.entry - end) / a + (self.length - ramps) / v
        peak = math.sqrt(max(self.entry**2, end**2, a * self.length + (self.entry**2 + end**2) / 2))
        return (2 * peak - self.entry - end) / a


def estimate(text, whole=False, one_speed=False, extruder=True):
    """[s]"""
    limits = Limits(text)
    if not extruder:
        limits.without_extruder()
    blocks = [Block(feed, way, limits) for feed, way in moves(text)]
    for before, block in zip(blocks, blocks[1:]):
        block.junction(before, limits, whole, one_speed)
    if not blocks:
        return 0.0
    for block, following in reversed(list(zip(blocks, blocks[1:]))):
        block.entry = min(block.entry, block.reach(following.entry))
    for block, following in zip(blocks, blocks[1:]):
        following.entry = min(following.entry, block.reach(block.entry))
    ends = [following.entry for following in blocks[1:]] + [blocks[-1].safe]
    return sum(block.time(end) for block, end in zip(blocks, ends))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path)
    text = parser.parse_args().program.read_text()
    said = re.search(r"estimated printing time \(normal mode\) = (.*)", text)
    print(f"the slicer says                               {said[1] if said else 'nothing'}")
    rules, last = {}, None
    for name, rule in (("by its rules", {}), ("one speed on both sides of a junction", {"one_speed": True}),
                       ("the jerk for the whole change of a reversal", {"whole": True}), ("no limits of the extruder", {"extruder": False})):
        rules |= rule
        now = estimate(text, **rules)
        print(f"{name:45} {now:8.1f} s" + (f" {now - last:+8.1f} s" if last else ""))
        last = now


if __name__ == "__main__":
    main()
