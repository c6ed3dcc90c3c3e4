"""plan(): the planners, as `understudy plan` has them."""
from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Union

from ._command import run

Value = Union[str, "os.PathLike[str]", bool, int, float, Sequence[float], Sequence[str]]


@dataclass(frozen=True)
class Program:
    """G-code that a planner made."""

    text: str  #: the file's whole text
    name: str  #: of the file, without a folder
    told: str  #: what the command said of it, and its warnings

    def write(self, path: str | os.PathLike[str]) -> Path:
        """Writes the text there; returns the path."""
        Path(path).write_text(self.text)
        return Path(path)


def _words(key: str, value: Value) -> list[str]:
    option = "--" + key.replace("_", "-")
    if isinstance(value, bool):
        return [option] if value else []
    if isinstance(value, (str, os.PathLike)):
        return [option, _path(value)]
    if isinstance(value, (int, float)) or not hasattr(value, "__len__"):
        return [option, repr(value)]
    several = [_path(one) if isinstance(one, (str, os.PathLike)) else repr(float(one)) for one in value]
    # Words are options that may be given again; numbers are the coordinates of one.
    if several and isinstance(value[0], (str, os.PathLike)):
        return [word for one in several for word in (option, one)]
    return [option, ",".join(several)] if key == "place" else [option, *several]


def _path(word: str | os.PathLike[str]) -> str:
    """A file as its whole path, since the planner runs elsewhere; other words as they are."""
    text = os.fspath(word)
    return os.path.abspath(text) if os.path.isfile(text) else text


def plan(kind: str, part: str | os.PathLike[str] | None = None, /, **options: Value) -> Program:
    """Plans a program: `plan("surface", "bottle", rows=3, feed=5)` is `understudy plan surface bottle --rows 3 --feed 5`.

    kind: surface, planar, waypoints, lattice, spiral, support-free or finishing. part: an STL in mm, a name under
    models/parts, or what the planner takes in its place. The keywords are the options of the command, in its units
    (mm, degrees, mm/s): True for a flag, a sequence for several values. InputError has the command's text.

    The command runs as a process of its own; that costs some 50 ms beside the planning.
    """
    name = f"{kind}.gcode"
    with tempfile.TemporaryDirectory(prefix="understudy-") as folder:
        words = ["plan", kind, *([_path(part)] if part is not None else [])]
        for key, value in options.items():
            words += _words(key, value)
        told = run([*words, "-o", name], folder)
        return Program((Path(folder) / name).read_text(), name, told)
