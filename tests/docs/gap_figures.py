#!/usr/bin/env python3
"""Prints the rows of docs/gap-control.md from a gap.json: each condition's figures over all surfaces, least to most.

usage: gap_figures.py GAP.json
"""

import json
import sys
from collections import Counter

GOOD = ("no speckle", "speckle", "ambient light, fivefold", "laser at a quarter")


def span(values, digits):
    return f"{min(values):.{digits}f} to {max(values):.{digits}f}" if values else "none"


def print_detectors(rows):
    for condition in dict.fromkeys(r["condition"] for r in rows):
        for detector in ("centroid", "Gaussian fit"):
            these = [r for r in rows if r["condition"] == condition and r["detector"] == detector]
            seen = [r for r in these if "sigma_um" in r]
            refused = [100 * r["missed"] / r["frames"] for r in these]
            print(f"detector {detector}, {condition}: sigma {span([r['sigma_um'] for r in seen], 1)} um, "
                  f"bias {span([abs(r['bias_um']) for r in seen], 1)} um, refused {span(refused, 0)} %")


def print_approaches(rows):
    for condition in dict.fromkeys(r["condition"] for r in rows):
        these = [r for r in rows if r["condition"] == condition]
        there = [r for r in these if r["reached"] > 0]
        print(f"approach, {condition}: reached {sum(r['reached'] for r in these)} of {sum(r['runs'] for r in these)}, "
              f"touches {sum(r['touches'] for r in these)}, error {span([r['error_um']['median'] for r in there], 1)} um, "
              f"time {span([r['settle_s']['median'] for r in there], 1)} s")


def print_followings(rows, name, conditions):
    these = [r for r in rows if r["condition"] in conditions]
    printed = [r for r in these if "in_band_fraction" in r]
    stops = Counter()
    for r in these:
        stops.update(r["stops"])
    told = ", ".join(f"{reason.removeprefix('on the path: ')} {count}" for reason, count in sorted(stops.items())) or "none"
    print(f"following, {name}: completed {sum(r['completed'] for r in these)} of {sum(r['runs'] for r in these)}, "
          f"touches {sum(r['touches'] for r in these)}, false stops {sum(r['false_stops'] for r in these)}, "
          f"in band {span([100 * r['in_band_fraction'] for r in printed], 0)} %, "
          f"error {span([r['error_um']['median'] for r in printed], 1)} um, "
          f"95 % {span([r['error_um']['p95'] for r in printed], 0)} um; stops: {told}")


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        figures = json.load(file)
    print_detectors(figures.get("detectors", []))
    print_approaches(figures.get("approaches", []))
    rows = figures.get("followings", [])
    if rows:
        print_followings(rows, "good light", GOOD)
    for condition in dict.fromkeys(r["condition"] for r in rows if r["condition"] not in GOOD):
        print_followings(rows, condition, (condition,))
    for row in figures.get("bottle", []):
        gap = row.get("gap_mm", {})
        print(f"bottle {row['gap_control']}: touched {row['touched']}, kept {row['kept']} of {row['machines']}, "
              f"in band {100 * row.get('in_band_fraction', 0):.1f} %, worst {100 * row.get('in_band_worst', 0):.1f} %, "
              f"gap {gap.get('p01')} / {gap.get('median')} / {gap.get('p99')} mm")


if __name__ == "__main__":
    main()
