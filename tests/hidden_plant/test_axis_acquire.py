#!/usr/bin/env python3
"""One axis driven for a measurement, from the command line to the verdict: over a motor bus and over a board with the shim.

The devices are of an independent program on a real wire, the effect is hidden in the plant, the program knows neither. In real time.
"""
import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

HERE = pathlib.Path(__file__).resolve().parent
PROGRAM = os.environ.get("OMNIHIL_PROGRAM", "")
DEADLINE_S = 120.0
# A computer that is late has effects of its own in the record: then only the first name is held. Where it was later than two
# periods it is driven again: such a record says of itself that it is no measurement.
LATE_MS = 2.0
HZ = 100
TRIES = 4
SEED = 2


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


@unittest.skipIf(not PROGRAM, "OMNIHIL_PROGRAM is not set")
class AxisAcquire(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="omnihil-axis-acquire-"))
        self.bench = None

    def tearDown(self):
        self.stop_bench()

    def start_bench(self, *words, hide=None):
        self.bench = subprocess.Popen([sys.executable, str(HERE / "axis_bench.py"), "--seed", str(SEED), "--model", "motor.toml",
                                       "--hide", json.dumps(hide or {}), *map(str, words)],
                                      cwd=self.folder, stdout=subprocess.PIPE, text=True)
        self.assertEqual(self.bench.stdout.readline(), "ready\n")

    def stop_bench(self):
        """What the axis did last, of a bench that ran to its end."""
        if self.bench is None:
            return None
        self.bench.send_signal(signal.SIGTERM)
        out = self.bench.communicate(timeout=DEADLINE_S)[0]
        self.bench = None
        return json.loads(out.splitlines()[-1])

    def run_program(self, *words, code=0):
        done = subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, code, f"{words}\n{done.stdout}{done.stderr}")
        return done.stdout + done.stderr

    def plan(self, drive, level, duration=8, limits=""):
        self.run_program("experiment", "--usual", "--drive", drive, "--level", level, "--duration", duration, "--packets", HZ,
                         "--seed", 3, "--write", "plan.toml")
        if limits:
            plan = self.folder / "plan.toml"
            plan.write_text(plan.read_text().replace("silence_s = 0.5", f"silence_s = 0.5\n{limits}"))

    def latest_ms(self, folder):
        readme = (self.folder / folder / "README.md").read_text(encoding="utf-8")
        latest = [float(ms) for ms in re.findall(r"\| ([\d.]+) ms \|$", readme, re.M)]
        self.assertEqual(len(latest), 3, readme)
        print(f"{folder}: latest demands: {latest} ms", file=sys.stderr)
        return max(latest)

    def drive_and_judge(self, effect, *words):
        """Drives the plan and asks for the verdict of a record that this computer was in time for."""
        for n in range(TRIES):
            bench = f"bench{n}"
            self.run_program(*words, "--out", bench)
            latest = self.latest_ms(bench)
            if latest <= 2000.0 / HZ:
                break
        else:
            self.skipTest(f"this computer was late by {latest} ms, {TRIES} times: nothing can be measured in real time")
        said = self.run_program("diagnose", bench, "--json", "found.json")
        print(said, file=sys.stderr)
        found = json.loads((self.folder / "found.json").read_text(encoding="utf-8"))
        self.assertEqual(found["effects"][:1], [effect], said)
        if latest <= LATE_MS:
            self.assertEqual(found["effects"][1:], [], said)
        self.assertTrue((self.folder / bench / "packets" / "fit.txt").exists())

    def test_a_moteus_by_voltage_over_a_usb_can_stick(self):
        self.start_bench("--speaks", "moteus", "--device", "./can", hide={"drag_Nm": 0.02, "drag_power": 2.0})
        self.plan("motor_voltage", 10)
        words = ("acquire", "plan.toml", "--bus", "moteus", "--device", "slcan:./can", "--model", "motor.toml")
        self.assertIn("by the model", self.run_program(*words, "--dry-run"))
        # run by run: a program that ends and one that goes on
        self.run_program(*words, "--out", "bench", "--runs", 1)
        self.run_program(*words, "--out", "bench", code=2)
        self.run_program(*words, "--out", "bench", "--resume")
        self.drive_and_judge("quadratic_drag", *words)
        self.assertEqual(self.stop_bench()["how"], 0)  # let go

    def test_an_odrive_by_torque_over_a_usb_can_stick(self):
        self.start_bench("--speaks", "odrive", "--device", "./can", hide={"drag_Nm": 0.03, "drag_power": 2.0})
        self.plan("motor_torque", 0.025)
        self.drive_and_judge("quadratic_drag", "acquire", "plan.toml", "--bus", "odrive", "--device", "slcan:./can", "--model",
                             "motor.toml")
        self.assertEqual(self.stop_bench()["how"], 0)

    def test_a_board_with_the_shim_by_duty_over_udp(self):
        port = free_port()
        self.start_bench("--speaks", "shim", "--udp", port,
                         hide={"cog_Nm": 0.006, "cog_order": 48, "cog_phase": 1.0, "cog2_order": 96, "cog2_Nm": 0.0006})
        self.plan("duty", 0.4)
        self.drive_and_judge("cogging", "acquire", "plan.toml", "--bus", "shim", "--device", f"udp:127.0.0.1:{port}?listen=1",
                             "--model", "motor.toml")
        self.assertEqual(self.stop_bench()["how"], 0)

    def test_an_axis_that_falls_silent_is_stopped(self):
        self.start_bench("--speaks", "shim", "--device", "./board", "--mute-after", 700)
        self.plan("duty", 0.3, limits="travel_rad = 10000")
        said = self.run_program("acquire", "plan.toml", "--bus", "shim", "--device", "./board", "--model", "motor.toml", "--out",
                                "bench", code=1)
        self.assertIn("has not answered for", said)
        time.sleep(0.2)
        self.assertEqual(self.stop_bench()["how"], 0)  # by the stop, or by its own time-out

    def test_a_fault_and_each_limit_stop_the_axis(self):
        for speaks, limit, reason in ((("moteus", "--fault-after", 300), "", "reports fault 33"),
                                      (("moteus",), "speed_rad_s = 40", "allowed are 40 rad/s"),
                                      (("moteus",), "travel_rad = 3", "allowed are 3 rad"),
                                      (("moteus",), "current_A = 0.2", "allowed are 0.2 A"),
                                      (("moteus",), "battery_V = 90", "allowed are 90 V")):
            with self.subTest(reason):
                self.start_bench("--speaks", *speaks, "--device", "./can")
                (self.folder / "plan.toml").unlink(missing_ok=True)
                self.plan("motor_voltage", 6, 4, limit)
                said = self.run_program("acquire", "plan.toml", "--bus", "moteus", "--device", "slcan:./can", "--model",
                                        "motor.toml", "--out", f"bench-{limit[:5]}", code=1)
                self.assertIn(reason, said)
                self.assertEqual(self.stop_bench()["how"], 0)

    def test_what_cannot_be_is_said_before_anything_is_opened(self):
        self.start_bench("--speaks", "moteus", "--device", "./can")
        for drive, bus, reason in (("motor_voltage", "odrive", "cannot be asked for motor_voltage"),
                                   ("duty", "moteus", "cannot be asked for duty"), ("motor_torque", "shim", "duty alone"),
                                   ("motor_torque", "can-open", "there is no such bus")):
            (self.folder / "plan.toml").unlink(missing_ok=True)
            self.plan(drive, 0.1)
            said = self.run_program("acquire", "plan.toml", "--bus", bus, "--device", "slcan:./nothing", "--model", "motor.toml",
                                    "--out", "bench", code=2)
            self.assertIn(reason, said)
        self.assertFalse((self.folder / "bench.part").exists())


if __name__ == "__main__":
    unittest.main()
