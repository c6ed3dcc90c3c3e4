"""rehearse(): the options of `understudy rehearse` as keywords."""
from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from . import _core
from ._planning import Program

StrPath = str | os.PathLike[str]


def rehearse(
    program: StrPath | Program,
    machine: StrPath | None = None,
    *,
    fixture: StrPath | None = None,
    engine: str | None = None,
    as_built: StrPath | None = None,
    seed: int | None = None,
    gap_control: str | None = None,
    material: StrPath | None = None,
    before: StrPath | None = None,
    home_axes: Sequence[float] | None = None,
    register: bool | None = None,
    pattern: StrPath | None = None,
    places: int | None = None,
    tip_tolerance: float | None = None,
    orientation_tolerance: float | None = None,
    place: str | Sequence[float] | None = None,
    turn: float | None = None,
    spin: float | None = None,
    extruder_letter: str | None = None,
    ignore: str | Sequence[str] | None = None,
    macros: StrPath | None = None,
    temperature: float | None = None,
    nozzle: float | None = None,
    layer: float | None = None,
    strict: bool | None = None,
    relative_extrusion: bool | None = None,
    b_sign: int | None = None,
    c_sign: int | None = None,
    coordinates: str | None = None,
    as_printed: StrPath | None = None,
    intended: StrPath | None = None,
    depth_of_cut: float | None = None,
    stock: StrPath | None = None,
    profile: Sequence[float] | None = None,
    probe: Sequence[float] | None = None,
    max_time: float | None = None,
    pictures: bool | None = None,
    fault: str | Sequence[str] | None = None,
    progress: Callable[[float, str], object] | None = None,
) -> _core.Record:
    """Prints a program on the twin and says go or no-go.

    program: the path of G-code, KRL or RAPID, or what plan() returned. Every keyword is the option of the same name
    of `understudy rehearse`, in its unit (mm, degrees, C); one that is left out, or None, has that option's default:
    machine "hexapod", engine "mujoco", seed 1. `pictures=False` is --no-pictures. progress is called with the share
    that is done and a word, from another thread.

    A no-go is a result. InputError and MachineError carry the command's text. Ctrl-C ends the work. The interpreter
    is free meanwhile: other threads run.
    """
    options = {key: value for key, value in locals().items() if key not in ("program", "progress")}
    if not isinstance(program, Program):
        return _core.rehearse(os.fspath(program), options, progress)
    with tempfile.TemporaryDirectory(prefix="understudy-") as folder:
        return _core.rehearse(str(program.write(Path(folder) / program.name)), options, progress)
