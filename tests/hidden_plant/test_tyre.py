"""`omnihil field tyre` on records of the hidden robot: a tyre that is found, and one that is too stiff to be."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import tyre_case

PROGRAM = os.environ.get("OMNIHIL_PROGRAM", "omnihil")
LONG = "tyre.longitudinal."


class Tyre(unittest.TestCase):
    def identify(self, seed, tyre, **more):
        with tempfile.TemporaryDirectory() as work:
            folder = pathlib.Path(work) / "data"
            tyre_case.make(folder, seed, tyre, **more)
            out = pathlib.Path(work) / "out.json"
            ran = subprocess.run(
                [PROGRAM, "field", "tyre", str(folder), "--jobs", "2", "--json", str(out)],
                capture_output=True,
                text=True,
            )
            self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
            return json.loads(out.read_text())

    def test_numbers_within_a_tenth_where_the_peak_is_at_two_hundredths_or_more(self):
        for seed, (grip, grip_slip, slide_slip, slide_grip) in enumerate(
            ((0.8, 0.05, 0.3, 0.5), (0.6, 0.02, 0.2, 0.45), (0.5, 0.2, 0.5, 0.4), (0.9, 0.08, 0.25, 0.7)), 11
        ):
            tyre = dict(grip=grip, grip_slip=grip_slip, slide_slip=slide_slip, slide_grip=slide_grip, step_s=1e-5)
            with self.subTest(**tyre):
                found = self.identify(seed, tyre)
                self.assertEqual(found["outcome"], "curve", found["sentence"])
                numbers = found["numbers"]
                for key, true in (
                    ("extremum_slip", grip_slip),
                    ("extremum_value", grip),
                    ("asymptote_slip", slide_slip),
                    ("asymptote_value", slide_grip),
                ):
                    self.assertTrue(numbers[LONG + key]["determined"], key)
                    self.assertAlmostEqual(numbers[LONG + key]["value"] / true, 1.0, delta=0.1, msg=key)

    def test_table_1_as_printed_gives_its_force_and_a_bound_of_its_slip(self):
        tyre = dict(grip=2.0, grip_slip=0.0001, slide_slip=0.0002, slide_grip=0.01, step_s=5e-7)
        found = self.identify(4, tyre, levels=(2, 5, 9, 13, 16), seconds=9)
        self.assertEqual(found["outcome"], "grip alone", found["sentence"])
        self.assertAlmostEqual(found["sticking"]["grip"] / 2.0, 1.0, delta=0.1)
        self.assertLess(found["sticking"]["slip_bound_95"], 0.05)
        self.assertGreater(found["sticking"]["slip_bound_95"], 0.0001)


    def test_a_robot_that_never_slid_gives_a_lower_bound(self):
        tyre = dict(grip=0.9, grip_slip=0.08, slide_slip=0.25, slide_grip=0.7, step_s=2e-5)
        found = self.identify(21, tyre, levels=(0.5, 1.0, 1.5, 2.0), seconds=9)
        self.assertEqual(found["outcome"], "no peak", found["sentence"])
        self.assertIn("push harder", found["sentence"])


if __name__ == "__main__":
    unittest.main()
