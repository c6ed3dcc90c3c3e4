"""The wheel, installed into an environment of its own, is imported outside of the tree: wheel_test.py WHEEL."""
import os
import subprocess
import sys
import tempfile
from pathlib import Path

SCRIPT = """
import sys
from pathlib import Path
import understudy
here = Path(understudy.__file__)
assert sys.prefix in str(here), here
assert Path(understudy.models_folder()) == here.with_name("models"), understudy.models_folder()
machine = understudy.Machine("hexapod")
axes, status = machine.axes(machine.home[None, :].copy())
assert status[0] == 0
record = understudy.rehearse(understudy.plan("surface", "bottle", tilt=(-3, 3)), fixture="bottle",
                             engine="quasistatic", pictures=False)
print(record, axes.shape)
"""


def main(wheel):
    environment = {name: value for name, value in os.environ.items()
                   if not name.startswith(("UNDERSTUDY_", "PYTHON"))}
    with tempfile.TemporaryDirectory() as folder:
        venv = Path(folder) / "venv"
        run = lambda *words: subprocess.run(words, check=True, cwd=folder, env=environment)  # noqa: E731
        run(sys.executable, "-m", "venv", "--system-site-packages", str(venv))
        run(str(venv / "bin/python"), "-m", "pip", "install", "--quiet", "--no-deps", "--no-index", wheel)
        run(str(venv / "bin/python"), "-c", SCRIPT)
        told = subprocess.run((str(venv / "bin/understudy"), "doctor"), capture_output=True, text=True, cwd=folder,
                              env=environment).stdout
        [module] = [line.split()[-1] for line in told.splitlines() if "understudy-formats.so" in line]
        assert str(venv.resolve()) in str(Path(module).resolve()), told


if __name__ == "__main__":
    main(sys.argv[1])
