"""Sources that are compiled as one, of small files: never two with the same name of their own."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "join_sources.py"


def anonymous(text):
    return f"namespace room {{\nnamespace {{\n{text}\n}}  // namespace\n}}  // namespace room\n"


class JoinSources(unittest.TestCase):
    def groups(self, *texts, count=16, options=()):
        """The group of each text, as if it were a source."""
        with tempfile.TemporaryDirectory() as folder:
            names = [f"{number}.cpp" for number in range(len(texts))]
            for name, text in zip(names, texts):
                (Path(folder) / name).write_text(text)
            done = subprocess.run([sys.executable, SCRIPT, *options, str(count), *names], cwd=folder, capture_output=True, text=True, check=True)
            group = {name: int(number) for number, name in (line.split(">") for line in done.stdout.splitlines())}
            return [group[name] for name in names]

    def apart(self, a, b, options=()):
        first, second = self.groups(a, b, options=options)
        return first != second

    def test_no_more_than_the_count(self):
        self.assertEqual(self.groups("int a();", "int b();", "int c();", count=2), [0, 0, 1])

    def test_names_of_an_anonymous_namespace(self):
        for text in ("constexpr double kLimit = 2.0;", "const Vec3 kA(1, 2, 3), kLimit(0, 0, 0);", "struct kLimit {", "enum Axis { kX, kLimit };",
                     "std::map<int, Vec3> kLimit(const Json& text) {", "MATCHER_P(kLimit, wanted, \"\") {", "using kLimit = int;"):
            self.assertTrue(self.apart(anonymous(text), anonymous("double kLimit(int a);")), text)

    def test_a_name_of_its_own_and_one_that_others_see(self):
        self.assertTrue(self.apart(anonymous("double length(Vec3 v) {"), "namespace room {\ndouble length(Pose p) {\n}\n}"))

    def test_what_many_sources_declare_alike(self):
        self.assertFalse(self.apart(anonymous("using Json = nlohmann::json;"), anonymous("using Json = nlohmann::json;")))
        self.assertFalse(self.apart("double length(Vec3 v) {\n}", "double length(Pose p) {\n}"))
        self.assertFalse(self.apart(anonymous("TEST(Limit, Holds) {"), anonymous("TEST(Limit, Breaks) {")))
        self.assertTrue(self.apart(anonymous("using Json = nlohmann::json;"), anonymous("using Json = nlohmann::ordered_json;")))

    def test_opened_namespaces(self):
        self.assertTrue(self.apart("using namespace room;\n", "using namespace house;\n"))
        self.assertFalse(self.apart("using namespace room;\n", "using namespace room;\n"))

    def test_a_macro(self):
        self.assertTrue(self.apart("#define SIZE 2\n", anonymous("constexpr int SIZE = 3;")))

    def test_decompositions_stand_alone_where_asked(self):
        options = ["--decompositions-alone"]
        for header in ("<Eigen/SVD>", "<Eigen/Cholesky>", '"core/decompositions.h"'):
            self.assertTrue(self.apart(f"#include {header}\n", "int a();\n", options), header)
            self.assertFalse(self.apart(f"#include {header}\n", "int a();\n"), header)
        self.assertTrue(self.apart("int a();\n", "#include <Eigen/Eigenvalues>\n", options))
        self.assertFalse(self.apart("int a();\n", "#include <Eigen/Core>\n", options))


if __name__ == "__main__":
    unittest.main()
