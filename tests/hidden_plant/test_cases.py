#!/usr/bin/env python3
"""What the generator writes: valid by the format, says nothing it should not, the same whenever it is made."""
import csv
import hashlib
import json
import pathlib
import tempfile
import tomllib
import unittest

import axis_case
import cases
import faults
import outside
import robot_case
import torque_case
from axis_effects import EFFECTS
from excitation import POOL

SIGNALS = {
    "time",
    "duty",
    "motor_current",
    "bus_voltage",
    "encoder",
    "position",
    "velocity",
    "motor_torque",
    "position_target",
    "dribbler",
    "gyro_z",
    "accel_x",
    "accel_y",
    "vision_x",
    "vision_y",
    "vision_theta",
    *(f"{s}_{k}" for k in range(1, 5) for s in ("duty", "encoder", "motor_current")),
}
CHOSEN = [("control", 2), ("single", 7), ("pair", 3), ("outside", 1), ("beside", 2), ("fault", 1), ("robot", 10), ("torque", 6)]


def tree_hash(folder):
    digest = hashlib.sha256()
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            digest.update(path.name.encode() + path.read_bytes())
    return digest.hexdigest()


class CasesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.root = pathlib.Path(cls.scratch.name)
        table = cases.classes()
        cls.made = []
        for name, k in CHOSEN:
            case = cases.Case("dev", name, k, table[name].cases[k])
            cls.made.append((case, cls.root / case.name, cases.make(case, cls.root / case.name)))

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    def test_files_keep_to_the_format(self):
        for case, folder, _ in self.made:
            with self.subTest(case):
                data = tomllib.loads((folder / "dataset.toml").read_text())
                self.assertEqual(data["format"], "omnihil-dataset/1")
                self.assertLessEqual(set(data["channels"]), SIGNALS)
                model = tomllib.loads((folder / data["model"]).read_text())
                self.assertEqual((model["format"], model["rig"]), ("omnihil-model/1", data["rig"]))
                self.assertEqual([r["use"] for r in data["runs"]], ["fit", "holdout", "extrapolation"])
                for run in data["runs"]:
                    with open(folder / run["file"], encoding="utf-8") as file:
                        rows = list(csv.DictReader(file))
                    if case.cls == "torque":
                        self.assertIn(len(rows), [round(torque_case.RUN_S / h) for h in torque_case.PERIODS_S])
                    else:
                        own = {"beside": outside.ROWS_WITH_AN_EFFECT}
                        self.assertEqual(len(rows), own.get(case.cls, 20000))
                    for channel in data["channels"].values():
                        self.assertIn(channel["column"], rows[0])
                    times = [float(r["time_s"]) for r in rows]
                    self.assertTrue(all(b > a for a, b in zip(times, times[1:])))

    def test_a_case_tells_nothing_of_its_answer(self):
        # Ids of effects stand in a model file only where its owner declares them.
        declared = {"coulomb_friction", "winding_heating"}
        for _, folder, answer in self.made:
            text = "".join(p.read_text() for p in folder.glob("*.toml")) + folder.name
            for effect in answer["effects"]:
                if effect["id"] not in declared:
                    self.assertNotIn(effect["id"], text)
            self.assertFalse([p.name for p in folder.iterdir() if p.suffix not in (".toml", ".csv")])

    def test_the_same_case_comes_out_the_same(self):
        case, folder, answer = self.made[0]
        again = self.root / "again" / case.name
        self.assertEqual(
            json.dumps(cases.make(case, again), sort_keys=True), json.dumps(answer, sort_keys=True)
        )
        self.assertEqual(tree_hash(again), tree_hash(folder))

    def test_sets_share_no_record(self):
        for name in ("single", "control"):
            keys = {
                s: [axis_case.source(*c.key).random() for c in cases.list_cases(s, [name], 40)]
                for s in cases.SETS
            }
            self.assertFalse(
                set(keys["dev"]) & set(keys["release"]) or set(keys["dev"]) & set(keys["sealed"])
            )

    def test_controls_are_driven_by_every_excitation_that_reveals_an_effect(self):
        kinds = set()
        for k in range(400):
            rng = axis_case.source("dev", "control", k)
            kinds |= set(
                axis_case.draw_kinds(rng, rng.choice(EFFECTS).shows, axis_case.draw_rig(rng), False)[0].split(
                    "+"
                )
            )
        self.assertLessEqual({k for e in EFFECTS for k in e.shows if k in POOL}, kinds)

    def test_there_are_enough_cases(self):
        table = cases.classes()
        for effect in EFFECTS:
            self.assertGreaterEqual(sum(what == (effect.id,) for what in table["single"].cases), 8)
        self.assertGreaterEqual(len(EFFECTS), 25)
        self.assertGreaterEqual(len(table["control"].cases), 150)
        self.assertEqual({w[0] for w in table["outside"].cases}, set(outside.names()))
        self.assertEqual({w[0] for w in table["fault"].cases}, set(faults.KINDS))

    def test_the_cases_behind_a_number_are_the_rest_of_the_list(self):
        whole = cases.list_cases("dev", ["single", "pair"], 9)
        first = cases.list_cases("dev", ["single", "pair"], 4)
        self.assertEqual(first + cases.list_cases("dev", ["single", "pair"], 9, 4), whole)

    def test_every_folder_name_is_its_own(self):
        names = [c.name for s in cases.SETS for c in cases.list_cases(s)]
        self.assertEqual(len(names), len(set(names)))

    def test_base_parameters_are_off_by_what_the_tolerances_allow(self):
        for k in range(30):
            rig = axis_case.draw_rig(axis_case.source("off", k))
            for name in ("resistance_ohm", "load_kgm2"):
                off = abs(rig.true[name] / rig.believed[name] - 1)
                self.assertTrue(0.05 <= off <= 0.10)
            robot = robot_case.draw_robot(axis_case.source("off", k))
            for name, (_, least, most, _) in robot_case.BASE.items():
                if name not in robot.left_out | robot.known:
                    self.assertTrue(
                        least - 1e-3 <= abs(robot.true[name] / robot.believed[name] - 1) <= most + 1e-3
                    )


if __name__ == "__main__":
    unittest.main()
