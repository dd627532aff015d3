"""How large a hidden effect is: the share of a record's residual energy that no refit of the base parameters removes.

residual energy of a signal = mean square over its sensor's variance (1 for a perfect model); share = E / (E + noise), where
E is what the effect adds to the noise-free record, less what small changes of the base parameters, held by the
tolerances their owner states, would explain.
"""
import math
import random

import plant
from axis_rig import base_parameters, speed_noise


def quiet(params):
    """The same bench with sensors that add nothing of their own."""
    out = dict(params, current_noise_A=0.0, bus_noise_V=0.0, speed_noise_rad_s=0.0, angle_noise_rad=0.0)
    out["step_s"] = min(50e-6, params.get("step_s", 50e-6))
    if params.get("lost_per_count", 0) == 0:
        out["encoder_cpr"] = 1e7
    if params.get("current_cap_A", 0) > 0 or params.get("derating_A_per_K", 0) > 0:
        out["step_s"] = min(25e-6, out["step_s"])
    return out


def signals_of(params, rig, asked):
    """Noise-free compared signals of one record, each over its sensor's 1-sigma, and how many they are."""
    clean = quiet(params)
    raw, _ = plant.run_axis(clean, asked)
    seen = plant.sense_axis(clean, raw, 1)
    out = []
    if rig.sensors.get("encoder"):
        scale = 2 * math.pi / clean["encoder_cpr"] / 1e-3 / speed_noise(rig)
        counts = seen["counts"]
        out += [0.0] + [(b - a) * scale for a, b in zip(counts, counts[1:])]
    if rig.sensors.get("velocity"):
        sigma = rig.true["speed_noise_rad_s"]
        out += [x / sigma for x in seen["speed"]]
    if rig.sensors.get("current"):
        sigma = math.hypot(rig.true["current_noise_A"], 0.01 / math.sqrt(12))
        out += [x / sigma for x in seen["current"]]
    return out, len(out) // len(asked)


def solve(matrix, right):
    """Gauss with pivots; small systems."""
    n = len(right)
    rows = [list(row) + [right[k]] for k, row in enumerate(matrix)]
    for k in range(n):
        pivot = max(range(k, n), key=lambda j: abs(rows[j][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for j in range(k + 1, n):
            factor = rows[j][k] / rows[k][k]
            rows[j] = [a - factor * b for a, b in zip(rows[j], rows[k])]
    out = [0.0] * n
    for k in reversed(range(n)):
        out[k] = (rows[k][n] - sum(rows[k][j] * out[j] for j in range(k + 1, n))) / rows[k][k]
    return out


class Ruler:
    """Measures effects on one bench and one excitation."""

    def __init__(self, rig, asked, params=None):
        self.rig, self.asked = rig, asked
        self.params = dict(params or rig.true)
        self.base, self.signals = signals_of(self.params, rig, asked)
        self.columns, self.tolerances = [], []
        for name, tolerance in base_parameters(rig).items():
            value = self.params[name]
            if value == 0:
                continue
            moved, _ = signals_of(dict(self.params, **{name: value * (1 + 0.1 * tolerance)}), rig, asked)
            self.columns.append([(b - a) * 10 for a, b in zip(self.base, moved)])  # per one tolerance
            self.tolerances.append(tolerance)
        self.gram = plant.inner_products(self.columns)

    def share(self, hidden):
        """Share of the residual energy of an effect given as plant parameters."""
        n = len(self.asked)
        changed, _ = signals_of({**self.params, **hidden}, self.rig, self.asked)
        difference = [b - a for a, b in zip(self.base, changed)]
        total = sum(x * x for x in difference)
        if not math.isfinite(total):
            return 1.0
        products = [sum(a * b for a, b in zip(column, difference)) for column in self.columns]
        held = [[v + (j == k) for j, v in enumerate(row)] for k, row in enumerate(self.gram)]
        moves = solve(held, products)
        left = (
            total
            - 2 * sum(m * p for m, p in zip(moves, products))
            + sum(a * b * self.gram[j][k] for j, a in enumerate(moves) for k, b in enumerate(moves))
        )
        energy = max(0.0, left) / n
        return energy / (energy + self.signals)


def size_for(ruler, hide, limits, share):
    """The size at which an effect takes about this share, or the limit that comes closest; with the share reached."""
    low, high = limits
    below, above = low, high  # the wanted size lies between, as far as is known
    size, best, goal = math.sqrt(low * high), None, share / (1 - share)
    for _ in range(7):
        reached = min(ruler.share(hide(size)), 1 - 1e-9)
        energy = max(reached, 1e-9) / (1 - reached)
        miss = abs(math.log(energy / goal))
        if best is None or miss < best[2]:
            best = (size, reached, miss)
        if miss < 0.2:
            break
        if energy < goal:
            below = size
        else:
            above = size
        following = min(high, max(low, size * math.sqrt(goal / energy)))
        if not below < following < above and not (following in (low, high) and following != size):
            following = math.sqrt(below * above)
        if following == size:
            break
        size = following
    return best[:2]


def hidden_at(effect, shape, bench, ruler, limits, share, same_law):
    """(plant parameters, answer) of an effect at the size, within the limits, at which it takes about this share."""
    size, reached = size_for(ruler, lambda m: effect.hide(m, shape, bench), limits, share)
    return effect.hide(size, shape, bench), {
        "id": effect.id,
        "same_law": list(same_law),
        "size": size,
        "share": reached,
        "parameters": effect.oracle(size, shape, bench),
        "equal_law": list(effect.equal_law),
    }


def spread_share(rng: random.Random, index):
    """Around 5, 15 and 50 % and above, in turn; one in eight below the limit from which an effect is to be named."""
    return (0.18, 0.5, 0.05, 0.25, 0.7, 0.18, 0.5, 0.9)[index % 8] * rng.uniform(0.95, 1.1)
