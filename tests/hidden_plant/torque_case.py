"""One record of an axis whose drive controls its torque: what a moteus, an ODrive or a VESC logs of a bench.

Rows are the drive's own torque (its winding current about the row's instant times the torque constant it was calibrated
with; its controller runs at 2 kHz, whatever the rows do) and one sensor of the motion; no duty, no bus voltage. The program imposes the motion and compares the torque.
"""
import math
import random

import dataset
import plant
from axis_case import answer_of, channels_of, source
from axis_effects import BY_ID, same_law, size_range
from axis_rig import TOLERANCE, draw_rig, model_sections
from share import hidden_at, solve

RUN_S = 16.0
CONTROL_S = 0.5e-3
REST_RAD_S, JUMP = 0.05, 0.1  # the latter a share of the largest torque
SETPOINT_S = 0.03  # time constant of the controller's filter of its targets
PERIODS_S = (1e-3, 2e-3, 5e-3, 10e-3)  # of a row: 1 kHz of a drive's own log, 100 Hz of a host that asks
IDS = (
    "coulomb_friction",
    "stribeck_friction",
    "lugre_friction",
    "friction_asymmetry",
    "load_dependent_friction",
    "gear_efficiency",
    "quadratic_drag",
    "cogging",
    "gravity_load",
    "imbalance",
    "constant_load",
    "backlash",
    "shaft_compliance",
)
FIT, OTHER = "steps and slow reversals", "a chirp"


def draw_bench(rng, needs, gear):
    """The bench and its rows' period. No heating is declared: the drive knows its torque."""
    rig = draw_rig(rng, "drive", gear, [n for n in needs if n != "current"] or ["not heated"])
    rig.heating_declared = False
    by_speed = "encoder" not in needs and rng.random() < 0.4
    rig.sensors = {"velocity": by_speed, "encoder": not by_speed, "torque": True, "sigma": rig.sensors["sigma"]}
    rig.true.update(supply_drift_V=0.0, step_s=25e-6)
    return rig, rng.choice(PERIODS_S)


def inertia(values, rig):
    return values["rotor_kgm2"] + values["load_kgm2"] / rig.believed["gear"] ** 2


