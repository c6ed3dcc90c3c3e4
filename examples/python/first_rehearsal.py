"""A first rehearsal: does the line on the bottle print, with gap control and without?

    python3 examples/python/first_rehearsal.py
"""
from pathlib import Path

import numpy as np

import understudy

PROGRAM = Path(__file__).resolve().parents[2] / "scenarios/song-bottle.gcode"


def main():
    for control in ("off", "start"):
        record = understudy.rehearse(PROGRAM, "hexapod", fixture="bottle", engine="quasistatic", seed=2,
                                     gap_control=control, pictures=False)
        trace, accuracy = record.trace, record.summary["accuracy"]
        printing = trace["extruding"]
        gap = 1e3 * trace["gap"][printing]
        error = 1e6 * trace["tip_error"][printing]
        print(f"gap control {control}: {record.summary['verdict']}")
        print(f"  gap {gap.min():.3f}..{gap.max():.3f} mm along the bead, tip error {np.sqrt((error**2).mean()):.0f} um "
              f"RMS ({accuracy['tip_rms_um']:.0f} um in the summary)")
        for finding in record.findings[:3]:
            print(f"  {finding['severity']}: {finding['message']}")
    print("the same from a shell:", record.command)


if __name__ == "__main__":
    main()
