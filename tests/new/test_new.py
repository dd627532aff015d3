#!/usr/bin/env python3
"""./dev new: what it refuses it says, and leaves nothing behind; what it writes is all there.

    test_new.py NEW.PY      in scratch trees that hold the pages that parts are entered in
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
NEW = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(NEW.parent))
import new  # noqa: E402


def contents(root):
    return {p.relative_to(root): p.read_text(encoding="utf-8") for p in root.rglob("*") if p.is_file()}


class New(unittest.TestCase):
    def setUp(self):
        self.tree = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.tree)
        for kind in new.KINDS.values():
            for page, _what, _place in kind["into"]:
                (self.tree / page).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(SOURCE / page, self.tree / page)

    def run_new(self, *arguments):
        return subprocess.run([sys.executable, NEW, "--root", self.tree, *arguments], capture_output=True, text=True,
                              check=False)

    def refused(self, *arguments):
        before = contents(self.tree)
        ran = self.run_new(*arguments)
        self.assertEqual(ran.returncode, 2, ran.stdout)
        self.assertEqual(contents(self.tree), before)
        return ran.stderr

    def test_a_mistyped_kind_is_answered_with_the_nearest(self):
        self.assertIn('did you mean "effect"?', self.refused("efect", "grease_film"))
        self.assertIn("kinds: effect, format", self.refused("xyzzy", "grease_film"))

    def test_what_is_no_name_is_refused(self):
        for name in ("Grease", "2fast", "a-b", "a__b", "", "../etc", 41 * "a"):
            self.assertIn("is no name", self.refused("effect", name))

    def test_kind_and_name_are_both_needed(self):
        self.assertIn("./dev new KIND NAME", self.refused("effect"))

    def test_a_name_that_is_taken_is_refused(self):
        for kind in new.KINDS:
            self.assertEqual(self.run_new(kind, "fresh_part").returncode, 0, kind)
            self.assertIn("is there already", self.refused(kind, "fresh_part"))

    def test_a_test_that_is_there_is_not_written_over(self):
        taken = self.tree / "tests/sim/effects/grease_film_test.cc"
        taken.parent.mkdir(parents=True, exist_ok=True)
        taken.write_text("mine", encoding="utf-8")
        self.assertIn("grease_film_test.cc is there already", self.refused("effect", "grease_film"))

    def test_a_page_without_its_place_is_named_and_nothing_is_written(self):
        page = self.tree / "docs/motor-buses.md"
        page.write_text("# Motor buses\n", encoding="utf-8")
        self.assertIn("docs/motor-buses.md has no line", self.refused("bus", "my_drives"))

    def test_what_is_written_is_named_and_has_no_mark_left(self):
        for kind in new.KINDS:
            before = contents(self.tree)
            ran = self.run_new(kind, f"fresh_{kind}")
            self.assertEqual(ran.returncode, 0, ran.stderr)
            after = contents(self.tree)
            changed = {str(p) for p, text in after.items() if before.get(p) != text}
            self.assertEqual(changed, {line for line in ran.stdout.splitlines() if not line.startswith("then:")})
            for path in changed:
                text = after[pathlib.Path(path)]
                self.assertNotRegex(text, r"@(name|id|Name|NAME|Words)@")
                self.assertRegex(text, f"[Ff]resh[_ -]{kind}")

    def test_chips_stand_in_alphabetical_order(self):
        self.run_new("chip", "stm32f411")
        names = [line.split("**")[1] for line in (self.tree / "docs/mcu-peripherals.md").read_text().splitlines()
                 if line.startswith("**stm32")]
        self.assertEqual(names, sorted(names))
        self.assertIn("stm32f411", names)

    def test_an_effect_stands_in_the_list_of_ids(self):
        self.run_new("effect", "grease_film")
        self.assertIn('"grease_film",\n', (self.tree / "tests/sim/law/effect_ids_test.cc").read_text())


if __name__ == "__main__":
    unittest.main()
