#!/usr/bin/env python3
"""The live twin beside the hidden robot: no alarm while it is healthy, a name for what breaks, live over ptys as on a record."""
import functools
import json
import math
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import time
import tty
import unittest

import radio_bench
import twin_case
from twin import BREAKS_S, KINDS, WITHIN_S, Owner, alarms, named

HERE = pathlib.Path(__file__).resolve().parent
PROGRAM = os.environ.get("OMNIHIL_PROGRAM", "")
DEADLINE_S = 60.0
ROBOT = 3
FOLDER = pathlib.Path(tempfile.mkdtemp(prefix="omnihil-twin-"))


@functools.cache
def owner():
    return Owner(PROGRAM, FOLDER, 2, 30)


def packet(message_id, vx, vy, spin, heading):
    """A REM RobotCommand of a body velocity, in the field's frame as that team has it."""
    out = radio_bench.Bits(bytes(radio_bench.COMMAND[1]))
    for byte, bit, bits, value in ((0, 0, 8, radio_bench.COMMAND[0]), (1, 0, 4, ROBOT), (1, 4, 1, radio_bench.BLUE), (2, 7, 1, 1),
                                   (3, 0, 4, radio_bench.VERSION), (3, 4, 4, message_id), (10, 0, 8, radio_bench.COMMAND[1])):
        out.put(byte, bit, bits, value)
    out.put(11, 0, 16, radio_bench.raw(math.hypot(vx, vy), 0, 30))
    out.put(13, 0, 16, radio_bench.raw(radio_bench.wrapped(math.atan2(vy, vx) + heading), -math.pi, math.pi))
    out.put(17, 0, 16, radio_bench.raw(spin, -10 * math.pi, 10 * math.pi))
    out.put(27, 5, 1, 1)  # sendStateInfo
    return out.bytes()


