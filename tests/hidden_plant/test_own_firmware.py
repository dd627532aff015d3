#!/usr/bin/env python3
"""A robot under radio commands, predicted with its own firmware as a library: a law the program has no numbers for.

The library is compiled here from the hidden robot's law, which has a kick against friction and a gain that falls with the error;
the program sees the file, the commands and the telemetry.
"""
import json
import os
import pathlib
import random
import re
import subprocess
import tempfile
import unittest

import dataset
import radio_case
import robot_drives
from axis_case import DT

HERE = pathlib.Path(__file__).resolve().parent
PROGRAM = os.environ.get("OMNIHIL_PROGRAM", "")
FOLDER = pathlib.Path(tempfile.mkdtemp(prefix="omnihil-own-firmware-"))
ROWS = 6000
HIDDEN = {"radius_1": 1.03, "radius_2": 0.98, "radius_3": 1.01, "radius_4": 0.98}
# Measured by its owner, or of no matter here: each number that is fitted costs two simulations a step.
KNOWN = ("resistance_ohm", "flux_Vs", "viscous_Nms", "mass_kg", "yaw_kgm2", "grip_slip", "roller_grip")


def draw():
    robot = radio_case.draw_robot(random.Random(4), [])
    robot.true.update(loop_kick_V=0.8, loop_bend=0.05, loop_accel_m_s2=4.0, encoder_cpr=4096.0, late_radio_s=0.016)
    robot.sensors.update(dribbler=False, sigma=True, loss=0.0)
    robot.known = set(KNOWN)
    robot.believed.update({name: robot.true[name] for name in KNOWN})
    return robot


def compile_firmware(robot, name, *flags):
    words = ", ".join(f"p.{key} = {robot.true[key]!r}" for key in robot.true
                      if key.startswith("loop_") or key in ("gear", "encoder_cpr"))
    library = FOLDER / name
    subprocess.run(["cc", "-std=c11", "-D_GNU_SOURCE", "-O2", "-ffp-contract=off", "-fPIC", "-shared", "-o", library,
                    f"-DOWN_PARAMS={words}", *flags, HERE / "firmware" / "own_firmware.c", "-lm"], check=True)
    return library


def write_bench(robot, folder, hidden):
    """What a team has: commands, wheel speeds of its telemetry, the camera; a model, and a library beside it."""
    folder.mkdir()
    sections = radio_case.model_sections(robot)
    plain = sections["controller"]
    sections["controller"] = {"latency_s": "{ value = 0.02, tolerance = 0.5 }"}
    sections["encoder"] = {"counts_per_turn": f"{robot.true['encoder_cpr']:.0f}"}
    dataset.write_model(folder / "model.toml", "robot", sections)
    dataset.write_model(folder / "plain.toml", "robot", {**sections, "controller": plain})
    runs = []
    for number, (use, kind) in enumerate((("fit", "random_drive"), ("holdout", "random_drive"), ("extrapolation", "directions"))):
        rng = random.Random(100 + number)
        sent, heard = radio_case.asked_of(rng, kind, robot, ROWS)
        columns = radio_case.record(robot, {**robot.true, **hidden}, sent, heard, number + 7)
        dataset.write_csv(folder / f"run_{number + 1}.csv", columns)
        runs.append({"file": f"run_{number + 1}.csv", "use": use, "excitation": robot_drives.PLAIN[kind]})
    dataset.write_dataset(folder, "own firmware", "robot", radio_case.channels_of(robot), runs)


def run(*words):
    return subprocess.run([PROGRAM, *map(str, words)], cwd=FOLDER, capture_output=True, text=True, check=False)


def wheel_error(folder, *words):
    """Worst error of the four wheels' speeds in the runs to fit, in per cent of their spread."""
    done = run("compare", folder, *words)
    assert done.returncode == 0, done.stdout + done.stderr
    shares = [float(m[1]) for m in re.finditer(r"^wheel_speed_\d +fit +\d+ +\S+ rad/s +([\d.]+)", done.stdout, re.M)]
    assert len(shares) == 4, done.stdout
    return max(shares)


@unittest.skipIf(not PROGRAM, "OMNIHIL_PROGRAM is not set")
class OwnFirmware(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = draw()
        cls.library = compile_firmware(cls.robot, "libfw.so")
        write_bench(cls.robot, FOLDER / "healthy", {})
        write_bench(cls.robot, FOLDER / "bench", HIDDEN)
        (FOLDER / "bench" / "libfw.so").write_bytes(cls.library.read_bytes())
        text = (FOLDER / "bench" / "dataset.toml").read_text(encoding="utf-8")
        text = text.replace('model = "model.toml"', 'model = "model.toml"\nfirmware = "libfw.so"')
        (FOLDER / "bench" / "dataset.toml").write_text(text, encoding="utf-8")

    def test_its_own_law_is_nearer_than_the_plain_one_with_its_gains(self):
        own = wheel_error("healthy", "--firmware", self.library)
        plain = wheel_error("healthy", "--model", "healthy/plain.toml")
        print(f"wheel speeds: own firmware {own} %, plain controller {plain} % of their spread")
        self.assertLess(own, 0.5 * plain)

    def test_a_prediction_repeats_to_the_last_digit(self):
        first = run("compare", "bench", "--json", "a.json")
        again = run("compare", "bench", "--json", "b.json")
        self.assertEqual(first.returncode, 0, first.stderr)
        self.assertIn("makes the duties", first.stdout + first.stderr)
        self.assertEqual(first.stdout, again.stdout)
        self.assertEqual((FOLDER / "a.json").read_text(), (FOLDER / "b.json").read_text())

    def test_what_is_hidden_in_the_robot_is_named_first(self):
        done = run("diagnose", "bench", "--json", "found.json")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        print(done.stdout)
        self.assertEqual(json.loads((FOLDER / "found.json").read_text())["effects"][:1], ["wheel_radius_mismatch"])

    def test_a_library_that_is_not_there_is_named(self):
        done = run("compare", "healthy", "--firmware", "nowhere.so")
        self.assertEqual(done.returncode, 2)
        self.assertIn('firmware = "nowhere.so": there is no such file', done.stderr)

    def test_a_library_with_state_of_its_own_is_refused(self):
        done = run("compare", "healthy", "--firmware", compile_firmware(self.robot, "libglobal.so", "-DOWN_GLOBAL"))
        self.assertEqual(done.returncode, 2)
        self.assertIn("keeps state outside of the state block", done.stderr)

    def test_a_file_that_is_no_library_is_refused(self):
        (FOLDER / "text.so").write_text("no library")
        done = run("compare", "healthy", "--firmware", "text.so")
        self.assertEqual(done.returncode, 2)
        self.assertIn("text.so", done.stderr)

    def test_duties_that_were_logged_need_no_firmware(self):
        folder = FOLDER / "duties"
        folder.mkdir()
        for name in ("model.toml", "dataset.toml"):
            (folder / name).write_text((FOLDER / "healthy" / name).read_text())
        text = (folder / "dataset.toml").read_text()
        for axis, name in enumerate(("vx", "vy", "w")):
            text = text.replace(f"command_{name} =", f"duty_{axis + 1} =")
        (folder / "dataset.toml").write_text(text.replace("[[runs]]", 'duty_4 = { column = "asked_w" }\n\n[[runs]]', 1))
        for number in (1, 2, 3):
            (folder / f"run_{number}.csv").write_text((FOLDER / "healthy" / f"run_{number}.csv").read_text())
        done = run("compare", "duties", "--firmware", self.library)
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn("has nothing to do", done.stderr)


if __name__ == "__main__":
    unittest.main()
