"""Records for the live twin: a hidden robot behind its radio, driven for a while, that breaks on the way.

What a team's telemetry tells: wheel speeds, gyro and battery at 62.5 Hz. The model is fitted to a drive of its own before.
"""
import random

import dataset
import plant
import radio_case
import robot_drives
from axis_case import DT

PERIOD = radio_case.PERIOD
BATTERY_STEP_V = 15 / 65535  # as REM tells it
GYRO_STEP = 40 / 65535
HEALTHY = {"battery_ohm": 0.03, "battery_rc_ohm": 0.01, "battery_rc_s": 0.6}  # a good battery
# What breaks: name -> (what changes, suspect that has to be named; None: it is in no bank of faults)
FAULTS = {
    "torque": lambda w: ({f"push_{w}": 0.8}, f"torque of wheel {w}"),
    "magnets": lambda w: ({f"flux_{w}": 0.8}, f"torque of wheel {w}"),
    "encoder": lambda w: ({f"dead_{w}": 1}, f"encoder line of wheel {w}"),
    "battery": lambda w: ({"battery_ohm": 0.2, "battery_rc_ohm": 0.07}, "sagging battery"),
}
UNKNOWN = {
    "radius": {"radius_2": 0.94},
    "tilt": {"tilt_rad": 0.1, "tilt_towards": 1.0},
    "slip": {"brush": 1, "brush_m_s": 0.15, "brush_grip": 0.4},
    "current cap": {"current_cap_A": 1.2},
}


def draw_robot(seed):
    robot = radio_case.draw_robot(random.Random(seed), ["bus hidden"])
    robot.true.update(HEALTHY, supply_drift_V=0.3, supply_drift_Hz=0.002)
    return robot


def drive(seed, kinds, seconds, robot):
    """Legs of the kinds in turn, 20 s each; what was sent and what arrived."""
    rng, sent, heard = random.Random(seed), [], []
    while len(sent) < seconds / DT:
        some = radio_case.asked_of(rng, kinds[(len(sent) * 20 // 400000) % len(kinds)], robot, 20000)
        sent += some[0]
        heard += some[1]
    rows = round(seconds / DT)
    return sent[:rows], heard[:rows]


def record(robot, params, sent, heard, seed, change=None):
    """Rows of telemetry; the host's command and the answer stand in one row."""
    c = plant.run_robot({**params, "seed": seed % 100000}, heard, change)
    rows = range(0, len(sent), PERIOD)
    out = {"time_s": [round(k * DT, 6) for k in rows]}
    for axis, name in enumerate(("vx", "vy", "w")):
        out[f"asked_{name}"] = [sent[k][axis] for k in rows]
    step = radio_case.SPEED_STEP
    for i in range(1, 5):
        out[f"wheel_{i}"] = [round(c[f"speed_{i}"][k] / step) * step for k in rows]
    out["gyro"] = [round(c["gyro"][k] / GYRO_STEP) * GYRO_STEP for k in rows]
    out["battery"] = [round(c["bus"][k] / BATTERY_STEP_V) * BATTERY_STEP_V for k in rows]
    return out


CHANNELS = {
    "time": {"column": '"time_s"'},
    **{f"command_{n}": {"column": f'"asked_{n}"'} for n in ("vx", "vy", "w")},
    **{f"wheel_speed_{k}": {"column": f'"wheel_{k}"', "sigma": "0.02"} for k in range(1, 5)},
    "gyro_z": {"column": '"gyro"'},
    "bus_voltage": {"column": '"battery"', "sigma": "0.02"},
}


def write(folder, robot, runs):
    """`runs`: [(columns, use)]."""
    folder.mkdir(parents=True, exist_ok=True)
    dataset.write_model(folder / "model.toml", "robot", radio_case.model_sections(robot))
    listed = []
    for k, (columns, use) in enumerate(runs):
        dataset.write_csv(folder / f"run_{k + 1}.csv", columns)
        listed.append({"file": f"run_{k + 1}.csv", "use": use, "excitation": "drive"})
    dataset.write_dataset(folder, folder.name, "robot", CHANNELS, listed)
