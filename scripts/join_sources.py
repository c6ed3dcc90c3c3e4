#!/usr/bin/env python3
"""Which sources are compiled as one: "GROUP>SOURCE" lines.   join_sources.py [--decompositions-alone] COUNT SOURCE...

Sources of a target instantiate the same templates, so some of them together take less time than each on its own. Two
sources in one group must not both declare a name outside of classes and functions: each may have its own kTolerance in
its anonymous namespace. Declarations are found by how the code is formatted: they begin in the first column.
--decompositions-alone: so stands a source that decomposes matrices, since GCC's time for Eigen's many types grows with the
square of their count.
"""
import functools
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

IGNORED = {"understudy", "std", "Eigen", "testing", "const", "operator", "decltype"}
ALONE = re.compile(r'#include (<Eigen/(Cholesky|LU|SVD|QR|Eigenvalues|Dense)>|<unsupported/|"core/decompositions.h")')
TEST = re.compile(r"^(TEST|TEST_F|TEST_P|RC_GTEST_PROP|INSTANTIATE_TEST_SUITE_P|BENCHMARK)\b")
HEAD = re.compile(r"^(?:[A-Za-z_]|\[\[)")


def bare(text):
    """Without strings and what stands between brackets, whose marks stay."""
    text = re.sub(r'"(?:[^"\\]|\\.)*"', '""', text)
    for pattern, mark in ((r"<[^<>()]*>", ""), (r"\[[^\[\]]*\]", ""), (r"\([^()]*\)", "()"), (r"\{[^{}]*\}", "{}")):
        while (shorter := re.sub(pattern, lambda m: mark if m[0] != mark else m[0], text)) != text:
            text = shorter
    return text


def names_of(line):
    if match := re.match(r"MATCHER(?:_P\d?)?\((\w+)", line):
        return {match[1]}
    if match := re.match(r"(?:template <.*> )?(?:struct|class|union|enum(?: class)?) (\w+)", line):
        body = line.partition("{")[2] if line.startswith("enum") and not line.startswith("enum class") else ""
        return {match[1], *re.findall(r"\b([A-Za-z_]\w*)", body)}
    text = bare(line)
    if line.startswith("const"):  # more than one declarator
        return set(re.findall(r"[ ,&*]([A-Za-z_]\w*)(?=[={(;,]| =| \{|$)", text)) - {"const"}
    if match := re.match(r"[^=({]*?(?<!:)\b([A-Za-z_]\w*)\((?!\)[,;])", text):
        return {match[1]}
    return set(re.findall(r"[\w>&*] ?\b([A-Za-z_]\w*)(?=[={(;,]| =| \{|$)", text)) - {"const"}


def stands_alone(path):
    with open(path, encoding="utf-8") as file:
        return bool(ALONE.search(file.read()))


def declared(path):
    """Names that the source keeps to itself, those that others see too, and its aliases, which may stand twice.

    What namespaces it opens is one of them: others would look names up in them too.
    """
    own, seen, aliases = set(), set(), {}
    with open(path, encoding="utf-8") as file:
        lines = file.read().splitlines()
    anonymous = open_enum = False
    for line in lines:
        if header := re.match(r'#include "(tests/[^"]+)"', line):
            aliases |= of_test_header(header[1])
        elif line.startswith("namespace"):
            anonymous = line == "namespace {"
        elif line == "}  // namespace":
            anonymous = False
        elif open_enum:
            own |= set(re.findall(r"\b([A-Za-z_]\w*)", line.partition("//")[0]))
            open_enum = "}" not in line
        elif macro := re.match(r"#define (\w+)", line):  # seen by whatever is compiled after it
            own.add(macro[1])
        elif alias := re.match(r"using (\w+) = (.*)", line):
            aliases[alias[1]] = alias[2]
        elif HEAD.match(line) and not TEST.match(line) and not line.startswith(("using namespace", "using ::", "using std")):
            (own if anonymous or line.startswith("static ") else seen).update(names_of(line))
            open_enum = line.startswith("enum") and not line.startswith("enum class") and "}" not in line
    if opened := sorted(line for line in lines if line.startswith("using namespace")):
        aliases["using namespace"] = " ".join(opened)
    return own - IGNORED, seen - IGNORED, aliases


@functools.cache
def of_test_header(name):
    """Name -> header, of what a header of the tests declares or takes from another one."""
    path = ROOT / name
    if not path.is_file():
        return {}
    own, seen, aliases = declared(path)
    return aliases | dict.fromkeys(own | seen, name)


class Group:
    def __init__(self, count):
        self.count = count
        self.sources, self.own, self.seen, self.aliases = [], set(), set(), {}

    def takes(self, own, seen, aliases):
        if len(self.sources) == self.count or own & (self.own | self.seen | self.aliases.keys()) or (seen | aliases.keys()) & self.own:
            return False
        return all(self.aliases.get(name, type) == type for name, type in aliases.items())

    def add(self, source, own, seen, aliases):
        self.sources.append(source)
        self.own |= own
        self.seen |= seen
        self.aliases |= aliases


def main():
    words = sys.argv[1:]
    apart = words[0] == "--decompositions-alone"
    if apart:
        words.pop(0)
    count, sources = int(words[0]), words[1:]
    groups = []
    for source in sources:
        names = declared(source)
        alone = apart and stands_alone(source)
        group = None if alone else next((g for g in groups if g.takes(*names)), None)
        if group is None:
            group = Group(1 if alone else count)
            groups.append(group)
        group.add(source, *names)
    for number, group in enumerate(groups):
        for source in group.sources:
            print(f"{number}>{source}")


main()
