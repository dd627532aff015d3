#!/usr/bin/env python3
"""Which comments of a header become documentation, and that every line stays where it was."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools/docs"))
from doxygen_filter import for_doxygen, page_for_doxygen  # noqa: E402

HEADER = """// What it is.
//
//   double y = twice(x);
//
// Law: y = `k` x
//   k <= 2      at most
#pragma once

// About nothing in particular.

namespace thing {

// Doubles \\a.
double twice(double x);
struct Row {
  double speed_rad_s = 0.0;  // of the <rotor>
                             // at the end
  enum Kind { kA,  // first
              kB };
  virtual void at(int /*field*/, char c = '"') {}
  int after = 0;  // counted
  double get() const {
    // within a function
    return 1.0;  // likewise
  }
};  // Row
}  // namespace thing
"""


def line_with(part, text=HEADER):
    before = text.split("\n")
    after = for_doxygen(text, "thing.h").split("\n")
    assert len(before) == len(after)
    return next(b for a, b in zip(before, after) if part in a).strip()


class Filter(unittest.TestCase):
    def test_the_head_documents_the_file_with_its_example_as_code(self):
        marked = for_doxygen(HEADER, "a/thing.h").split("\n")
        self.assertEqual(marked[0], "/// @file a/thing.h What it is.")
        self.assertEqual(marked[1:3], ["/// @code{.cpp}", "///   double y = twice(x); @endcode"])

    def test_indented_lines_keep_their_form(self):
        self.assertEqual(line_with("at most"), "/// <pre>   k &lt;= 2      at most</pre>")

    def test_a_comment_above_a_declaration_documents_it_and_its_words_are_no_commands(self):
        self.assertEqual(line_with("Doubles"), "/// Doubles \\\\a.")

    def test_a_comment_behind_a_member_documents_it_and_may_go_on(self):
        self.assertTrue(line_with("speed_rad_s").endswith("///< of the \\<rotor\\>"))
        self.assertEqual(line_with("at the end"), "///< at the end")
        self.assertTrue(line_with("after").endswith("///< counted"))
        self.assertTrue(line_with("kA").endswith("///< first"))

    def test_other_comments_are_left_alone(self):
        for part in ("in particular", "within a function", "likewise", "// Row", "// namespace"):
            self.assertNotIn("///", line_with(part), part)

    def test_comments_of_c_headers_are_read_alike(self):
        text = "/* What it is.\n */\ntypedef struct a {\n  float b_V; /* of the bus */\n} a;\n/* Sets it. */\nvoid set(a* to);\n"
        self.assertEqual(line_with("What it is", text), "/// @file thing.h What it is.")
        self.assertEqual(line_with("b_V", text), "float b_V; /**< of the bus */")
        self.assertEqual(line_with("Sets it", text), "/** Sets it. */")

    def test_links_of_a_page_to_what_is_not_there_become_words(self):
        page = "[a](docs/a.md) [b](docs/b.md#c) ![p](img/p.svg) [w](https://w.org)"
        self.assertEqual(page_for_doxygen(page, ["docs/a.md"]), "[a](docs/a.md) b ![p](img/p.svg) [w](https://w.org)")


if __name__ == "__main__":
    unittest.main()