@unittest.skipIf(not PROGRAM, "OMNIHIL_PROGRAM is not set")
class Twin(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.owner = owner()

    def test_ten_healthy_minutes_raise_no_alarm(self):
        self.assertEqual(alarms(self.owner.watch("healthy", 660.0)), [])

    def test_what_breaks_is_named_within_five_seconds(self):
        for fault, wheel in (("torque", 2), ("magnets", 4), ("encoder", 1), ("battery", 1)):
            with self.subTest(fault=fault):
                change, suspect = twin_case.FAULTS[fault](wheel)
                events = self.owner.watch(f"{fault} {wheel}", BREAKS_S + 10.0, change)
                after_s, good = named(events, suspect)
                self.assertTrue(good, events)
                self.assertGreaterEqual(after_s, 0.0)

    def test_what_it_does_not_know_is_told_and_not_named(self):
        for fault, change in twin_case.UNKNOWN.items():
            with self.subTest(fault=fault):
                told = alarms(self.owner.watch(f"{fault} 1", BREAKS_S + 20.0, change))
                self.assertTrue(told)
                self.assertEqual({a["fault"] for a in told}, {"unknown"}, told)
                self.assertGreater(told[0]["time_s"], BREAKS_S)


@unittest.skipIf(not PROGRAM, "OMNIHIL_PROGRAM is not set")
class LiveTwin(unittest.TestCase):
    """In real time: the hidden robot behind a dongle, the tap with its twin, and a host that drives.

    A computer that does more than this is late by milliseconds, and the twin learns that as well: what breaks here is what no lateness hides."""

    LEARN_S, BREAKS_S = 25.0, 35.0

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="omnihil-twin-live-"))
        self.owner = owner()
        self.background = []
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
            s.bind(("127.0.0.1", 0))
            group = f"224.5.23.2:{s.getsockname()[1]}"
        robot = {**self.owner.robot.true, "supply_drift_V": 0}
        self.bench = self.start(
            [sys.executable, str(HERE / "radio_bench.py"), "--device", "./real", "--robot", str(ROBOT), "--vision", group,
             "--hide", json.dumps(robot), "--break", json.dumps({"dead_2": 1}), "--break-after", str(self.BREAKS_S)], "real")
        self.tap = self.start(
            [PROGRAM, "tap", "./real", "--device", "./dongle", "--radio", "roboteam-rem-v8", "--robots", str(ROBOT),
             "--record", "evening.omnirec", "--twin", str(self.owner.model), "--twin-learn", str(self.LEARN_S),
             "--twin-log", "events.jsonl"], "dongle")

    def tearDown(self):
        for process in self.background:
            if process.poll() is None:
                process.send_signal(signal.SIGTERM)
                process.wait(DEADLINE_S)

    def start(self, words, appears):
        with open(self.folder / "said", "a", encoding="utf-8") as said:
            self.background.append(subprocess.Popen(words, cwd=self.folder, stdout=said, stderr=said))
        end_s = time.monotonic() + DEADLINE_S
        while not os.path.lexists(self.folder / appears):
            self.assertIsNone(self.background[-1].poll(), (self.folder / "said").read_text(encoding="utf-8"))
            self.assertLess(time.monotonic(), end_s, f"{appears} did not appear")
            time.sleep(0.02)
        return self.background[-1]

    def drive(self, seconds):
        """Packets at 62.5 Hz through the tap; velocities are the body's, turned by the heading that the robot told last."""
        dongle = os.open(self.folder / "dongle", os.O_RDWR | os.O_NOCTTY)
        tty.setraw(dongle)
        os.set_blocking(dongle, False)
        sent, _ = twin_case.drive("live", KINDS, seconds, self.owner.robot)
        heading, begin_s, heard = 0.0, time.monotonic(), b""
        for n in range(0, len(sent), twin_case.PERIOD):
            wait_s = begin_s + n * 1e-3 - time.monotonic()
            if wait_s > 0:
                time.sleep(wait_s)
            try:
                heard = (heard + os.read(dongle, 4096))[-4096:]
            except BlockingIOError:
                pass
            at = heard.rfind(bytes([radio_bench.FEEDBACK[0]]), 0, max(0, len(heard) - radio_bench.FEEDBACK[1] + 1))
            if at >= 0 and len(heard) > at + 10 and heard[at + 10] == radio_bench.FEEDBACK[1]:
                told = radio_bench.Bits(heard[at : at + radio_bench.FEEDBACK[1]])
                heading = radio_bench.number(told.get(15, 0, 16), -math.pi, math.pi)
            os.write(dongle, packet(n // twin_case.PERIOD % 16, *sent[n][:3], heading))
        os.close(dongle)

    def test_an_encoder_that_dies_is_named_while_it_drives(self):
        self.drive(self.LEARN_S + 28.0)
        self.tap.send_signal(signal.SIGTERM)
        self.tap.wait(DEADLINE_S)
        said = (self.folder / "said").read_text(encoding="utf-8")
        self.assertEqual(self.tap.returncode, 1, said)
        log = (self.folder / "events.jsonl").read_text(encoding="utf-8")
        told = alarms(map(json.loads, log.splitlines()))
        self.assertEqual(told[0]["suspect"], "encoder line of wheel 2", said)
        self.assertIn("ALARM: encoder line of wheel 2", said)
        # On the tap's clock the robot broke BREAKS_S after its first command passed.
        begun_s = next(int(line.split()[1]) for line in open(self.folder / "evening.omnirec", encoding="utf-8") if line[0] == ">") * 1e-9
        self.assertGreaterEqual(told[0]["time_s"], begun_s + self.BREAKS_S)
        self.assertLessEqual(told[0]["time_s"], begun_s + self.BREAKS_S + WITHIN_S)
        # Afterwards, on what was recorded, the same is said to the last digit.
        again = subprocess.run([PROGRAM, "twin", "evening.omnirec", "--model", str(self.owner.model), "--twin-learn", str(self.LEARN_S),
                                "--twin-log", "again.jsonl"], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(again.returncode, 1, again.stdout + again.stderr)
        self.assertEqual((self.folder / "again.jsonl").read_text(encoding="utf-8"), log)


if __name__ == "__main__":
    unittest.main()
