"""The trace that `understudy export trace` writes, read by h5py."""
import csv
import os
import pathlib
import subprocess
import tempfile
import unittest

try:
    import h5py
except ImportError:
    h5py = None

COMMAND = os.environ["UNDERSTUDY_COMMAND"]


def run(*words):
    return subprocess.run([COMMAND, *words], capture_output=True, text=True)


@unittest.skipIf(h5py is None, "h5py is not installed (Debian: python3-h5py)")
class TraceFile(unittest.TestCase):
    def test_it_holds_what_the_table_holds(self):
        with tempfile.TemporaryDirectory() as place:
            folder = pathlib.Path(place, "results")
            run("rehearse", "scenarios/song-bottle.gcode", "--fixture", "bottle", "--engine", "quasistatic", "--gap-control", "off",
                "--no-pictures", "--out", folder)
            written = run("export", "trace", folder, "-o", pathlib.Path(place, "trace.h5"))
            self.assertEqual((written.returncode, written.stderr), (0, ""))
            with open(folder / "trace.csv") as text:
                rows = list(csv.DictReader(text))
            with h5py.File(pathlib.Path(place, "trace.h5")) as file:
                self.assertEqual(file.attrs["schema"], "understudy.trace/1")
                self.assertEqual(len(file.attrs["inputs_sha256"]), 64)
                trace = file["trace"]
                self.assertEqual(sorted(trace), sorted(rows[0]))
                for name in rows[0]:
                    expected = [float(row[name] or "nan") for row in rows]
                    values = trace[name][:].tolist()
                    self.assertEqual(str(values), str(expected if trace[name].dtype.kind == "f" else list(map(int, expected))), name)
                self.assertEqual(trace["tip_error_um"].attrs["unit"], "um")
                self.assertEqual(trace["qw"].attrs["unit"], "1")
                self.assertEqual(trace["line"].dtype, "int32")

            with open(folder / "trace.csv", "a") as text:
                text.write(",".join(rows[-1].values()) + "\n")
            changed = run("export", "trace", folder, "-o", pathlib.Path(place, "again.h5"))
            self.assertEqual(changed.returncode, 2)
            self.assertIn("trace.csv: it is not the file that manifest.sha256 names", changed.stderr)
            self.assertFalse(pathlib.Path(place, "again.h5").exists())

    def test_what_is_no_rehearsal_is_refused(self):
        with tempfile.TemporaryDirectory() as place:
            refused = run("export", "trace", place, "-o", pathlib.Path(place, "trace.h5"))
            self.assertEqual(refused.returncode, 2)
            self.assertIn("summary.json", refused.stderr)
            self.assertFalse(pathlib.Path(place, "trace.h5").exists())


if __name__ == "__main__":
    unittest.main()
