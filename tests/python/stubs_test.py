"""The stub tells all that the module has, and nothing else; mypy.stubtest compares signatures where it is installed."""
import ast
import importlib.util
import re
import subprocess
import sys
import unittest
from pathlib import Path

import understudy
from understudy import _core

STUB = Path(understudy.__file__).with_name("_core.pyi")


def public(names):
    return {name for name in names if not name.startswith("_")}


def told(nodes):
    names = {node.name for node in nodes if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    return names | {node.target.id for node in nodes if isinstance(node, ast.AnnAssign)}


# pybind11's classes have its metaclass, and those that scripts cannot make take any arguments; names of types are the
# stub's own; what stands in Python's own library is that of its version.
NO_FAULT = re.compile(r"metaclass differs|does not have \*args argument|_core\.(Array|Bytes|Estimator|Progress) is not present"
                      r"|_campaign\.pandas is not present|\.(Sequence|Callable)\b")


class TheStub(unittest.TestCase):
    def setUp(self):
        self.tree = ast.parse(STUB.read_text())

    def test_names_of_the_module_are_all_told(self):
        self.assertEqual(public(told(self.tree.body)), public(vars(_core)))

    def test_names_of_each_class_are_all_told(self):
        inherited = public(dir(ValueError)) | public(dir(RuntimeError))
        for node in self.tree.body:
            if isinstance(node, ast.ClassDef) and not node.name.endswith("Error"):
                with self.subTest(node.name):
                    self.assertEqual(public(told(node.body)), public(vars(getattr(_core, node.name))) - inherited)

    def test_everything_has_a_docstring(self):
        for name in public(understudy.__all__):
            self.assertTrue(name == "SOLVE_STATUS" or getattr(understudy, name).__doc__, name)

    @unittest.skipUnless(importlib.util.find_spec("mypy"), "mypy is not installed")
    def test_signatures_are_those_of_the_module(self):
        run = subprocess.run([sys.executable, "-m", "mypy.stubtest", "understudy", "--ignore-missing-stub"],
                             capture_output=True, text=True, check=False)
        found = [line for line in (run.stdout + run.stderr).splitlines() if "error: " in line and not NO_FAULT.search(line)]
        self.assertEqual(found, [])
        self.assertNotIn("mypy build errors", run.stdout + run.stderr)


if __name__ == "__main__":
    unittest.main()
