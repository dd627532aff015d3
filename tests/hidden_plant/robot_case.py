"""One robot record with its answer: four wheels on the floor, three runs."""
import dataclasses
import math

import dataset
import plant
import robot_drives
from axis_case import DT, ROWS, source
from robot_effects import BY_ID
from share import hidden_at, solve

# How far off the truth is (from, to) and the relative 1-sigma the model file states; None: known.
BASE = {
    "resistance_ohm": ("motor.resistance_ohm", 0.05, 0.10, 0.08),
    "flux_Vs": ("motor.torque_constant_Nm_per_A", 0.03, 0.05, 0.04),
    "viscous_Nms": ("motor.viscous_friction_Nm_s_per_rad", 0.1, 0.3, 0.3),
    "mass_kg": ("robot.mass_kg", 0.005, 0.02, 0.02),
    "yaw_kgm2": ("robot.yaw_inertia_kg_m2", 0.05, 0.15, 0.15),
    "wheel_m": ("robot.wheel_radius_m", 0.002, 0.01, 0.01),
    "dry_Nm": ("effects.coulomb_friction.torque_Nm", 0.1, 0.3, 0.3),
    "grip_slip": ("tyre.longitudinal.extremum_slip", 0.02, 0.15, 0.2),
    "roller_grip": ("tyre.lateral.extremum_value", 0.02, 0.2, 0.3),
}
BELIEVED = dict(
    resistance_ohm=0.464,
    inductance_H=0.3e-3,
    flux_Vs=0.0335,
    rotor_kgm2=1.35e-5,
    viscous_Nms=4e-6,
    dry_Nm=2.7e-3,
    gear=3.0,
    supply_V=22.2,
    mass_kg=2.4,
    yaw_kgm2=0.012,
    height_m=0.045,
    base_m=0.0805,
    wheel_m=0.027,
    wheel_kgm2=2.2e-5,
    grip=0.75,
    grip_slip=0.10,
    slip_floor_m_s=0.5,
    roller_grip=0.02,
)


@dataclasses.dataclass
class Robot:
    believed: dict
    true: dict
    sensors: dict
    left_out: set
    known: set


def draw_robot(rng, needs=()):
    believed = dict(BELIEVED)
    believed.update(mass_kg=round(rng.uniform(2.1, 2.7), 2), dry_Nm=round(rng.uniform(2e-3, 3.5e-3), 5))
    true = dict(believed)
    for name, (_, least, most, _) in BASE.items():
        true[name] *= 1 + rng.choice((-1, 1)) * rng.uniform(least, most)
    left_out, known = set(), set()
    if "no dry friction" in needs or (not needs and rng.random() < 0.08):
        left_out.add("dry_Nm")
        true["dry_Nm"] = 0.0
    if "known dry friction" in needs or rng.random() < 0.2:  # measured with the wheels lifted
        known.add("dry_Nm")
        believed["dry_Nm"] = float(f"{true['dry_Nm']:.5g}")
    loud = rng.choice((0.5, 1.0, 1.0, 2.0))
    bus = "bus hidden" not in needs and rng.random() < 0.8
    sensors = dict(
        bus=bus,
        accel=rng.random() < 0.5,
        dribbler="dribbler" in needs or rng.random() < 0.2,
        sigma=rng.random() < 0.8,
    )
    true.update(
        current_noise_A=0.05 * loud,
        gyro_noise_rad_s=0.01 * loud,
        vision_noise_m=0.0008 * loud,
        vision_noise_rad=0.004 * loud,
        accel_noise_m_s2=0.15 * loud,
        encoder_cpr=rng.choice((4096.0, 16384.0)),
    )
    if bus:
        true.update(supply_drift_V=rng.uniform(0, 0.2), supply_drift_Hz=rng.uniform(0.03, 0.08))
    true["supply_V"] *= 1 + rng.uniform(-0.004, 0.004)
    return Robot(believed, true, sensors, left_out, known)


