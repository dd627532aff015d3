"""Excitations: what a person drives an axis with. One pool for records with and without a hidden effect.

Each takes (random source, rows, seconds per row) and gives the asked duty of every row, from rest at zero.
"""
import math


def steps(rng, n, dt):
    """Steps of several sizes, held for 0.3 to 1.5 s."""
    out = [0.0] * round(0.2 / dt)
    while len(out) < n:
        size = rng.choice((0.15, 0.3, 0.45, 0.6, 0.75)) * rng.uniform(0.85, 1.15) * rng.choice((-1, 1, 1))
        out += [0.0 if rng.random() < 0.12 else size] * round(rng.uniform(0.3, 1.5) / dt)
    return out[:n]


def stairs(rng, n, dt):
    """A staircase over the whole range, up and down, both ways."""
    top = rng.uniform(0.75, 0.95)
    count = rng.choice((8, 10, 12))
    levels = [top * math.sin(2 * math.pi * (k + 0.5) / (2.5 * count)) for k in range(round(2.5 * count))]
    hold = max(1, n // len(levels))
    return ([level for level in levels for _ in range(hold)] + [0.0] * n)[:n]


def slow(rng, n, dt):
    """Slow ramps through zero, both ways, small duties."""
    top = rng.uniform(0.05, 0.10)
    period_s = rng.uniform(4, 7)
    out = []
    for k in range(n):
        phase = (k * dt / period_s) % 1
        out.append(top * (4 * phase if phase < 0.25 else 2 - 4 * phase if phase < 0.75 else 4 * phase - 4))
    return [x * (1 + 0.8 * (k * dt // period_s)) for k, x in enumerate(out)]


def creep(rng, n, dt):
    """Slow constant speeds, low duties held for a second or two, both ways."""
    out = [0.0] * round(0.1 / dt)
    while len(out) < n:
        size = rng.choice((0.03, 0.045, 0.06, 0.08, 0.12)) * rng.uniform(0.9, 1.1) * rng.choice((-1, 1))
        out += [size] * round(rng.uniform(0.8, 1.8) / dt)
    return out[:n]


def chirp(rng, n, dt):
    """A sine from 0.3 to 40 Hz, logarithmic, twice, on a small bias."""
    f0, f1, half = 0.3, rng.uniform(25, 60), n * dt / 2
    rate = math.log(f1 / f0) / half
    amplitude, bias = rng.uniform(0.3, 0.6), rng.uniform(-0.15, 0.15)
    out = []
    for k in range(n):
        t = (k * dt) % half
        out.append(bias + amplitude * math.sin(2 * math.pi * f0 * (math.exp(rate * t) - 1) / rate))
    return out


def prbs(rng, n, dt):
    """A pseudo-random binary sequence around slowly moving levels."""
    out, level, high = [], 0.0, True
    while len(out) < n:
        if rng.random() < 0.02:
            level = rng.uniform(-0.3, 0.3)
        high = not high
        out += [level + (0.3 if high else -0.3)] * max(
            1, round(rng.choice((0.01, 0.02, 0.05, 0.1, 0.2)) / dt)
        )
    return out[:n]


def shuttle(rng, n, dt):
    """Hard work: reversals several times a second with pauses, which heats; small steps between."""
    rate = rng.uniform(2.5, 5)
    amplitude = rng.uniform(0.3, 0.45)
    out = []
    while len(out) < n:
        work_s = rng.uniform(3, 5)
        out += [amplitude * (1 if (k * dt * rate) % 1 < 0.5 else -1) for k in range(round(work_s / dt))]
        out += [rng.choice((0.2, -0.2, 0.5))] * round(0.5 / dt) + [0.0] * round(rng.uniform(0.3, 1) / dt)
    return out[:n]


def hard(rng, n, dt):
    """Hard steps up to full duty."""
    out = [0.0] * round(0.1 / dt)
    while len(out) < n:
        size = rng.choice((0.3, 0.6, 0.9, 1.0)) * rng.choice((-1, 1))
        out += [size] * round(rng.uniform(0.15, 0.7) / dt) + [0.0] * round(rng.choice((0, 0.2, 0.4)) / dt)
    return out[:n]


def to_the_top(rng, n, dt):
    """Ramps to full duty and back, both ways."""
    period_s = rng.uniform(5, 9)
    top = rng.uniform(0.97, 1.0)
    return [
        top * max(-1.0, min(1.0, 1.15 * math.asin(math.sin(2 * math.pi * k * dt / period_s)) * 2 / math.pi))
        for k in range(n)
    ]


def reversals(rng, n, dt):
    """Small reversals at several rates."""
    out = []
    while len(out) < n:
        f, a = rng.choice((1, 2, 4, 7, 11)), rng.uniform(0.06, 0.25)
        m = round(rng.choice((1, 2)) / dt)
        square = rng.random() < 0.4
        wave = [math.sin(2 * math.pi * f * k * dt) for k in range(m)]
        out += [a * (math.copysign(1, x) if square else x) for x in wave]
    return out[:n]


def mixed(rng, n, dt):
    """A bit of everything: the record somebody takes who does not know what to look for."""
    parts = (steps, chirp, creep, prbs)
    quarter = n // 4
    out = []
    for part in parts:
        out += part(rng, quarter, dt)
    return (out + [0.0] * n)[:n]


POOL = {
    f.__name__: f
    for f in (steps, stairs, slow, creep, chirp, prbs, shuttle, hard, to_the_top, reversals, mixed)
}
PLAIN = {name: f.__doc__.rstrip(".").split(",")[0].lower() for name, f in POOL.items()}


# Targets of a position servo, rad.
def position_steps(rng, n, dt):
    """Position steps of several sizes."""
    out = [0.0] * round(0.3 / dt)
    while len(out) < n:
        out += [rng.choice((0.1, 0.3, 0.8, 1.5, 2.5)) * rng.choice((-1, 1))] * round(
            rng.uniform(0.5, 1.4) / dt
        )
    return out[:n]


def position_sines(rng, n, dt):
    """Position sines of growing frequency."""
    f = rng.uniform(0.25, 0.5)
    a, b = rng.uniform(0.5, 1.0), rng.uniform(0.2, 0.5)
    return [
        a * math.sin(2 * math.pi * f * k * dt) + b * math.sin(2 * math.pi * f * (2 + 0.15 * k * dt) * k * dt)
        for k in range(n)
    ]


def position_mixed(rng, n, dt):
    """Position sines, then steps."""
    return (position_sines(rng, n // 2, dt) + position_steps(rng, n - n // 2, dt))[:n]


SERVO_POOL = {f.__name__: f for f in (position_steps, position_sines, position_mixed)}


# Targets of a speed loop, rad/s.
def speed_targets(rng, n, dt):
    """Speed targets, held."""
    out = [0.0] * round(0.2 / dt)
    while len(out) < n:
        size = rng.choice((4, 10, 30, 80, 160, 240)) * rng.choice((-1, 1))
        out += [size] * round(rng.uniform(0.6, 2) / dt)
    return out[:n]


LOOP_POOL = {"speed_targets": speed_targets}
