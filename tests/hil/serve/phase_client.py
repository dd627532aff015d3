"""A HERMES host at robots whose own firmware closes the motor loop: three-phase bridges behind the dongle."""
import os
import shutil
import subprocess
import sys
import tempfile

import serial

import bench as rig
import hermes
from bench import Bench, DEADLINE_S

MODELS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../../models")


def drive_with(model_lines):
    """Drives robot 0 forward at 0.5 m/s over the serial port; what was recorded of it, and the report."""
    folder = tempfile.mkdtemp(prefix="omnihil-model-")
    try:
        shutil.copytree(MODELS, os.path.join(folder, "models"))
        path = os.path.join(folder, "models/robots/mine.toml")
        with open(os.path.join(MODELS, "robots/omni_default.toml"), encoding="utf-8") as text:
            model = text.read().replace("[firmware]\n", "[firmware]\n" + model_lines["firmware"])
        with open(path, "w", encoding="utf-8") as text:
            text.write(model + model_lines["sections"])
        arguments = ["--robot", path, "--robots", "0", "--radio", "ulaval-hermes", "--sample-every", "1",
                     "--record", "{folder}/run.omnirec"]
        with Bench(arguments) as bench, serial.Serial(bench.device, 115200, timeout=DEADLINE_S,
                                                      write_timeout=DEADLINE_S) as port:
            # A request with an answer after each command paces this client by the robot's own answers.
            for _ in range(300):
                port.write(hermes.speed_move(0, 0.5, 0.0, 0.0))
                hermes.ping(port)
            report = bench.stop()
            assert report.code == 0, report.text
            assert report.refused == 0, report.text
            rows = rig.recorded(bench.path("run.omnirec"),
                                ["true_v_forward_m_s", "true_v_left_m_s", "drive_mode_1"])
            # the recording says all that is needed to make the same run again, bit for bit
            check = subprocess.run([bench.program, "check", bench.path("run.omnirec")], capture_output=True,
                                   text=True, check=False)
            assert check.returncode == 0, check.stdout + check.stderr
            return rows
    finally:
        shutil.rmtree(folder)


def follows(rows, mode):
    last = rows[-1][2]
    assert last["drive_mode_1"] == mode, last
    assert abs(last["true_v_forward_m_s"] - 0.5) < 0.04 and abs(last["true_v_left_m_s"]) < 0.04, last


def field_oriented_control_follows_a_velocity():
    follows(drive_with({"firmware": 'motor_loop = "foc"\n',
                        "sections": '\n[drive]\nkind = "dq"\ndead_time_s = 3e-7\n'
                                    '\n[battery]\ncells = 6\n\n[current_sensor]\nbits = 12\n'}), 2)


def six_step_control_follows_a_velocity():
    follows(drive_with({"firmware": 'motor_loop = "six_step"\n',
                        "sections": '\n[drive]\nkind = "switched"\ndead_time_s = 3e-7\n'}), 2)


TESTS = {name: function for name, function in list(globals().items())
         if name.endswith("_follows_a_velocity")}

if __name__ == "__main__":
    sys.exit(rig.main(TESTS))
