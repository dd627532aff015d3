#!/usr/bin/env python3
"""Draws the pictures of these pages from simulated records: pictures.py PROGRAM [NAME…]; pictures.py --check PROGRAM [NAME…].

Each picture holds a record with the fault against one without it, made by `omnihil sim` (written into the picture's first
lines). --check draws anew and compares with the files here to a pixel: exit 1 names those that differ.
"""
import csv
import math
import pathlib
import re
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
MODEL = "maxon_ec45_flat_50w"
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 640, 300, 64, 12, 30, 44
COLOURS = ["#0072b2", "#c46a00", "#00795a", "#9b4f86"]
DASHES = ["", "7 4", "2 3", "9 3 2 3"]
PROGRAM = "omnihil"
commands = []


def sim(excite, effects=(), duration=4.0, noise=0, change=None, options=()):
    """One simulated record as columns, with the speed in rad/s over 10 ms and the angle in turns."""
    with tempfile.TemporaryDirectory() as folder:
        model = MODEL
        if change:
            text = (ROOT / "models/motors" / f"{MODEL}.toml").read_text()
            for key, factor in change.items():
                text = re.sub(rf"({key}\s*=\s*(?:{{\s*value\s*=\s*)?)([-0-9.e]+)", lambda m: m[1] + repr(float(m[2]) * factor), text)
            model = f"{folder}/changed.toml"
            pathlib.Path(model).write_text(text)
        arguments = ["sim", model, "--excite", excite, "--duration", str(duration), "--noise", str(noise), *options]
        for effect in effects:
            arguments += ["--with", effect]
        shown = " ".join(arguments).replace(model, MODEL)
        commands.append("omnihil " + shown + (f"   (model changed: {change})" if change else ""))
        subprocess.run([PROGRAM, *arguments, "--out", f"{folder}/out"], check=True, capture_output=True)
        with open(f"{folder}/out/{excite}.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
    record = {name: [float(row[name]) for row in rows] for name in rows[0]}
    return with_motion(record)


def with_motion(record, window=10):
    t, ticks = record["time_s"], record["ticks"]
    ahead = [min(i + window // 2, len(t) - 1) for i in range(len(t))]
    behind = [max(i - window // 2, 0) for i in range(len(t))]
    record["velocity"] = [2 * math.pi / 4096 * (ticks[a] - ticks[b]) / (t[a] - t[b]) for a, b in zip(ahead, behind)]
    record["angle"] = [x / 4096 for x in ticks]
    return record


def binned(xs, ys, count=24, low=None, high=None):
    """Means of ys over equal ranges of xs, where there are at least five."""
    low, high = min(xs) if low is None else low, max(xs) if high is None else high
    bins = [[] for _ in range(count)]
    for x, y in zip(xs, ys):
        if low <= x <= high:
            bins[min(count - 1, int((x - low) / (high - low) * count))].append(y)
    good = [(low + (i + 0.5) * (high - low) / count, sum(b) / len(b)) for i, b in enumerate(bins) if len(b) >= 5]
    return [g[0] for g in good], [g[1] for g in good]


def difference(a, b, signal="velocity"):
    return [x - y for x, y in zip(a[signal], b[signal])]


def cut(record, low, high):
    keep = [i for i, t in enumerate(record["time_s"]) if low <= t <= high]
    return {name: [values[i] for i in keep] for name, values in record.items()}


def over_time(x_from, x_to, *curves, signal="velocity"):
    """Curves (label, record) of one signal over a stretch of time."""
    return [(label, cut(r, x_from, x_to)["time_s"], cut(r, x_from, x_to)[signal]) for label, r in curves]


SPEED, TIME = "speed, rad/s", "time, s"


def picture_twins():
    a, b, none = sim("ramp", ["friction_asymmetry.coulomb_ratio=0.4"]), sim("ramp", ["constant_load.torque_Nm=-0.00196"]), sim("ramp")
    speed = lambda r: binned(r["velocity"], difference(r, none), 30)
    return "speed, rad/s", "measured minus model, rad/s", [("friction_asymmetry", *speed(a)), ("constant_load", *speed(b))]


def picture_angle():
    a, none = sim("creep", ["cogging.amplitude_Nm=0.002"], 8), sim("creep", (), 8)
    slow = [i for i, v in enumerate(none["velocity"]) if 4 < v < 12]
    d = difference(a, none)
    return "rotor angle within an eighth of a turn, turns", "measured minus model, rad/s", [("cogging", *binned([a["angle"][i] % 0.125 for i in slow], [d[i] for i in slow], 60, 0, 0.125))]


def picture_reversal():
    a, b = sim("chirp", ["actuator_delay.delay_s=0.01"]), sim("chirp")
    return TIME, SPEED, over_time(2.0, 3.0, ("10 ms late", a), ("model", b))


def picture_heating():
    options = ["--amplitude", "0.9"]
    a, b = sim("prbs", ["winding_heating"], 30, options=options), sim("prbs", (), 30, options=options)
    peaks = [i for i, x in enumerate(b["current_A"]) if abs(x) > 8]
    return TIME, "size of current peaks, A", [(label, *binned([b["time_s"][i] for i in peaks], [abs(r["current_A"][i]) for i in peaks], 15)) for label, r in (("measured: the winding grows hot", a), ("model", b))]


def picture_limit():
    a, b = sim("steps", ["current_limit.inverse_current_per_A=0.2"]), sim("steps")
    return TIME, "current, A", over_time(0.75, 1.3, ("measured: flat top at 5 A", a), ("model", b), signal="current_A")


def picture_dead_band():
    a, b = sim("ramp", ["pwm_dead_band.duty=0.08"]), sim("ramp")
    return "duty", SPEED, [(label, *binned(r["duty"], r["velocity"], 50, -0.3, 0.3)) for label, r in (("measured", a), ("model", b))]


def picture_back_emf():
    a, b = sim("steps"), sim("steps", ["back_emf_missing.fraction=1"])
    return TIME, SPEED, over_time(0, 2, ("measured", a), ("equation without the speed factor", b))


def picture_jitter():
    a, b = sim("chirp", ["sample_jitter.sigma_s=0.0008"]), sim("chirp")
    return "speed, rad/s", "size of measured minus model, counts", [(label, *binned([abs(v) for v in b["velocity"]], [abs(x - y) for x, y in zip(r["ticks"], b["ticks"])], 16)) for label, r in (("late by chance", a), ("on time", sim("chirp", noise=1)))]


def picture_scale():
    a = sim("steps")
    half = with_motion({**a, "ticks": [t / 2 for t in a["ticks"]]})
    return TIME, SPEED, over_time(0, 2, ("counts_per_rev twice too large", half), ("model", a))


def picture_sign():
    a = sim("steps")
    swapped = with_motion({**a, "ticks": [-t for t in a["ticks"]]})
    return TIME, SPEED, over_time(0, 2, ("counts with the wrong sign", swapped), ("model", a))


def picture_glitch():
    a = sim("steps")
    ticks = [t + (900 if i in (612, 1340, 1341) else 0) for i, t in enumerate(a["ticks"])]
    return TIME, SPEED, over_time(0, 2, ("three samples off by 900 counts", with_motion({**a, "ticks": ticks}, 2)), ("model", a))


def picture_counts():
    a, b = sim("ramp", ["encoder_missed_counts.probability_per_count=0.01"]), sim("ramp")
    return TIME, "angle, turns", over_time(0, 4, ("counts lost", a), ("model", b), signal="angle")


def picture_saturated():
    a, b = sim("ramp", ["duty_limit.cut=0.6"]), sim("ramp")
    return "duty asked for", SPEED, [(label, *binned(r["duty"], r["velocity"], 50)) for label, r in (("measured: nothing more beyond 0.4", a), ("model", b))]


def picture_stall():
    a, b = sim("creep", ["coulomb_friction.torque_Nm=0.0098"], 16, options=["--amplitude", "0.25"]), sim("creep", (), 16, options=["--amplitude", "0.25"])
    return "duty", SPEED, [(label, *binned(r["duty"], r["velocity"], 60)) for label, r in (("friction doubled", a), ("model", b))]


def picture_floor():
    a = sim("creep", ["cogging.amplitude_Nm=0.0003"], 8)
    one = with_motion(dict(a), 2)
    return TIME, SPEED, over_time(3, 3.3, ("difference of neighbouring counts", one), ("over 10 ms", sim("creep", ["cogging.amplitude_Nm=0.0003"], 8)))


def picture_extrapolation():
    effect = ["current_limit.inverse_current_per_A=0.125"]
    small = [sim("steps", e, options=["--amplitude", "0.2"]) for e in (effect, [])]
    large = [sim("steps", e, options=["--amplitude", "0.9"]) for e in (effect, [])]
    return TIME, "measured minus model, rad/s", [("fit and holdout: small steps", small[0]["time_s"], difference(*small)),
                                                 ("extrapolation: large steps", large[0]["time_s"], difference(*large))]


def picture_masked():
    big, small = "actuator_delay.delay_s=0.005", "stribeck_friction.extra_torque_Nm=0.015"
    none, first, both = (sim("chirp", e, 8, options=["--amplitude", "0.08"]) for e in ([], [big], [big, small]))
    return TIME, "size of measured minus model, rad/s", [(label, *binned(both["time_s"], [abs(x) for x in difference(both, r)], 60)) for label, r in (("model without either", none), ("model with the delay: friction shows", first))]


def picture_wrong_voltage():
    a, b = sim("steps"), sim("steps", change={"nominal_voltage_V": 1.25, "voltage_V": 1.25})
    return TIME, SPEED, over_time(0, 2, ("measured", a), ("model told a quarter too much voltage", b))


def picture_ratio():
    a, b = sim("steps"), sim("steps", change={"torque_constant_Nm_per_A": 1.0, "rotor_inertia_kg_m2": 1.3, "resistance_ohm": 1 / 1.3, "viscous_friction_Nm_s_per_rad": 1.3})
    return TIME, SPEED, over_time(0, 2, ("as it is", a), ("inertia and friction a third larger, resistance smaller", b))


def picture_drift():
    true, nominal = sim("steps", ["current_limit.inverse_current_per_A=0.2"]), sim("steps")
    bent = sim("steps", change={"rotor_inertia_kg_m2": 1.9})
    return TIME, SPEED, over_time(0.78, 0.88, ("measured: current limited", true), ("model", nominal), ("model with 90 % more inertia", bent))


def picture_negative():
    a, b = sim("ramp", change={"torque_constant_Nm_per_A": 0.93}), sim("ramp")
    return "duty", SPEED, [(label, *binned(r["duty"], r["velocity"], 50)) for label, r in (("measured: faster than the model allows", a), ("model", b))]


def picture_imitation():
    a = sim("steps")
    n = 12
    smooth = [sum(a["current_A"][max(0, i - n):i + n + 1]) / len(a["current_A"][max(0, i - n):i + n + 1]) for i in range(len(a["time_s"]))]
    return TIME, "current, A", over_time(0.75, 1.05, ("through a filter of 25 ms", {**a, "current_A": smooth}), ("as it was", a), signal="current_A")


def picture_closed_loop():
    """A controller holds 20 rad/s against cogging: current and speed lie on the controller's line, not on the drive's."""
    gain_A_s, inertia, constant, friction, w, angle, dt = 0.09, 6e-5, 0.0276, 1e-5, 20.0, 0.0, 1e-3
    speeds, currents = [], []
    for _ in range(2000):
        current = gain_A_s * (20.0 - w)
        w += dt / inertia * (constant * current - friction * w + 0.004 * math.sin(12 * angle))
        angle += dt * w
        speeds.append(w)
        currents.append(current)
    low, high = min(speeds[500:]), max(speeds[500:])
    commands.append("a controller I = 0.09 A s (20 rad/s - w) on an inertia with cogging, in this file")
    return "speed, rad/s", "current, A", [("as recorded", speeds[500:], currents[500:]),
                                          ("what friction asks for", [low, high], [friction / constant * x for x in (low, high)])]


def picture_bump():
    formula = ["friction bump at one angle: residual of a record with extra friction between 0.30 and 0.36 turns"]
    none = sim("creep", (), 16)
    xs = [a % 1 for a in none["angle"]]
    ys = [-3.0 * math.exp(-((x - 0.33) / 0.02) ** 2) * math.copysign(1, v) if abs(v) > 1 else 0 for x, v in zip(xs, none["velocity"])]
    commands.extend(formula)
    forward = [i for i, v in enumerate(none["velocity"]) if v > 1]
    backward = [i for i, v in enumerate(none["velocity"]) if v < -1]
    return "rotor angle, turns", "measured minus model, rad/s", [(label, *binned([xs[i] for i in at], [ys[i] for i in at], 80, 0, 1)) for label, at in (("forwards", forward), ("backwards", backward))]


def ticks_of(low, high):
    step = 10 ** math.floor(math.log10((high - low) / 4))
    step *= next(m for m in (1, 2, 5, 10) if (high - low) / (m * step) <= 6)
    return [k * step for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def text_of(value):
    return f"{value:.6g}".replace("-", "−")


def thinned(points, most=700):
    """Least and greatest of each stretch, so that a spike stays."""
    step = max(1, 2 * len(points) // most)
    if step < 3:
        return points
    kept = []
    for i in range(0, len(points), step):
        part = range(i, min(i + step, len(points)))
        kept += [points[k] for k in sorted({min(part, key=lambda k: points[k][1]), max(part, key=lambda k: points[k][1])})]
    return kept


def svg(x_label, y_label, curves):
    xs = [x for c in curves for x in c[1]]
    ys = [y for c in curves for y in c[2]]
    x0, x1 = min(xs), max(xs)
    y0, y1 = min(ys + [0]), max(ys + [0])
    y0, y1 = y0 - 0.05 * (y1 - y0), y1 + 0.05 * (y1 - y0)
    px = lambda x: LEFT + (x - x0) / (x1 - x0) * (WIDTH - LEFT - RIGHT)
    py = lambda y: HEIGHT - BOTTOM - (y - y0) / (y1 - y0) * (HEIGHT - TOP - BOTTOM)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="Helvetica, Arial, sans-serif" font-size="12">']
    out += ["<desc>" + "\n".join(commands).replace("&", "&amp;").replace("<", "&lt;") + "</desc>", f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>']
    for x in ticks_of(x0, x1):
        out.append(f'<path d="M{px(x):.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="#e2e4e8"/><text x="{px(x):.1f}" y="{HEIGHT - BOTTOM + 16}" text-anchor="middle">{text_of(x)}</text>')
    for y in ticks_of(y0, y1):
        out.append(f'<path d="M{LEFT} {py(y):.1f}H{WIDTH - RIGHT}" stroke="#e2e4e8"/><text x="{LEFT - 6}" y="{py(y) + 4:.1f}" text-anchor="end">{text_of(y)}</text>')
    at = LEFT
    for (label, cx, cy), colour, dash in zip(curves, COLOURS, DASHES):
        path = " ".join(f"{px(x):.1f},{py(y):.1f}" for x, y in thinned(list(zip(cx, cy))))
        out.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1.6" stroke-dasharray="{dash or "none"}"/>')
        out.append(f'<path d="M{at} 15h24" stroke="{colour}" stroke-width="2" stroke-dasharray="{dash or "none"}"/><text x="{at + 29}" y="19">{label}</text>')
        at += 50 + 6.2 * len(label)
    out.append(f'<text x="{(LEFT + WIDTH) / 2}" y="{HEIGHT - 8}" text-anchor="middle">{x_label}</text>')
    out.append(f'<text transform="translate(14 {(TOP + HEIGHT - BOTTOM) / 2}) rotate(-90)" text-anchor="middle">{y_label}</text>')
    return "\n".join(out) + "\n</svg>\n"


def same(a, b):
    number = re.compile(r"-?\d+\.?\d*")
    if number.sub("#", a) != number.sub("#", b):
        return False
    return all(abs(float(x) - float(y)) <= 1.0 for x, y in zip(number.findall(a), number.findall(b)))


def main():
    global PROGRAM
    arguments = sys.argv[1:]
    check = arguments[:1] == ["--check"]
    arguments = arguments[check:]
    if not arguments:
        print(__doc__)
        return 2
    PROGRAM = arguments[0]
    drawings = {n.removeprefix("picture_").replace("_", "-"): f for n, f in globals().items() if n.startswith("picture_")}
    differ = []
    for name in arguments[1:] or drawings:
        commands.clear()
        text, path = svg(*drawings[name]()), HERE / "img" / f"{name}.svg"
        if not check:
            path.write_text(text, encoding="utf-8")
        elif not path.exists() or not same(text, path.read_text(encoding="utf-8")):
            differ.append(name)
    if differ:
        print("not as drawn today: " + ", ".join(differ))
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
