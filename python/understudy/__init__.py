"""Understudy: a digital twin for machines that print in many directions.

SI units: metres, radians, seconds, kelvin. A pose is X_WT, the tool seen from the world W, as seven numbers
`x y z [m], qw qx qy qz`; axes are in the machine's order, [m] or [rad]. Files and summaries keep mm and degrees, and
their keys name the unit. docs/python.md tells the rest.

    import understudy
    record = understudy.rehearse("scenarios/song-bottle.gcode", fixture="bottle", engine="quasistatic")
    print(record.summary["verdict"], record.trace["gap"].min())
"""
from __future__ import annotations

import os as _os
from pathlib import Path as _Path

# Of a wheel: its machines, parts and materials lie beside this file.
_models = _Path(__file__).with_name("models")
if "UNDERSTUDY_MODELS" not in _os.environ and _models.is_dir():
    _os.environ["UNDERSTUDY_MODELS"] = str(_models)

from ._core import (  # noqa: E402
    SOLVE_STATUS,
    Calibration,
    Frame,
    InputError,
    Machine,
    MachineError,
    Part,
    Problem,
    Record,
    State,
    Status,
    UrgentCommand,
    __version__,
    benchmark_calibration,
    benchmark_gap,
    calibrate,
    estimator_names,
    laser,
    machine_names,
    measure_dot,
    microscope,
    models_folder,
    read_gap,
    sample_poses,
)
from ._campaign import Campaign, campaign, read_campaign  # noqa: E402
from ._planning import Program, plan  # noqa: E402
from ._rehearsal import rehearse  # noqa: E402
from ._twin import Twin  # noqa: E402

__all__ = [
    "SOLVE_STATUS", "Calibration", "Campaign", "Frame", "InputError", "Machine", "MachineError", "Part", "Problem",
    "Program", "Record", "State", "Status", "Twin", "UrgentCommand", "__version__", "benchmark_calibration",
    "benchmark_gap", "calibrate", "campaign", "estimator_names", "laser", "machine_names", "measure_dot",
    "microscope", "models_folder", "plan", "read_campaign", "read_gap", "rehearse", "sample_poses",
]
