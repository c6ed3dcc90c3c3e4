"""The check of machine names, seen to fail: small trees with a name where it may not stand."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

CHECK = Path(__file__).resolve().parents[2] / "scripts" / "check_machine_names.py"
MODELS = {"models/tripod/machine.yaml": "", "kinematics/chain/tripod.cpp": 'kind.name = "three-legs";\n'}


class CheckMachineNames(unittest.TestCase):
    def check(self, files):
        """Status and output over a tree of {name: text}."""
        with tempfile.TemporaryDirectory() as folder:
            for name, text in {**MODELS, **files}.items():
                (Path(folder) / name).parent.mkdir(parents=True, exist_ok=True)
                (Path(folder) / name).write_text(text)
            done = subprocess.run([sys.executable, CHECK, folder], capture_output=True, text=True)
            self.assertEqual(done.stderr, "")
            return done.returncode, done.stdout

    def test_a_model_in_a_room(self):
        status, output = self.check({"sim/a.cpp": '#include "x.h"\nif (m.name == "tripod") return;\n'})
        self.assertEqual(status, 1)
        self.assertTrue(output.startswith('sim/a.cpp:2: names the machine "tripod"'), output)

    def test_a_mechanism_in_a_room(self):
        status, output = self.check({"sim/a.h": "const char* quote = \"'\";\nchar c = '\"'; auto k = \"three-legs\";\n"})
        self.assertEqual(status, 1)
        self.assertTrue(output.startswith('sim/a.h:2: names the machine "three-legs"'), output)

    def test_comments_sentences_and_the_places_of_machines_are_free(self):
        files = {
            "sim/a.cpp": '// "tripod"\n/* "tripod" */ auto text = "a tripod of \\"tripod\\" kind";\n',
            "tests/a.cpp": 'load("tripod");\n',
            "kinematics/b.cpp": 'name = "tripod";\n',
        }
        self.assertEqual(self.check(files), (0, ""))

    def test_an_exception_that_nothing_needs(self):
        status, output = self.check({"machine/default_machine.h": 'auto name = "tripod2";\n'})
        self.assertEqual((status, output.count("no longer names")), (1, 1), output)


if __name__ == "__main__":
    unittest.main()
