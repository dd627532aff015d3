#!/usr/bin/env python3
"""What header_examples.py takes for an example, and that one which is no longer true is named with header and line.

    test_header_examples.py FLAGS_FILE
"""
import shlex
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import header_examples
from header_comment import paragraphs

HEADER = """// What it is.
//
//   double y = twice(x);      // a comment; with a semicolon
//   if (y > 0) …
//
// Prose; with a semicolon at its end;
//
//   name    what it is
//   x       a number
#pragma once
namespace omnihil {
inline double twice(double x) { return 2 * x; }
}
"""
FLAGS = sys.argv.pop(1) if len(sys.argv) > 1 else None


def kinds(text):
    return [p.kind for p in paragraphs(text)]


def compiled(text, given="double x"):
    """What the compiler says of the header's example; empty when it takes it."""
    with tempfile.TemporaryDirectory() as folder:
        header = Path(folder) / "thing.h"
        header.write_text(text, encoding="utf-8")
        example = header_examples.example_of(str(header), text, {"text": given, "line": 1, "file": "given.toml"}, 0)
        unit = Path(folder) / "unit.cc"
        unit.write_text(f'#include "{header}"\n{example}', encoding="utf-8")
        result = subprocess.run([*shlex.split(Path(FLAGS).read_text()), "-c", str(unit), "-o", str(unit) + ".o"],
                                capture_output=True, text=True)
        return result.stderr.replace(str(header), "thing.h") if result.returncode else ""


class Paragraphs(unittest.TestCase):
    def test_code_is_told_from_prose_and_tables_by_its_form(self):
        self.assertEqual(kinds(HEADER), ["prose", "code", "prose", "table"])

    def test_toml_and_shell_lines_are_no_cpp(self):
        self.assertEqual(kinds("// a\n//\n//   [effects.fan]\n//   a = { value = 1 }\n"), ["prose", "table"])
        self.assertEqual(kinds("// a\n//\n//   $ for f in *; do cat $f;\n"), ["prose", "table"])

    def test_block_comments_are_read_alike(self):
        self.assertEqual(kinds("/* a\n *\n *   f(x);\n *\n * b\n */\nint g;\n"), ["prose", "code", "prose"])

    def test_a_call_without_an_end_of_statement_is_not_passed_over(self):
        text = HEADER.replace("name    what it is", "y = omnihil::twice(x)")
        self.assertEqual([f.split(" ")[0] for f in header_examples.looks_unfinished("a.h", text)], ["a.h:8:"])
        self.assertEqual(list(header_examples.looks_unfinished("a.h", HEADER)), [])


@unittest.skipUnless(FLAGS, "no flags of a compiler given")
class Compiled(unittest.TestCase):
    def test_an_example_that_is_true_compiles(self):
        self.assertEqual(compiled(HEADER), "")

    def test_a_renamed_function_is_named_with_header_and_line(self):
        self.assertIn("thing.h:3:", compiled(HEADER.replace("twice(double", "double_of(double")))

    def test_another_number_of_arguments_is_named_with_header_and_line(self):
        self.assertIn("thing.h:3:", compiled(HEADER.replace("twice(double x)", "twice(double x, int n)")))


if __name__ == "__main__":
    unittest.main()
