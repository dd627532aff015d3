"""Records of a robot that is pushed straight by constant forces, with a tyre of its own: for the identification of tyre curves.

    python3 tyre_case.py FOLDER SEED grip=0.8 grip_slip=0.05 slide_slip=0.3 slide_grip=0.5 [step_s=40e-6]

The tyre of the model file is a guess that is far off. Other numbers of the model are off within their tolerances, as in robot_case.py.
"""
import pathlib
import sys

import dataset
import robot_case
import robot_drives
from axis_case import DT, source

GUESS = {"extremum_slip": 0.1, "extremum_value": 0.7, "asymptote_slip": 0.4, "asymptote_value": 0.6}
TOLERANCE = {"extremum_slip": 1.0, "extremum_value": 0.4, "asymptote_slip": 1.0, "asymptote_value": 0.4}


def pushes(rng, rows, levels, believed, push_s=0.35, rest_s=0.3):
    """Duties that accelerate the robot evenly, forward and back, at every level (m/s^2): even acceleration is constant force."""
    import math

    k, volt, gear, r, ohm = (believed[x] for x in ("flux_Vs", "supply_V", "gear", "wheel_m", "resistance_ohm"))
    ways = [-math.sin(math.radians(a)) for a in robot_drives.ANGLES]
    carried = sum(w * w for w in ways)
    inertia = believed["wheel_kgm2"] + gear * gear * believed["rotor_kgm2"]
    out = [[0.0] * 5 for _ in range(round(0.2 / DT))]
    n = 0
    while len(out) < rows:
        level = levels[n // 2 % len(levels)] * rng.uniform(0.93, 1.07) * (1 if n % 2 == 0 else -1)
        for way in (1, -1):  # up, and down to standstill
            for j in range(round(push_s / DT)):
                t = j * DT
                speed = level * (t if way > 0 else push_s - t)
                row = []
                for w in ways:
                    force = way * level * believed["mass_kg"] * w / carried
                    torque = (force * r + inertia * way * level * w / r) / gear + believed["dry_Nm"] * (
                        1 if speed * w > 0 else -1
                    )
                    duty = (torque / k * ohm + speed * w / r * gear * k) / volt
                    row.append(round(max(-1, min(1, duty)), 6))
                out.append(row + [0.0])
        out += [[0.0] * 5 for _ in range(round(rest_s / DT))]
        n += 1
    return out[:rows]


LEVELS = (1.5, 2.5, 4, 5.5, 7, 9, 11, 14, 18)


def make(folder, seed, tyre, levels=LEVELS, seconds=19):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    rng = source("tyre", seed)
    robot = robot_case.draw_robot(rng, ("known dry friction",))
    robot.sensors.update(bus=True, accel=True, dribbler=False, sigma=True)
    robot.true.update(tyre)
    robot.true["vision_noise_m"] = 0.0008
    sections = robot_case.model_sections(robot)
    sections["tyre.longitudinal"] = {
        k: f"{{ value = {v:g}, tolerance = {TOLERANCE[k]:g} }}" for k, v in GUESS.items()
    }
    dataset.write_model(folder / "model.toml", "robot", sections)
    runs = []
    for number, use in enumerate(("fit", "holdout")):
        run = source("tyre", seed, use)
        asked = pushes(run, round(seconds / DT), levels, robot.believed)
        dataset.write_csv(
            folder / f"run_{number + 1}.csv",
            robot_case.record(robot, robot.true, asked, run.randrange(1 << 30)),
        )
        runs.append({"file": f"run_{number + 1}.csv", "use": use, "excitation": "constant pushes"})
    dataset.write_dataset(folder, f"tyre {seed}", "robot", robot_case.channels_of(robot), runs)
    return robot.true


if __name__ == "__main__":
    make(sys.argv[1], int(sys.argv[2]), {k: float(v) for k, v in (a.split("=") for a in sys.argv[3:])})
