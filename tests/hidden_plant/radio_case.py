"""One record of a robot that radio commands drive: what a team has without touching its firmware.

Rows are what came in: commands as the host sent them (some never arrived), wheel speeds of the telemetry at 62.5 Hz, and
camera frames at 60 Hz. No duties, no currents, no gyro.
"""
import math

import dataset
import plant
import robot_case
import robot_drives
from axis_case import DT, ROWS, source
from robot_effects import BY_ID
from share import hidden_at

PERIOD = 16  # rows of 1 ms between two packets, both ways
SPEED_STEP = 0.05  # rad/s at the wheel, of the telemetry
# What the wheels' speeds and a camera at 60 Hz can show, with a loop that hides the rest.
IDS = (
    "wheel_slip",
    "lateral_roller_friction",
    "payload",
    "floor_tilt",
    "wheel_radius_mismatch",
    "vision_delay",
    "current_limit",
    "dribbler_drag",
    "coulomb_friction",
)


def draw_robot(rng, needs):
    robot = robot_case.draw_robot(rng, needs)
    robot.true.update(
        radio=1,
        loop_kp=rng.uniform(0.015, 0.05),
        loop_ki=rng.uniform(0.05, 0.5),
        loop_ff=robot.believed["flux_Vs"] * rng.choice((0.0, 1.0, 1.0)),
        loop_filter_s=rng.choice((0.002, 0.005)),
        loop_accel_m_s2=rng.choice((3.0, 4.0, 6.0)),
        loop_alpha_rad_s2=rng.choice((30.0, 60.0)),
        loop_wheel_m=robot.believed["wheel_m"],
        loop_base_m=robot.believed["base_m"],
        late_radio_s=rng.uniform(0.008, 0.035),
    )
    robot.sensors.update(bus=False, accel=False, loss=rng.uniform(0.0, 0.04))
    return robot


def asked_of(rng, kind, robot, rows=ROWS):
    """Commands of the host, one per packet; rows between hold. (what was sent, what arrived)"""
    twists = robot_drives.POOL[kind](rng, rows, DT)
    roll = robot_drives.dribbler(rng, rows, DT, robot.sensors["dribbler"])
    sent, heard, last, arrived = [], [], (0, 0, 0), (0, 0, 0)
    for k, (twist, d) in enumerate(zip(twists, roll)):
        if k % PERIOD == 0:
            last = tuple(round(x, 3) for x in twist)
            if k == 0 or rng.random() >= robot.sensors["loss"]:
                arrived = last
        sent.append([*last, 0.0, d])
        heard.append([*arrived, 0.0, d])
    return sent, heard


def signals_of(robot, params, asked):
    """Noise-free compared signals over their sensors' 1-sigma, by sensor: wheels and camera."""
    t = robot.true
    clean = dict(params, vision_noise_m=0, vision_noise_rad=0, encoder_cpr=1e7, step_s=50e-6)
    c = plant.run_robot(clean, asked)
    out = {"wheels": [], "camera": []}
    for k in range(1, 5):
        out["wheels"] += [x / speed_sigma(robot) for x in c[f"speed_{k}"][::PERIOD]]
    for name, sigma in (
        ("cam_x", t["vision_noise_m"]),
        ("cam_y", t["vision_noise_m"]),
        ("cam_turn", t["vision_noise_rad"]),
    ):
        frames = [x for x in c[name] if x == x]
        out["camera"] += [(b - a) / sigma / math.sqrt(2) for a, b in zip(frames, frames[1:])]
    return out


def speed_sigma(robot):
    """Of a reported speed: counts' rounding through the low pass, and the telemetry's step."""
    t = robot.true
    count = 2 * math.pi / t["encoder_cpr"] / DT / t["gear"] * math.sqrt(2 / 12)
    keep = DT / (t["loop_filter_s"] + DT)
    return math.hypot(count * keep / math.sqrt(2 - keep), SPEED_STEP / math.sqrt(12))


