#!/usr/bin/env python3
"""Holds the JSON Schemas under docs/schemas to the readers, and the shipped YAML files to the schemas.

usage: check_schemas.py fresh|valid|refused --understudy PROGRAM --source FOLDER

fresh    each schema is what `understudy schema` writes
valid    each shipped YAML file names its schema in its first line and fits it
refused  what a schema refuses the reader refuses too, for slips made on purpose in the shipped files
"""

import argparse
import collections
import copy
import functools
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import jsonschema
import yaml

KINDS = ("machine", "material", "scenario", "campaign", "golden", "as-built", "fixture", "part-pose", "rig", "columns")
HEADER = re.compile(r"^# yaml-language-server: \$schema=(\S+)$")
SLIPS_IN_A_FILE = 5
FILES_OF_A_KIND = 20


class Loader(yaml.SafeLoader):
    """YAML 1.2, as editors and the reader have it: yes, no, on and off are words."""


Loader.yaml_implicit_resolvers = {}
for tag, pattern, first in (("null", r"~|null|", "~n\0"), ("bool", r"true|false", "tf"),
                            ("int", r"[-+]?[0-9]+", "-+0123456789"),
                            ("float", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?", "-+.0123456789")):
    Loader.add_implicit_resolver("tag:yaml.org,2002:" + tag, re.compile(f"^({pattern})$"), list(first) + [""] * (tag == "null"))
Loader.add_constructor("tag:yaml.org,2002:float", lambda loader, node: float(node.value))
Loader.add_constructor("tag:yaml.org,2002:int", lambda loader, node: int(node.value))


def shipped(source):
    for folder in ("models", "scenarios", "examples"):
        yield from sorted((source / folder).rglob("*.yaml"))


def schema_of(path, source):
    if path.parent.name == "golden":  # written by `understudy scenario run --update-golden`
        return source / "docs" / "schemas" / "golden.json"
    header = HEADER.match(path.read_text().split("\n", 1)[0])
    if not header:
        sys.exit(f"{path}:1: the first line names no schema (# yaml-language-server: $schema=...)")
    schema = (path.parent / header.group(1)).resolve()
    if not schema.is_file():
        sys.exit(f"{path}:1: there is no {schema}")
    return schema


def check_fresh(understudy, source):
    for kind in KINDS:
        path = source / "docs" / "schemas" / f"{kind}.json"
        wanted = subprocess.run([understudy, "schema", kind], capture_output=True, text=True, check=True).stdout
        if not path.is_file() or path.read_text() != wanted:
            sys.exit(f"{path.relative_to(source)}: disagrees with the reader: run "
                     f"understudy schema {kind} -o {path.relative_to(source)}")


@functools.cache
def validator(schema):
    return jsonschema.Draft7Validator(json.loads(schema.read_text()))


def check_valid(_, source):
    seen = set()
    for path in shipped(source):
        schema = schema_of(path, source)
        seen.add(schema.stem)
        for error in validator(schema).iter_errors(yaml.load(path.read_text(), Loader)):
            where = ".".join(str(part) for part in error.absolute_path)
            sys.exit(f"{path.relative_to(source)}: {where}: {error.message[:300]}")
    if seen != set(KINDS):
        sys.exit(f"no shipped file is of the kind {', '.join(set(KINDS) - seen)}")


def leaves(value, path=()):
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        yield path + (key,)
        yield from leaves(inner, path + (key,))


def slips(value):
    """Copies with one mistake each: a key misspelt, a key left out, a value that is beyond every range."""
    paths = [path for path in leaves(value) if isinstance(path[-1], str)]
    step = max(1, 3 * len(paths) // SLIPS_IN_A_FILE)
    for offset, path in enumerate(paths[::step]):
        for way in ("misspelt", "left out", "1e99", "in words"):
            if (offset + len(way)) % 2:  # half of them
                continue
            slip = copy.deepcopy(value)
            inner = slip
            for part in path[:-1]:
                inner = inner[part]
            old = inner.pop(path[-1])
            if way == "1e99" and isinstance(old, str):
                continue  # a bare number is text to the reader, where text is asked for
            if way == "misspelt":
                inner[path[-1] + "x"] = old
            elif way != "left out":
                inner[path[-1]] = 1e99 if way == "1e99" else {"in": "words"}
            yield ".".join(str(part) for part in path) + " " + way, slip


def check_refused(understudy, source):
    tried = 0
    files = collections.Counter()
    with tempfile.TemporaryDirectory() as folder:
        for path in shipped(source):
            schema = schema_of(path, source)
            files[schema] += 1
            if files[schema] > FILES_OF_A_KIND:
                continue
            value = yaml.load(path.read_text(), Loader)
            for name, slip in slips(value):
                if validator(schema).is_valid(slip):
                    continue
                file = pathlib.Path(folder) / "slip.yaml"
                file.write_text(json.dumps(slip))  # JSON is YAML
                words = [understudy, "schema", schema.stem, "--check", file]
                if schema.stem == "as-built":
                    words += ["--machine", "five-axis" if "axes" in value else "hexapod"]
                done = subprocess.run(words, capture_output=True, text=True, check=False)
                tried += 1
                if done.returncode != 2:
                    sys.exit(f"{path.relative_to(source)} with {name}: the schema refuses it, the reader ends with "
                             f"{done.returncode}: {done.stderr.strip()}")
    print(f"{tried} slips refused by schema and reader")
    if tried < 50:
        sys.exit(f"only {tried} slips were refused by a schema: this test has lost its teeth")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("what", choices=("fresh", "valid", "refused"))
    parser.add_argument("--understudy", required=True)
    parser.add_argument("--source", required=True, type=pathlib.Path)
    arguments = parser.parse_args()
    checks = {"fresh": check_fresh, "valid": check_valid, "refused": check_refused}
    checks[arguments.what](arguments.understudy, arguments.source.resolve())


if __name__ == "__main__":
    main()
