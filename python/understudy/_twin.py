"""Twin: the twin as the port of a controller that is written in Python."""
from __future__ import annotations

from collections.abc import Sequence

from . import _core
from ._rehearsal import StrPath


class Twin(_core.Twin):
    """The twin as a MachinePort. Time is the port's: it passes inside wait_until() and capture().

    A call returns a Status, which is to be looked at; bad arrays raise InputError, an engine that fails MachineError.
    Use a Twin from the thread that made it.
    """

    def __init__(
        self,
        machine: StrPath | None = None,
        *,
        fixture: StrPath | None = None,
        engine: str | None = "quasistatic",
        as_built: StrPath | None = None,
        seed: int | None = None,
        material: StrPath | None = None,
        fault: str | Sequence[str] | None = None,
    ) -> None:
        """The keywords are those of rehearse(); the engine is the fast one unless another is named."""
        super().__init__({
            "machine": machine, "fixture": fixture, "engine": engine, "as_built": as_built, "seed": seed,
            "material": material, "fault": fault,
        })
