"""One command on one changed input, and what input_study.py asks of the answer."""
import json
import math
import os
import shutil
import signal
import subprocess
import tempfile
import threading
import time
from pathlib import Path

from kill_study import MANIFEST, bytes_in, fault_of_folder

PATIENCE_S = 120  # of one command; none of the good ones takes 5 s
MEMORY_KB = 3 << 20  # what one command may hold
LONGEST_LINE = 2100  # docs/limits.md: 2000 characters of text, and the name of the program before it
OUTCOMES = {0: "good", 1: "no", 2: "refused", 3: "failed"}
KINDS = (*OUTCOMES.values(), "crash", "hang")
POSES = b"x_mm,y_mm,z_mm,qw,qx,qy,qz\n0,0,50,1,0,0,0\n"  # for commands that read the standard input

templates = {}  # of each case: the folder with its good inputs
lock = threading.Lock()


def template_of(understudy, case):
    with lock:
        if id(case) not in templates:
            made = tempfile.TemporaryDirectory(prefix="understudy-inputs-")
            case.make(understudy, Path(made.name))
            templates[id(case)] = made
        return Path(templates[id(case)].name)


def good_input(understudy, case):
    return (template_of(understudy, case) / case.input).read_bytes()


def not_numbers(value, where=""):
    """Where a document has a number that is none."""
    if isinstance(value, dict):
        for key, part in value.items():
            yield from not_numbers(part, f"{where}.{key}")
    elif isinstance(value, list):
        for i, part in enumerate(value):
            yield from not_numbers(part, f"{where}[{i}]")
    elif isinstance(value, float) and not math.isfinite(value):
        yield where


class Trial:
    def __init__(self, understudy, case, data):
        self.understudy, self.case, self.data = understudy, case, data
        self.faults, self.outcome, self.answer, self.errors, self.seconds = [], "", "", "", 0.0

    def run(self):
        with tempfile.TemporaryDirectory(prefix="understudy-input-") as folder:
            self.root = Path(folder) / "t"
            shutil.copytree(template_of(self.understudy, self.case), self.root, symlinks=True)
            (self.root / self.case.input).write_bytes(self.data)
            status = self.command(self.case.words, names_input=True)
            self.outcome = OUTCOMES.get(status, "hang" if status is None else "crash")
            if self.case.then and status in (0, 1):
                self.command(self.case.then, names_input=False)

    def fault(self, text):
        self.faults.append(text)

    def command(self, words, names_input):
        """The exit status; None: it did not end in time."""
        before = bytes_in(self.root)
        with tempfile.TemporaryFile() as answers, tempfile.TemporaryFile() as errors, tempfile.TemporaryFile() as poses:
            poses.write(POSES)
            poses.seek(0)
            process = subprocess.Popen([self.understudy, *words.split()], cwd=self.root, stdin=poses, stdout=answers, stderr=errors)
            status, used = self.end_of(process)
            answers.seek(0)
            errors.seek(0)
            self.answer, self.errors = (file.read().decode(errors="replace") for file in (answers, errors))
        if used and used.ru_maxrss > MEMORY_KB:
            self.fault(f"{words}: holds {used.ru_maxrss} kB")
        if status is None:
            self.fault(f"{words}: does not end within {PATIENCE_S} s")
        elif status not in OUTCOMES:
            self.fault(f"{words}: ends with status {status}: {self.errors.strip()}")
        elif status >= 2:
            self.look_at_refusal(words, status, before, names_input)
        else:
            self.look_at_results(words, status, before)
        return status

    def end_of(self, process):
        began = time.monotonic()
        while time.monotonic() - began < PATIENCE_S:
            pid, status, used = os.wait4(process.pid, os.WNOHANG)
            if pid:
                self.seconds = max(self.seconds, time.monotonic() - began)
                process.returncode = os.waitstatus_to_exitcode(status)
                return process.returncode, used
            time.sleep(2e-3)
        process.send_signal(signal.SIGKILL)
        process.wait()
        return None, None

    def names(self):
        """Of the input, of its folder, of what it is read with, and of what comes of it."""
        input = Path(self.case.input)
        return {input.name, input.parts[0], *(name for name in self.case.files if "/" not in name), *self.case.results}

    def refusal(self):
        """The lines that refuse."""
        # Without those that tell how far the work is.
        lines = [line for line in self.errors.splitlines() if "% " not in line[:6]]
        if lines or not self.case.reports:
            return lines
        return ["understudy: " + line.strip()[len("error: "):] for line in self.answer.splitlines() if line.startswith("     error: ")]

    def look_at_refusal(self, words, status, before, names_input):
        lines = self.refusal()
        if len(lines) != 1 or not lines[0].startswith("understudy: ") or len(lines[0]) > LONGEST_LINE or not lines[0].isprintable():
            self.fault(f"{words}: status {status} without one line of text: {self.errors.strip()!r}")
        elif status == 3 and not self.case.describes_truth:
            self.fault(f"{words}: {lines[0]}")
        elif names_input and not any(name in lines[0] for name in self.names()):
            self.fault(f"{words}: the refusal names none of {sorted(self.names())}: {lines[0]}")
        after = bytes_in(self.root)
        changed = sorted(name for name in before.keys() | after.keys() if before.get(name) != after.get(name)
                         and not (self.case.reports and name.startswith(self.case.results))
                         and not name.endswith(".lock"))  # it says who was there last
        if changed:
            self.fault(f"{words}: refused, and yet changed: {changed}")

    def look_at_results(self, words, status, before):
        after = bytes_in(self.root)
        for name in sorted(after.keys() - before.keys()):
            if not any(name == result or name.startswith(result + "/") for result in self.case.results):
                self.fault(f"{words}: leaves {name}")
        for name in before:
            if name not in after:
                self.fault(f"{words}: removes {name}")
        for name, content in after.items():
            if name.endswith(MANIFEST) and before.get(name) != content:
                folder = name[:-len(MANIFEST)]
                fault = fault_of_folder({inside[len(folder):]: data for inside, data in after.items() if inside.startswith(folder)})
                if fault:
                    self.fault(f"{words}: {folder}: {fault}")
            if name.endswith("summary.json") and before.get(name) != content:
                self.look_at_summary(words, status, content)

    def look_at_summary(self, words, status, content):
        summary = json.loads(content)
        strange = list(not_numbers(summary))
        if strange:
            self.fault(f"{words}: no numbers in the summary: {strange[:5]}")
        if "verdict" not in summary:
            return
        errors = [finding for finding in summary["findings"] if finding["severity"] == "error"]
        go = summary["verdict"] == "go"
        if go == bool(errors) or (go != (status == 0) and not self.case.reports):
            self.fault(f"{words}: status {status}, verdict {summary['verdict']}, {len(errors)} errors")
        if any(not finding["message"].strip() for finding in summary["findings"]):
            self.fault(f"{words}: a finding without words")