def model_sections(robot):
    b = robot.believed

    def number(name):
        return (
            f"{b[name]:.6g}"
            if name in robot.known
            else f"{{ value = {b[name]:.6g}, tolerance = {BASE[name][3]:g} }}"
        )

    motor = {
        "resistance_ohm": number("resistance_ohm"),
        "inductance_H": f"{b['inductance_H']:g}",
        "torque_constant_Nm_per_A": number("flux_Vs"),
        "pole_pairs": "8",
        "slots": "12",
        "rotor_inertia_kg_m2": f"{b['rotor_kgm2']:g}",
        "viscous_friction_Nm_s_per_rad": number("viscous_Nms"),
    }
    body = {
        "mass_kg": number("mass_kg"),
        "yaw_inertia_kg_m2": number("yaw_kgm2"),
        "center_of_mass_height_m": f"{b['height_m']:g}",
        "wheel_center_radius_m": f"{b['base_m']:g}",
        "wheel_radius_m": number("wheel_m"),
        "wheel_inertia_kg_m2": f"{b['wheel_kgm2']:g}",
        "wheel_angle_deg": str(list(robot_drives.ANGLES)),
        "rollers_per_wheel": "15",
        "slip_speed_floor_m_s": f"{b['slip_floor_m_s']:g}",
    }
    along = {
        "extremum_slip": number("grip_slip"),
        "extremum_value": f"{b['grip']:g}",
        "asymptote_slip": "0.4",
        "asymptote_value": "0.6",
    }
    across = {
        "extremum_slip": "1.0",
        "extremum_value": number("roller_grip"),
        "asymptote_slip": "2.0",
        "asymptote_value": "0.01",
    }
    sections = {
        "motor": motor,
        "gear": {"ratio": f"{b['gear']:g}"},
        "supply": {"voltage_V": f"{{ value = {b['supply_V']:g}, tolerance = 0.005 }}"},
        "robot": body,
        "tyre.longitudinal": along,
        "tyre.lateral": across,
    }
    if "dry_Nm" not in robot.left_out:
        sections["effects.coulomb_friction"] = {"torque_Nm": number("dry_Nm")}
    return sections


def signals_of(robot, params, asked):
    """Noise-free compared signals over their sensors' 1-sigma, by sensor: wheels, currents, gyro, camera."""
    t = robot.true
    clean = dict(
        params,
        current_noise_A=0,
        bus_noise_V=0,
        gyro_noise_rad_s=0,
        vision_noise_m=0,
        vision_noise_rad=0,
        accel_noise_m_s2=0,
        encoder_cpr=1e7,
        step_s=50e-6,
    )
    c = plant.run_robot(clean, asked)
    count = 2 * math.pi / t["encoder_cpr"] / DT * math.sqrt(2 / 12)
    out = {"wheels": [], "currents": [], "gyro": [x / t["gyro_noise_rad_s"] for x in c["gyro"]], "camera": []}
    for k in range(1, 5):
        turns = c[f"counts_{k}"]
        out["wheels"] += [0.0] + [(b - a) * 2 * math.pi / 1e7 / DT / count for a, b in zip(turns, turns[1:])]
        out["currents"] += [x / t["current_noise_A"] for x in c[f"current_{k}"]]
    for name, sigma in (
        ("cam_x", t["vision_noise_m"]),
        ("cam_y", t["vision_noise_m"]),
        ("cam_turn", t["vision_noise_rad"]),
    ):
        frames = [x for x in c[name] if x == x]
        out["camera"] += [(b - a) / sigma / math.sqrt(2) for a, b in zip(frames, frames[1:])]
    return out


class Ruler:
    """Share of the residual energy as in share.py; of the sensors' own shares the largest counts."""

    def __init__(self, robot, asked, signals=signals_of):
        self.robot, self.asked, self.signals = robot, asked, signals
        self.base = signals(robot, robot.true, asked)
        self.columns = []
        for name, (_, _, _, tolerance) in BASE.items():
            value = robot.true[name]
            if value == 0 or name in robot.known:
                continue
            moved = signals(robot, {**robot.true, name: value * (1 + 0.1 * tolerance)}, asked)
            self.columns.append([10 * d for d in self._difference(moved)])
        self.gram = plant.inner_products(self.columns)

    def _difference(self, other):
        return [b - a for group in self.base for a, b in zip(self.base[group], other[group])]

    def share(self, hidden):
        changed = self.signals(self.robot, {**self.robot.true, **hidden}, self.asked)
        difference = self._difference(changed)
        products = [sum(a * b for a, b in zip(column, difference)) for column in self.columns]
        held = [[v + (j == k) for j, v in enumerate(row)] for k, row in enumerate(self.gram)]
        moves = solve(held, products)
        left = [
            d - sum(m * column[k] for m, column in zip(moves, self.columns)) for k, d in enumerate(difference)
        ]
        best, start = 0.0, 0
        for group in self.base.values():
            energy = sum(x * x for x in left[start : start + len(group)]) / len(group)
            best, start = max(best, energy / (energy + 1)), start + len(group)
        return best


def asked_of(rng, kind, robot, rows=ROWS):
    twists = robot_drives.POOL[kind](rng, rows, DT)
    roll = robot_drives.dribbler(rng, rows, DT, robot.sensors["dribbler"])
    return [row + [d] for row, d in zip(robot_drives.duties(twists, robot.believed), roll)]