def record(robot, params, sent, heard, seed):
    c = plant.run_robot({**params, "seed": seed % 100000}, heard)
    rows = [k for k in range(len(sent)) if k % PERIOD == 0 or c["cam_x"][k] == c["cam_x"][k]]
    told = [k % PERIOD == 0 for k in rows]

    def telemetry(values):
        return [v if now else None for v, now in zip(values, told)]

    out = {"time_s": [round(k * DT, 6) for k in rows]}
    for axis, name in enumerate(("vx", "vy", "w")):
        out[f"asked_{name}"] = telemetry([sent[k][axis] for k in rows])
    if robot.sensors["dribbler"]:
        out["dribbler_rad_s"] = [sent[k][4] for k in rows]
    for i in range(1, 5):
        speeds = c[f"speed_{i}"]
        out[f"wheel_{i}"] = telemetry([round(speeds[k] / SPEED_STEP) * SPEED_STEP for k in rows])
    for name, column in (("cam_x", "vision_x"), ("cam_y", "vision_y"), ("cam_turn", "vision_theta")):
        out[column] = [None if c[name][k] != c[name][k] else c[name][k] for k in rows]
    return out


def channels_of(robot):
    t = robot.true
    sigma = (lambda x: {"sigma": f"{x:.3g}"}) if robot.sensors["sigma"] else (lambda x: {})
    out = {"time": {"column": '"time_s"'}}
    out.update({f"command_{n}": {"column": f'"asked_{n}"'} for n in ("vx", "vy", "w")})
    if robot.sensors["dribbler"]:
        out["dribbler"] = {"column": '"dribbler_rad_s"'}
    out.update({f"wheel_speed_{k}": {"column": f'"wheel_{k}"', **sigma(speed_sigma(robot))} for k in range(1, 5)})
    for name, noise in (
        ("vision_x", "vision_noise_m"),
        ("vision_y", "vision_noise_m"),
        ("vision_theta", "vision_noise_rad"),
    ):
        out[name] = {"column": f'"{name}"', **sigma(t[noise])}
    return out


def model_sections(robot):
    t = robot.true
    sections = robot_case.model_sections(robot)
    late = 0.005 * round(t["late_radio_s"] / 0.005 + 0.5)  # what the owner guesses
    sections["controller"] = {
        "kp_V_s_per_rad": f"{t['loop_kp']:.6g}",
        "ki_V_per_rad": f"{t['loop_ki']:.6g}",
        "feedforward_V_s_per_rad": f"{t['loop_ff']:.6g}",
        "speed_filter_s": f"{t['loop_filter_s']:g}",
        "acceleration_limit_m_s2": f"{t['loop_accel_m_s2']:g}",
        "yaw_acceleration_limit_rad_s2": f"{t['loop_alpha_rad_s2']:g}",
        "latency_s": f"{{ value = {late:g}, tolerance = 0.5 }}",
        "wheel_radius_m": f"{t['loop_wheel_m']:g}",
        "wheel_center_radius_m": f"{t['loop_base_m']:g}",
    }
    return sections


def make_case(folder, key, effects, share):
    """A robot behind its radio with these effects hidden (none, one)."""
    rng = source(*key)
    wanted = [BY_ID[e] for e in effects]
    robot = draw_robot(rng, [n for e in wanted for n in e.needs])
    shows = wanted[0].shows if wanted else tuple(robot_drives.POOL)
    main = rng.choice(shows)
    kinds = (main, main, rng.choice([k for k in robot_drives.POOL if k != main]))
    params, answers = dict(robot.true), []
    for effect in wanted:
        shape = effect.shape(rng, robot)
        heard = asked_of(source(*key, "run", "fit"), main, robot, ROWS // 2)[1]
        ruler = robot_case.Ruler(robot, heard, signals_of)
        hidden, answer = hidden_at(effect, shape, robot, ruler, effect.size, share, effect.same)
        params.update(hidden)
        answers.append(answer)
    folder.mkdir(parents=True, exist_ok=True)
    dataset.write_model(folder / "model.toml", "robot", model_sections(robot))
    runs = []
    for number, (use, kind) in enumerate(zip(("fit", "holdout", "extrapolation"), kinds)):
        run = source(*key, "run", use)
        sent, heard = asked_of(run, kind, robot)
        dataset.write_csv(
            folder / f"run_{number + 1}.csv", record(robot, params, sent, heard, run.randrange(1 << 30))
        )
        runs.append({"file": f"run_{number + 1}.csv", "use": use, "excitation": robot_drives.PLAIN[kind]})
    dataset.write_dataset(folder, f"radio {folder.name}", "robot", channels_of(robot), runs)
    skip = robot.left_out | robot.known
    base = {name: path for name, (path, _, _, _) in robot_case.BASE.items() if name not in skip}
    return {
        "rig": "robot",
        "effects": answers,
        "excitation": list(kinds),
        "sensors": robot.sensors,
        "base": {path: robot.true[name] for name, path in base.items()},
        "believed": {path: robot.believed[name] for name, path in base.items()},
    }
