"""Drives: how a person moves a robot over the floor to record it. Targets in the body's frame, ramped, as open-loop duties.

All stay below the grip of an ordinary tyre most of the time: a robot that spins out amplifies every difference.
"""
import math

ANGLES = (55, 135, 225, 305)


def _ramped(targets, n, limits):
    """targets: [(rows, (vx, vy, w))]; ramps of at most `limits` per row."""
    out, v = [], [0.0, 0.0, 0.0]
    for rows, target in targets:
        for _ in range(rows):
            for j in range(3):
                v[j] += max(-limits[j], min(limits[j], target[j] - v[j]))
            out.append(tuple(v))
    return (out + [(0.0, 0.0, 0.0)] * n)[:n]


def _limits(dt, a=2.0, alpha=14.0):
    return (a * dt, a * dt, alpha * dt)


def _within(vx, vy, w, most=2.5):
    """The twist with its turning cut so that the curve it drives needs at most `most` m/s^2 of grip."""
    v = math.hypot(vx, vy)
    limit = most / v if v > 0 else abs(w)
    return vx, vy, max(-limit, min(limit, w))


def random_drive(rng, n, dt):
    """Random drive."""
    legs = [
        (
            round(rng.uniform(0.5, 1.2) / dt),
            _within(rng.uniform(-1.4, 1.4), rng.uniform(-1.4, 1.4), rng.uniform(-4, 4)),
        )
        for _ in range(40)
    ]
    return _ramped([(round(0.2 / dt), (0, 0, 0))] + legs, n, _limits(dt))


def directions(rng, n, dt):
    """Straight legs in many directions, there and back, and turns on the spot."""
    legs = [(round(0.2 / dt), (0, 0, 0))]
    start = rng.uniform(0, 2 * math.pi)
    for k in range(16):
        a, v = start + k * math.pi / 8, rng.choice((0.4, 0.8, 1.3))
        rows = round(rng.uniform(0.8, 1.1) / dt)
        legs += [
            (rows, (v * math.cos(a), v * math.sin(a), 0)),
            (rows, (-v * math.cos(a), -v * math.sin(a), 0)),
        ]
        if k % 4 == 3:
            legs += [(round(0.8 / dt), (0, 0, rng.choice((-5, 5))))]
    return _ramped(legs, n, _limits(dt))


def hard_starts(rng, n, dt):
    """Hard starts and stops."""
    legs = [(round(0.2 / dt), (0, 0, 0))]
    for _ in range(40):
        a, v = rng.uniform(0, 2 * math.pi), rng.uniform(0.8, 1.8)
        legs += [
            (
                round(rng.uniform(0.4, 0.7) / dt),
                _within(v * math.cos(a), v * math.sin(a), rng.choice((0, 0, -6, 6))),
            ),
            (round(rng.uniform(0.2, 0.5) / dt), (0, 0, 0)),
        ]
    return _ramped(legs, n, _limits(dt, 3.0, 16))


def crawl(rng, n, dt):
    """Slow drives."""
    legs = [(round(0.2 / dt), (0, 0, 0))]
    for _ in range(30):
        a, v = rng.uniform(0, 2 * math.pi), rng.choice((0.06, 0.1, 0.16, 0.25))
        legs += [
            (round(rng.uniform(1, 2) / dt), (v * math.cos(a), v * math.sin(a), rng.choice((0, 0, -0.8, 0.8))))
        ]
    return _ramped(legs, n, _limits(dt))


def mixed_drive(rng, n, dt):
    """A bit of everything."""
    third = n // 3
    return random_drive(rng, third, dt) + hard_starts(rng, third, dt) + crawl(rng, n - 2 * third, dt)


POOL = {f.__name__: f for f in (random_drive, directions, hard_starts, crawl, mixed_drive)}
PLAIN = {name: f.__doc__.rstrip(".").split(",")[0].lower() for name, f in POOL.items()}


def duties(twists, believed, angles=ANGLES):
    """Open loop: the duty that would hold each wheel's speed without load, by what the owner believes, and a bit for friction."""
    k, volt, gear, r, base = (believed[x] for x in ("flux_Vs", "supply_V", "gear", "wheel_m", "base_m"))
    lift = believed["dry_Nm"] / believed["flux_Vs"] * believed["resistance_ohm"] / volt
    out = []
    for vx, vy, w in twists:
        row = []
        for a in angles:
            a = math.radians(a)
            rim = -math.sin(a) * vx + math.cos(a) * vy + base * w
            row.append(round(rim / r * gear * k / volt + lift * math.tanh(rim / 0.02), 6))
        out.append(row)
    return out


def dribbler(rng, n, dt, used):
    """Speed of the dribbler, switched on and off; zero throughout where it is not used."""
    out, on = [], False
    while len(out) < n:
        out += [rng.uniform(150, 300) if on and used else 0.0] * round(rng.uniform(1, 3) / dt)
        on = not on
    return [round(x, 2) for x in out[:n]]