def record(robot, params, asked, seed):
    c = plant.run_robot({**params, "seed": seed % 100000}, asked)
    out = {"time_s": [round(k * DT, 6) for k in range(len(asked))]}
    wheels = len(asked[0]) - 1
    for k in range(wheels):
        out[f"duty_{k + 1}"] = [row[k] for row in asked]
    if robot.sensors["dribbler"]:
        out["dribbler_rad_s"] = [row[-1] for row in asked]
    if robot.sensors["bus"]:
        out["bus_V"] = list(c["bus"])
    for k in range(1, wheels + 1):
        out[f"current_{k}"] = list(c[f"current_{k}"])
        out[f"ticks_{k}"] = list(c[f"counts_{k}"])
    out["gyro_z"] = list(c["gyro"])
    if robot.sensors["accel"]:
        out["accel_x"], out["accel_y"] = list(c["ax"]), list(c["ay"])
    for name, column in (("cam_x", "vision_x"), ("cam_y", "vision_y"), ("cam_turn", "vision_theta")):
        out[column] = [None if x != x else x for x in c[name]]
    return out


def channels_of(robot, wheels=4):
    t = robot.true
    sigma = (lambda x: {"sigma": f"{x:.3g}"}) if robot.sensors["sigma"] else (lambda x: {})
    out = {"time": {"column": '"time_s"'}}
    out.update({f"duty_{k}": {"column": f'"duty_{k}"'} for k in range(1, wheels + 1)})
    if robot.sensors["dribbler"]:
        out["dribbler"] = {"column": '"dribbler_rad_s"'}
    if robot.sensors["bus"]:
        out["bus_voltage"] = {"column": '"bus_V"', **sigma(0.02)}
    for k in range(1, wheels + 1):
        out[f"motor_current_{k}"] = {"column": f'"current_{k}"', **sigma(t["current_noise_A"])}
    for k in range(1, wheels + 1):
        out[f"encoder_{k}"] = {
            "column": f'"ticks_{k}"',
            "counts_per_rev": f'{t["encoder_cpr"]:.0f}',
            "shaft": '"rotor"',
        }
    out["gyro_z"] = {"column": '"gyro_z"', **sigma(t["gyro_noise_rad_s"])}
    if robot.sensors["accel"]:
        out.update(
            {name: {"column": f'"{name}"', **sigma(t["accel_noise_m_s2"])} for name in ("accel_x", "accel_y")}
        )
    for name, noise in (
        ("vision_x", "vision_noise_m"),
        ("vision_y", "vision_noise_m"),
        ("vision_theta", "vision_noise_rad"),
    ):
        out[name] = {"column": f'"{name}"', **sigma(t[noise])}
    return out


def make_case(folder, key, effects, share, outside=None):
    """A robot with these effects hidden (none, one), or with plant parameters that no list of effects has."""
    rng = source(*key)
    wanted = [BY_ID[e] for e in effects]
    robot = draw_robot(rng, [n for e in wanted for n in e.needs])
    shows = wanted[0].shows if wanted else tuple(robot_drives.POOL)
    main = rng.choice(shows)
    kinds = (main, main, rng.choice([k for k in robot_drives.POOL if k != main]))
    params, answers = dict(robot.true), []
    for effect in wanted:
        shape = effect.shape(rng, robot)
        ruler = Ruler(robot, asked_of(source(*key, "run", "fit"), main, robot, ROWS // 2))
        hidden, answer = hidden_at(effect, shape, robot, ruler, effect.size, share, effect.same)
        params.update(hidden)
        answers.append(answer)
    params.update(outside or {})
    folder.mkdir(parents=True, exist_ok=True)
    dataset.write_model(folder / "model.toml", "robot", model_sections(robot))
    runs = []
    for number, (use, kind) in enumerate(zip(("fit", "holdout", "extrapolation"), kinds)):
        run = source(*key, "run", use)
        asked = asked_of(run, kind, robot)
        dataset.write_csv(
            folder / f"run_{number + 1}.csv", record(robot, params, asked, run.randrange(1 << 30))
        )
        runs.append({"file": f"run_{number + 1}.csv", "use": use, "excitation": robot_drives.PLAIN[kind]})
    dataset.write_dataset(folder, f"robot {folder.name}", "robot", channels_of(robot), runs)
    skip = robot.left_out | robot.known
    return {
        "rig": "robot",
        "effects": answers,
        "excitation": list(kinds),
        "sensors": robot.sensors,
        "base": {path: robot.true[name] for name, (path, _, _, _) in BASE.items() if name not in skip},
        "believed": {
            path: robot.believed[name] for name, (path, _, _, _) in BASE.items() if name not in skip
        },
    }
