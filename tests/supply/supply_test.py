#!/usr/bin/env python3
"""The bill of materials reads licences as they are written, and the two checks of this folder find what is wrong.

usage: supply_test.py SOURCE
"""
import sys
import unittest
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), sys.argv[1] + "/scripts"]
import bill_of_materials  # noqa: E402
import check_bill  # noqa: E402
import check_licences  # noqa: E402

MACHINE_READABLE = """Format: copyright-format/1.0/

Files: *
Copyright: 2020, Somebody
License: Expat

Files: debian/*
Copyright: 2021, A packager
License: GPL-3+

Files: src/old.c
 src/older.c
Copyright: 1999, Another
License: BSD-3-clause

License: BSD-3-clause
 Redistribution and use in source and binary forms ...
"""

PART = {"type": "library", "bom-ref": "pkg:deb/debian/liba@1", "name": "liba", "version": "1", "purl": "pkg:deb/debian/liba@1",
        "licenses": [{"license": {"id": "MIT"}}]}


def bill_of(*parts):
    named = [{**PART, "bom-ref": f"pkg:deb/debian/{name}@1", "name": name} for name in sorted(check_bill.HEADERS_ONLY)]
    parts = [*parts, *named]
    return {"bomFormat": "CycloneDX", "specVersion": "1.5", "components": parts,
            "dependencies": [{"ref": "understudy", "dependsOn": [part["bom-ref"] for part in parts]}]}


class Licences(unittest.TestCase):
    def test_are_those_of_the_files_and_not_of_the_packaging(self):
        self.assertEqual(bill_of_materials.licences_of(MACHINE_READABLE)[0], ["BSD-3-clause", "Expat"])

    def test_of_a_text_are_known_by_their_words(self):
        text = "Permission is hereby granted, free of\n charge, to any person obtaining a copy; see /usr/share/common-licenses/GPL-2."
        self.assertEqual(bill_of_materials.licences_of(text)[0], ["MIT", "in common-licenses: GPL-2"])

    def test_that_are_not_known_are_none(self):
        self.assertEqual(bill_of_materials.licences_of("All rights reserved.")[0], [])

    def test_have_the_names_of_spdx(self):
        self.assertEqual(bill_of_materials.licence_value("Expat"), {"license": {"id": "MIT"}})
        self.assertEqual(bill_of_materials.licence_value("Odd"), {"license": {"name": "Odd"}})


class CheckOfTheBill(unittest.TestCase):
    def faults(self, bill, libraries=("/lib/liba.so.1",)):
        return list(check_bill.faults_of(bill, libraries, lambda name: {f"/lib/{name}.so.1"}))

    def test_passes_a_good_one(self):
        self.assertEqual(self.faults(bill_of(PART)), [])

    def test_finds_a_library_without_a_component(self):
        self.assertEqual(self.faults(bill_of(PART), ["/lib/libb.so.1"]), ["/lib/libb.so.1 belongs to no component"])

    def test_finds_what_a_component_lacks(self):
        for key, value in (("licenses", []), ("licenses", [{"license": {}}]), ("version", ""), ("purl", "liba")):
            self.assertEqual(len(self.faults(bill_of({**PART, key: value}))), 1, key)

    def test_finds_headers_that_are_left_out_and_those_of_tests(self):
        bill = bill_of(PART, {**PART, "bom-ref": "x", "name": "libgtest-dev"})
        bill["components"] = [part for part in bill["components"] if part["name"] != "libeigen3-dev"]
        faults = self.faults(bill)
        self.assertTrue(any("libeigen3-dev is compiled in" in fault for fault in faults), faults)
        self.assertTrue(any("libgtest-dev is of tests" in fault for fault in faults), faults)


class CheckOfLicences(unittest.TestCase):
    PAGE = "| files | from | licence |\n|---|---|---|\n| `a/*` | us | Apache-2.0 |\n| `b.js` | them | MIT: `b.txt` |\n| `b.txt` | them | MIT: `b.txt` |\n"

    def faults(self, names):
        return list(check_licences.faults_of(check_licences.rows_of(self.PAGE), names, names.__contains__))

    def test_passes_files_that_have_a_row(self):
        self.assertEqual(self.faults(["a/deep/file", "b.js", "b.txt"]), [])

    def test_finds_a_file_without_a_row_and_a_row_without_a_file(self):
        self.assertEqual(self.faults(["b.js", "b.txt", "c"]),
                         ["docs/licences.md: no row for c", "docs/licences.md: `a/*` is neither shipped nor embedded"])

    def test_finds_a_licence_whose_notice_is_not_shipped(self):
        self.assertIn("docs/licences.md: `b.js` is under MIT: `b.txt`, and no notice is shipped", self.faults(["a/file", "b.js"]))

    def test_knows_installed_files_by_their_sources(self):
        self.assertEqual(check_licences.source_name("share/understudy/models/x"), "models/x")
        self.assertEqual(check_licences.source_name("share/doc/understudy/licences.md"), "docs/licences.md")
        self.assertEqual(check_licences.source_name("bin/understudy"), "bin/understudy")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
