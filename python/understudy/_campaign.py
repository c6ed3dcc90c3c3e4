"""campaign(): many rehearsals, as `understudy campaign` has them, with their rows as a DataFrame."""
from __future__ import annotations

import json
import os
import sqlite3
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _core
from ._command import run

if TYPE_CHECKING:
    import pandas  # type: ignore


@dataclass(frozen=True)
class Campaign:
    """The results of a campaign (docs/campaigns.md)."""

    folder: Path
    summary: dict[str, Any]  #: campaign.json: groups with their probabilities, intervals and quantiles

    @property
    def runs(self) -> pandas.DataFrame:
        """A row for each run, by its number: status, parameters and figures, as docs/campaigns.md#result-store names
        them. Read anew each time. Needs pandas."""
        pandas = _pandas()
        with closing(sqlite3.connect(f"{(self.folder / 'runs.sqlite').absolute().as_uri()}?mode=ro", uri=True)) as store:
            return pandas.read_sql("select * from runs order by run", store, index_col="run")

    @property
    def table(self) -> pandas.DataFrame:
        """A row for each group and figure, as table.csv has them. Needs pandas."""
        return _pandas().read_csv(self.folder / "table.csv")


def _pandas() -> Any:
    try:
        import pandas  # type: ignore
    except ImportError as error:
        raise ImportError("the rows of a campaign are a pandas.DataFrame: install pandas (Debian: python3-pandas), or "
                          "read runs.sqlite by sqlite3") from error
    return pandas


def read_campaign(folder: str | os.PathLike[str]) -> Campaign:
    """The results in that folder. InputError where it holds none."""
    path = Path(folder)
    try:
        summary = json.loads((path / "campaign.json").read_text(encoding="utf-8"))
    except OSError as error:
        raise _core.InputError(f"{path}: no results of a campaign: {error.strerror}") from error
    if summary.get("schema") != "understudy.campaign/1":
        raise _core.InputError(f"{path / 'campaign.json'}: of schema {summary.get('schema')!r}, this module reads "
                               "'understudy.campaign/1'")
    return Campaign(path, summary)


def campaign(file: str | os.PathLike[str], *, out: str | os.PathLike[str], workers: int | None = None,
             resume: bool = False) -> Campaign:
    """Runs the campaign of a file (docs/campaigns.md): `understudy campaign FILE --out OUT`.

    workers: processes that rehearse, as many as there are processors unless given. resume: takes the rows that `out`
    has already. The processes run beside Python. InputError and MachineError have the command's text; an interrupt
    ends the workers, and what is done stays for `resume`.
    """
    words = ["campaign", os.fspath(file), "--out", os.fspath(out), "--quiet"]
    if workers is not None:
        words += ["--workers", repr(workers)]
    if resume:
        words.append("--resume")
    run(words, answers=(0, 1))
    return read_campaign(out)
