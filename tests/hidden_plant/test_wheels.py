#!/usr/bin/env python3
"""Robots of two, three and six wheels of which one is not like the others: `diagnose` names it first and gives its size.

The robots are the hidden plant's, which shares no line with the program.
"""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import dataset
import robot_case
import robot_drives
from axis_case import DT, ROWS, source

PROGRAM = os.environ.get("OMNIHIL_PROGRAM", "")
ANGLES = {2: (90, 270), 3: (150, 270, 30), 4: robot_drives.ANGLES, 6: (30, 90, 150, 210, 270, 330)}
WITHIN_SIGMAS = 1.96  # 95 %


def make(folder, wheels, hidden):
    """A robot of so many wheels with `hidden` plant parameters, as its owner would have it."""
    rng = source("wheels", wheels)
    robot = robot_case.draw_robot(rng, ("known dry friction",))
    robot.sensors.update(bus=True, accel=False, dribbler=False, sigma=True)
    robot.true.update({f"angle_{k + 1}": a for k, a in enumerate(ANGLES[wheels])}, wheels=wheels)
    if wheels == 2:  # tyres in place of rollers
        robot.true["roller_grip"] *= 25
        robot.believed["roller_grip"] *= 25
    folder.mkdir(parents=True, exist_ok=True)
    sections = robot_case.model_sections(robot)
    sections["robot"]["wheel_angle_deg"] = str(list(ANGLES[wheels]))
    dataset.write_model(folder / "model.toml", "robot", sections)
    runs = []
    for number, (use, kind) in enumerate((("fit", "directions"), ("holdout", "directions"), ("extrapolation", "random_drive"))):
        run = source("wheels", wheels, use)
        twists = robot_drives.POOL[kind](run, ROWS // 2, DT)
        asked = [row + [0.0] for row in robot_drives.duties(twists, robot.believed, ANGLES[wheels])]
        columns = robot_case.record(robot, {**robot.true, **hidden}, asked, run.randrange(1 << 30))
        dataset.write_csv(folder / f"run_{number + 1}.csv", columns)
        runs.append({"file": f"run_{number + 1}.csv", "use": use, "excitation": robot_drives.PLAIN[kind]})
    dataset.write_dataset(folder, f"{wheels} wheels", "robot", robot_case.channels_of(robot, wheels), runs)


@unittest.skipIf(not PROGRAM, "OMNIHIL_PROGRAM is not set")
class Wheels(unittest.TestCase):
    def found(self, wheels, hidden):
        with tempfile.TemporaryDirectory() as work:
            folder = pathlib.Path(work) / "bench"
            make(folder, wheels, hidden)
            done = subprocess.run(
                [PROGRAM, "diagnose", folder, "--json", folder / "found.json"], capture_output=True, text=True, check=False
            )
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            print(done.stdout)
            return json.loads((folder / "found.json").read_text())

    def check(self, found, effect, wheels, which, ratio):
        self.assertEqual(found["effects"][:1], [effect])
        numbers = {k: found["final"]["parameters"].get(f"{effect}.ratio_{k}") for k in range(1, 7)}
        self.assertEqual([k for k, n in numbers.items() if n], list(range(1, wheels + 1)))
        it = numbers[which]
        self.assertLessEqual(abs(it["value"] - ratio), WITHIN_SIGMAS * it["sigma"], numbers)
        # What all wheels have in common trades with the base model's number; one against the others does not.
        others = [numbers[k]["value"] for k in range(1, wheels + 1) if k != which]
        self.assertAlmostEqual(it["value"] / (sum(others) / len(others)), ratio, delta=0.2 * (1 - ratio))

    def test_the_weak_motor_is_named_first_and_its_size_is_within_its_interval(self):
        for wheels, weak in ((2, 2), (3, 1), (6, 5)):
            with self.subTest(wheels=wheels):
                self.check(self.found(wheels, {f"flux_{weak}": 0.93}), "motor_mismatch", wheels, weak, 0.93)

    def test_the_smaller_wheel_is_named_first_and_its_size_is_within_its_interval(self):
        for wheels, small in ((2, 1), (3, 3), (6, 6)):
            with self.subTest(wheels=wheels):
                self.check(self.found(wheels, {f"radius_{small}": 0.985}), "wheel_radius_mismatch", wheels, small, 0.985)


if __name__ == "__main__":
    unittest.main()
