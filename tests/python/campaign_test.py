"""campaign(): rows as a DataFrame, the command's own files, and its errors."""
import csv
import sqlite3
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import pandas
import understudy
from understudy import InputError

SCENARIO = """name: short-line
description: a short line on the bottle
source: none
machine: hexapod
plan: surface bottle --tilt 0 2
fixture: bottle
as_built: sampled
seed: 1
gap_control: "off"
engine: quasistatic
expect:
  - {metric: verdict, equals: go, source: a test}
"""
CAMPAIGN = """name: aims
description: two aims on two machines
scenarios: [short-line.yaml]
seeds: 1-2
parameters:
  - {key: machine.gap.aim_mm, values: [0.12, 0.15]}
metrics: [gap.start_mm]
"""


class Campaigns(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.kept = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.kept.name)
        (cls.folder / "short-line.yaml").write_text(SCENARIO)
        (cls.folder / "aims.yaml").write_text(CAMPAIGN)
        cls.done = understudy.campaign(cls.folder / "aims.yaml", out=cls.folder / "out", workers=2)

    @classmethod
    def tearDownClass(cls):
        cls.kept.cleanup()

    def test_rows_are_those_of_the_store(self):
        runs = self.done.runs
        self.assertIsInstance(runs, pandas.DataFrame)
        store = sqlite3.connect(self.folder / "out/runs.sqlite")
        rows = store.execute('select run, seed, status, "machine.gap.aim_mm", "gap.start_mm" from runs order by run').fetchall()
        store.close()
        self.assertEqual(len(rows), 4)
        self.assertEqual(list(runs.index), [row[0] for row in rows])
        for column, k in (("seed", 1), ("status", 2), ("machine.gap.aim_mm", 3), ("gap.start_mm", 4)):
            self.assertEqual(list(runs[column]), [row[k] for row in rows])
        # Without gap control the aim moves the gap by itself, machine by machine.
        aims = runs.groupby("machine.gap.aim_mm")["gap.start_mm"].mean()
        self.assertEqual(list(aims.index), [0.12, 0.15])

    def test_summary_and_table_are_those_of_the_command(self):
        self.assertEqual(self.done.summary["name"], "aims")
        with open(self.folder / "out/table.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        table = self.done.table
        self.assertEqual(len(table), len(rows))
        self.assertEqual(list(table.columns), list(rows[0]))
        again = understudy.read_campaign(self.folder / "out")
        self.assertEqual(again.summary, self.done.summary)

    def test_resumed_it_runs_nothing_again(self):
        before = self.done.runs
        again = understudy.campaign(self.folder / "aims.yaml", out=self.folder / "out", resume=True)
        pandas.testing.assert_frame_equal(before, again.runs)  # with `seconds`: the rows are the old ones

    def test_errors_are_those_of_the_command(self):
        (self.folder / "bad.yaml").write_text(CAMPAIGN.replace("gap.aim_mm", "gap.aim_m"))
        with self.assertRaisesRegex(InputError, "aim_m.*aim_mm"):
            understudy.campaign(self.folder / "bad.yaml", out=self.folder / "bad")
        self.assertFalse((self.folder / "bad").exists())
        with self.assertRaisesRegex(InputError, "no results of a campaign"):
            understudy.read_campaign(self.folder)

    def test_without_pandas_it_says_what_to_install(self):
        with mock.patch.dict(sys.modules, {"pandas": None}), self.assertRaisesRegex(ImportError, "python3-pandas"):
            _ = self.done.runs


if __name__ == "__main__":
    unittest.main()
