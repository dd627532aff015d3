#!/usr/bin/env python3
"""Walks docs/whole-way.md: its commands, in order, against the hidden robot behind a real dongle's packets, over ptys, in real time.

The page says what a user types; only the dongle's name, the cameras' group and the program are put in. What is asked of it: the hidden
effect is named, its size is found, the error falls, and everything is on disk.
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
PAGE = HERE.parents[1] / "docs" / "whole-way.md"
PROGRAM = os.environ.get("OMNIHIL_PROGRAM", "")
HIDDEN = {"radius_1": 1.04, "radius_2": 0.98, "radius_3": 1.0, "radius_4": 0.98}
DEADLINE_S = 120.0


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]

# What a computer that is late does to a record: packets, samples and frames behind their time. Late is a packet that
# leaves more than a frame of the cameras (60 Hz) behind its time, as `acquire` writes into the dataset's README.
LATE_MS = 1000.0 / 60.0
LATE_EFFECTS = {"actuator_delay", "sampling_delay", "sample_jitter", "vision_delay"}


class WholeWay(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="omnihil-whole-way-"))
        self.group = f"224.5.23.2:{free_port()}"
        self.background = []
        self.start([sys.executable, str(HERE / "radio_bench.py"), "--device", "./real", "--robot", "3", "--vision", self.group,
                    "--hide", json.dumps(HIDDEN), "--model", "my_robot.toml", "--seed", "5"], "real")

    def tearDown(self):
        for process in self.background:
            process.send_signal(signal.SIGTERM)
            process.wait(DEADLINE_S)

    def start(self, words, appears):
        self.background.append(subprocess.Popen(words, cwd=self.folder, stdout=subprocess.DEVNULL))
        end_s = time.monotonic() + DEADLINE_S
        while not (self.folder / appears).exists():
            self.assertIsNone(self.background[-1].poll(), words)
            self.assertLess(time.monotonic(), end_s, f"{appears} did not appear")
            time.sleep(0.02)

    def type(self, line):
        """One line of the page; returns what it prints."""
        line = line.replace("/dev/ttyACM0", "./real")
        line = line.replace("--vision on", f"--vision {self.group} --vision-interface 127.0.0.1")
        words = line.split()
        self.assertEqual(words[0], "omnihil")
        words[0] = PROGRAM
        if words[-1] == "&":
            self.start(words[:-1], re.search(r"--device (\S+)", line)[1])
            return ""
        done = subprocess.run(words, cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, f"{line}\n{done.stdout}{done.stderr}")
        return done.stdout

    def was_late(self):
        text = (self.folder / "bench" / "README.md").read_text(encoding="utf-8")
        latest = [float(ms) for ms in re.findall(r"\| ([\d.]+) ms \|$", text, re.M)]
        self.assertEqual(len(latest), 3, text)
        print(f"latest packets: {latest} ms", file=sys.stderr)
        return max(latest) > LATE_MS

    def test_the_page_leads_from_the_dongle_to_the_effect(self):
        if not PROGRAM:
            self.skipTest("OMNIHIL_PROGRAM is not set")
        said = {}
        for block in re.findall(r"```sh\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S):
            for line in block.splitlines():
                verb = line.split()[1]
                said[verb] = said.get(verb, "") + self.type(line)
        self.assertIn("extrapolation", said["acquire"])
        verdict = next(line for line in said["diagnose"].splitlines() if line.startswith("Verdict"))
        # "found, but more remains" too: a loaded computer is late, and no model has that.
        self.assertRegex(verdict, r"^Verdict: found.*: wheel_radius_mismatch", said["diagnose"])
        found = json.loads((self.folder / "found.json").read_text(encoding="utf-8"))
        self.assertEqual(found["effects"][0], "wheel_radius_mismatch")
        # Nothing else is hidden. A delay is in the record all the same where this computer was late.
        self.assertLessEqual(set(found["effects"][1:]), LATE_EFFECTS if self.was_late() else set(), said["diagnose"])
        self.assertIn("wheel_radius_mismatch", (self.folder / "bench" / "model.toml").read_text(encoding="utf-8"))
        self.assertTrue((self.folder / "bench" / "packets" / "fit.txt").exists())
        self.assertTrue((self.folder / "cards" / "model.card.html").exists())
        self.assertRegex(said["add"], r"held-out error energy falls by \d")


if __name__ == "__main__":
    unittest.main()