def speeds(rng, rig, rows, period_s, kind):
    """Speeds that the drive's controller is asked for."""
    b = rig.believed
    top = 0.35 * b["supply_V"] / b["flux_Vs"]
    if kind == OTHER:
        half = RUN_S / 2
        rate = math.log(8 / 0.3) / half
        times = [(k * period_s) % half for k in range(rows)]
        return [0.5 * top * math.sin(2 * math.pi * 0.3 * (math.exp(rate * t) - 1) / rate) for t in times]
    out = []
    while len(out) < rows // 2:
        out += [rng.uniform(-1, 1) * top] * round(rng.uniform(0.2, 0.8) / period_s)
    del out[rows // 2 :]
    while len(out) < rows:
        n = round(rng.uniform(3, 6) / period_s)
        size = rng.uniform(0.1, 0.3) * top
        out += [size * math.sin(2 * math.pi * k / n) for k in range(n)]
    return out[:rows]


def drive(rig, params, asked, period_s, gain_per_s):
    """Rows (current about the instant, counts, speed) of the axis under a proportional speed controller."""
    axis = plant.LiveAxis(dict(params, sample_s=CONTROL_S))
    b, every = rig.believed, round(period_s / CONTROL_S)
    current, speed = plant.RAW.index("current"), plant.RAW.index("speed")
    out, limit, soft = [], 32e-3 * rig.torque_scale, 0.0
    for target in asked:
        for k in range(every):
            axis.look()
            behind = axis.raw[current]
            if k == 0:
                seen = axis.seen()
            soft += (target - soft) * CONTROL_S / SETPOINT_S
            dry = b["dry_Nm"] * max(-1.0, min(1.0, 0.5 * soft))  # half of it at 1 rad/s
            torque = inertia(b, rig) * gain_per_s * (soft - axis.raw[speed]) + dry
            axis.row(axis.CURRENT, max(-limit, min(limit, torque)) / b["flux_Vs"])
            if k == 0:
                axis.look()
                out.append((0.5 * (behind + axis.raw[current]), seen["counts"], seen["speed"]))
    axis.close()
    return out


def smooth(values, half):
    """Means over `half` rows to either side."""
    sums = [0.0]
    for x in values:
        sums.append(sums[-1] + x)
    n = len(values)
    return [
        (sums[min(n, k + half + 1)] - sums[max(0, k - half)]) / (min(n, k + half + 1) - max(0, k - half))
        for k in range(n)
    ]


class Ruler:
    """Share of an effect in the torque that the motion needs: what it adds to the true base parameters' torque along the
    noise-free motion, less what those can take within their tolerances, over what the motion's sensor leaves of the torque."""

    def __init__(self, rig, asked, period_s, gain_per_s, params):
        self.rig, self.asked, self.period_s, self.gain_per_s, self.params = rig, asked, period_s, gain_per_s, params
        self.rest = self.unexplained({})

    def unexplained(self, hidden):
        """Mean square of torque (N m)^2 that the base parameters cannot take."""
        t, rig = self.rig.true, self.rig
        quiet = dict(self.params, speed_noise_rad_s=0.0, encoder_cpr=1e9, **hidden)
        rows = drive(rig, quiet, self.asked, self.period_s, self.gain_per_s)
        angle = [2 * math.pi * counts / 1e9 for _, counts, _ in rows]
        h, columns, left = self.period_s, [[], [], []], []
        torque = [amps * t["flux_Vs"] for amps, _, _ in rows]
        jump = [abs(b - a) > JUMP * 32e-3 * rig.torque_scale for a, b in zip(torque, torque[1:] + torque[-1:])]
        near = smooth(jump, 2)
        for before, now, after, row, jumps in zip(angle, angle[1:], angle[2:], rows[1:], near[1:]):
            speed, acceleration = (after - before) / (2 * h), (after - 2 * now + before) / h**2
            # at rest dry friction takes what is asked; a jump between two rows may have been at any time between them
            moves = abs(speed) > REST_RAD_S and jumps == 0
            terms = (inertia(t, rig) * acceleration, t["viscous_Nms"] * speed, t["dry_Nm"] * math.copysign(1, speed))
            left.append(row[0] * t["flux_Vs"] - sum(terms) if moves else 0.0)
            for column, term in zip(columns, terms):
                column.append(term if moves else 0.0)
        left, *columns = (smooth(x, round(0.5 / self.top_Hz() / h)) for x in (left, *columns))
        names = ("rotor_kgm2", "viscous_Nms", "dry_Nm")
        columns = [[x * TOLERANCE[n][0] for x in c] for n, c in zip(names, columns) if t[n] != 0]
        over = 1 / self.noise_Nm()
        columns = [[x * over for x in c] for c in columns]
        products = [sum(a * b for a, b in zip(c, left)) * over for c in columns]
        gram = plant.inner_products(columns)
        moves = solve([[v + (j == k) for j, v in enumerate(row)] for k, row in enumerate(gram)], products)
        rest = [x - sum(m * c[k] for m, c in zip(moves, columns)) / over for k, x in enumerate(left)]
        return sum(x * x for x in rest) / len(rest)

    def top_Hz(self):
        """Of the torque that is looked at: a drive's mechanics, and what so many rows can show."""
        return min(100.0, 0.1 / self.period_s)

    def noise_Nm(self):
        """1-sigma of the inertia's torque by a white speed noise, differentiated and low-passed, and of the current's noise."""
        rate, t, top = 1 / self.period_s, self.rig.true, self.top_Hz()
        if self.rig.sensors["encoder"]:  # the count's rounding, differentiated twice
            count = 2 * math.pi / t["encoder_cpr"] / math.sqrt(12)
            per_Hz, power = 2 * count**2 / rate, 4
        else:
            per_Hz, power = 2 * t["speed_noise_rad_s"] ** 2 / rate, 2
        moved = inertia(t, self.rig) * math.sqrt(per_Hz * (2 * math.pi) ** power * top ** (power + 1) / (power + 1))
        return math.hypot(moved, 0.5 * t["current_noise_A"] * t["flux_Vs"] * math.sqrt(2 * top / rate))

    def share(self, hidden):
        energy = max(0.0, self.unexplained(hidden) - self.rest) / self.noise_Nm() ** 2
        return energy / (energy + 1)


def record(rng, rig, rows, period_s):
    """Columns of a file."""
    noise = random.Random(rng.randrange(1 << 30))
    t, out = rig.true, {"time_s": [round(k * period_s, 6) for k in range(len(rows))]}
    out["torque_Nm"] = [(amps + noise.gauss(0, 0.5 * t["current_noise_A"])) * t["flux_Vs"] for amps, _, _ in rows]
    if rig.sensors["encoder"]:
        out["ticks"] = [counts for _, counts, _ in rows]
    else:
        out["speed_rad_s"] = [speed for _, _, speed in rows]
    return out


def make_case(folder, key, effects, share):
    """A torque-driven bench with these effects hidden (none, one). Returns the answer."""
    rng = source(*key)
    wanted = [BY_ID[e] for e in effects]
    gears = [g for e in wanted for g in e.gears]
    rig, period_s = draw_bench(rng, [n for e in wanted for n in e.needs], rng.choice(gears) if gears else None)
    gain_per_s, rows = rng.uniform(15, 40), round(RUN_S / period_s)
    params, answers = dict(rig.true), []
    for effect in wanted:
        shape = effect.shape(rng, rig)
        asked = speeds(source(*key, "run", "fit"), rig, rows, period_s, FIT)
        ruler = Ruler(rig, asked, period_s, gain_per_s, rig.true)
        hidden, answer = hidden_at(effect, shape, rig, ruler, size_range(effect, rig), share, same_law(effect, rig))
        params.update(hidden)
        answers.append(answer)
    folder.mkdir(parents=True, exist_ok=True)
    dataset.write_model(folder / "model.toml", "axis", model_sections(rig))
    kinds, runs = (FIT, FIT, OTHER), []
    for number, (use, kind) in enumerate(zip(("fit", "holdout", "extrapolation"), kinds)):
        run = source(*key, "run", use)
        asked = speeds(run, rig, rows, period_s, kind)
        seen = drive(rig, {**params, "seed": run.randrange(100000)}, asked, period_s, gain_per_s)
        dataset.write_csv(folder / f"run_{number + 1}.csv", record(run, rig, seen, period_s))
        runs.append({"file": f"run_{number + 1}.csv", "use": use, "excitation": kind})
    dataset.write_dataset(folder, f"torque bench {folder.name}", "axis", channels_of(rig), runs)
    return answer_of(rig, kinds, answers)
