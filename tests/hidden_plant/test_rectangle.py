"""`omnihil field rectangle` against the hidden robot: with the true numbers the paths agree, with guessed ones they part."""
import os
import pathlib
import re
import subprocess
import tempfile
import unittest

import rectangle_case

PROGRAM = os.environ.get("OMNIHIL_PROGRAM", "omnihil")


class Rectangle(unittest.TestCase):
    def paths(self, seed, told_the_truth):
        with tempfile.TemporaryDirectory() as work:
            folder, picture = pathlib.Path(work) / "data", pathlib.Path(work) / "p.svg"
            rectangle_case.make(folder, seed, told_the_truth)
            ran = subprocess.run(
                [PROGRAM, "field", "rectangle", str(folder), "--picture", str(picture)], capture_output=True, text=True
            )
            self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
            self.assertIn("<polyline", picture.read_text())
            most = float(re.search(r"([0-9.]+) m at most", ran.stdout)[1])
            way = float(re.search(r"([0-9.]+) m of way", ran.stdout)[1])
            return most / way, ran.stdout.count("\nleg ")

    def test_true_numbers_stay_within_a_hundredth_of_the_way_and_guesses_do_not(self):
        for seed in (1, 2, 3):
            with self.subTest(seed=seed):
                share, legs = self.paths(seed, True)
                self.assertEqual(legs, 4)
                self.assertLess(share, 0.01)  # open loop, four metres
                guessed, _ = self.paths(seed, False)
                self.assertGreater(guessed, 0.01)


if __name__ == "__main__":
    unittest.main()
