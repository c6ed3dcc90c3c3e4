"""The command `understudy` of the same version, for what runs in a process of its own."""
from __future__ import annotations

import functools
import os
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

from . import _core


def command() -> str:
    """The command `understudy` that belongs to this module: $UNDERSTUDY_COMMAND, in the package, in the build tree,
    or on the PATH; of the module's version."""
    here = Path(__file__).parent
    places = [os.environ.get("UNDERSTUDY_COMMAND"), here / "bin/understudy", here / "../../cli/understudy",
              shutil.which("understudy")]
    found = next((str(place) for place in places if place and os.access(place, os.X_OK)), None)
    if not found:
        raise _core.InputError("this runs the command `understudy`, which is not on the PATH; UNDERSTUDY_COMMAND may "
                               "name it")
    _check_version(found)
    return found


@functools.lru_cache(maxsize=None)
def _check_version(found: str) -> None:
    answer = subprocess.run([found, "--version"], capture_output=True, text=True, check=False).stdout.strip()
    if answer != f"understudy {_core.__version__}":
        raise _core.InputError(f"{found} is '{answer}', this module is of version {_core.__version__}")


def run(words: Sequence[str], folder: str | os.PathLike[str] | None = None, answers: Sequence[int] = (0,)) -> str:
    """`understudy WORDS` in that folder; returns what it said. Status 2 is an InputError and each other one that is
    no answer a MachineError, with the command's text."""
    ran = subprocess.run([command(), *words], cwd=folder, capture_output=True, text=True, check=False)
    if ran.returncode in answers:
        return (ran.stdout + ran.stderr).strip()
    told = ran.stderr.strip().removeprefix("understudy: ")
    if ran.returncode == 2:
        raise _core.InputError(told)
    raise _core.MachineError(told or f"understudy {words[0]} ended with status {ran.returncode}")
