"""A robot that is driven around a rectangle by open-loop duties and seen by a camera.

    python3 rectangle_case.py FOLDER SEED [true]        `true`: the model file has the true numbers
"""
import pathlib
import sys

import dataset
import robot_case
import robot_drives
from axis_case import DT, source


def rectangle(length=1.2, width=0.8, speed=0.8, ramp=2.0):
    """Twists of the body: four sides, standing at the corners, always looking the same way."""
    out = [(0.0, 0.0, 0.0)] * round(0.4 / DT)
    for dx, dy, way in ((1, 0, length), (0, 1, width), (-1, 0, length), (0, -1, width)):
        rise = speed / ramp
        flat = way / speed - rise
        for k in range(round((2 * rise + flat) / DT)):
            t = k * DT
            v = min(speed, ramp * t, ramp * (2 * rise + flat - t))
            out.append((dx * v, dy * v, 0.0))
        out += [(0.0, 0.0, 0.0)] * round(0.3 / DT)
    return out


def make(folder, seed, told_the_truth=False):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    rng = source("rectangle", seed)
    robot = robot_case.draw_robot(rng, ("known dry friction",))
    robot.sensors.update(bus=True, accel=False, dribbler=False, sigma=True)
    robot.true["supply_drift_V"] = 0.0
    robot.true["step_s"] = 1e-5
    asked = [row + [0.0] for row in robot_drives.duties(rectangle(), robot.believed)]
    if told_the_truth:
        robot.believed.update({k: robot.true[k] for k in robot.believed})
    sections = robot_case.model_sections(robot)
    dataset.write_model(folder / "model.toml", "robot", sections)
    dataset.write_csv(folder / "run_1.csv", robot_case.record(robot, robot.true, asked, rng.randrange(1 << 30)))
    runs = [{"file": "run_1.csv", "use": "fit", "excitation": "rectangle"}]
    dataset.write_dataset(folder, "rectangle", "robot", robot_case.channels_of(robot), runs)


if __name__ == "__main__":
    make(sys.argv[1], int(sys.argv[2]), "true" in sys.argv[3:])
