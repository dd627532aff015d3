"""What no list of effects has: the right answer is that structure remains which nothing known explains."""
import hashlib

import axis_case
import robot_case
from axis_effects import BY_ID, EFFECTS, same_law, size_range
from axis_rig import draw_rig
from excitation import POOL
from share import Ruler, hidden_at, size_for

# name: (plant parameters for a size, least and largest size relative to the bench, excitations that show it, gear)
KINDS = {
    "belt_seam": (
        lambda m, r: {"seam_Nm": m * r.believed["gear"], "seam_turns": 3.37},
        (3e-4, 0.2),
        ("stairs", "steps", "slow"),
        None,
    ),
    "friction_bump": (lambda m, r: {"bump_Nm": m}, (3e-4, 3e-2), ("creep", "slow", "stairs"), None),
    "run_in": (
        lambda m, r: {"run_in_ratio": m / r.torque_scale, "run_in_rad": 900},
        (0.1, 6.0),
        ("stairs", "steps", "slow"),
        None,
    ),
    "jumping_contact": (
        lambda m, r: {"contact_ohm": m * r.believed["resistance_ohm"] / r.torque_scale, "contact_s": 0.4},
        (0.02, 1.5),
        ("steps", "hard", "chirp"),
        None,
    ),
    "supply_ripple": (
        lambda m, r: {"hum_V": m / r.torque_scale, "hum_Hz": 17.3},
        (0.02, 3.0),
        ("steps", "stairs", "hard"),
        None,
    ),
    "hysteretic_hub": (
        lambda m, r: {"hub_Nm": m, "hub_rad": 2.0},
        (3e-4, 2e-2),
        ("reversals", "slow", "creep"),
        None,
    ),
    "firmware_notch": (
        lambda m, r: {"notch_Hz": 14.0, "notch_width": m / r.torque_scale},
        (0.02, 1.5),
        ("chirp", "prbs", "reversals"),
        None,
    ),
    "cable_spring": (
        lambda m, r: {"cable_Nm_per_rad": 1e-2 * m * r.believed["gear"] ** 2},
        (1e-3, 1.0),
        ("reversals", "chirp", "creep"),
        None,
    ),
}
ROWS_WITH_AN_EFFECT = 8000
ROBOT_KINDS = {
    "floor_nap": {"nap": 0.03, "nap_towards": 0.8},
    "jumping_contact_of_a_wheel": {"contact_ohm": 1.2, "contact_s": 0.4},
}


def names():
    """In the order cases go round them."""
    return list(KINDS) + list(ROBOT_KINDS)


def needs_of(kind):
    return "bus hidden" if kind == "supply_ripple" else "not heated"


def sized(kind, rig, ruler, share):
    """(plant parameters, what the answer says of it) of a kind at the size at which it takes about this share."""
    hide, limits, _, _ = KINDS[kind]
    low, high = (x * rig.torque_scale for x in limits)
    size, reached = size_for(ruler, lambda m: hide(m, rig), (low, high), share)
    return hide(size, rig), {"kind": kind, "size": size, "share": reached}


def make_case(folder, key, kind, share=0.7):
    if kind in ROBOT_KINDS:
        answer = robot_case.make_case(folder, key, [], 0, ROBOT_KINDS[kind])
        return {**answer, "outside": {"kind": kind}}
    _, _, shows, gear = KINDS[kind]
    rng = axis_case.source(*key)
    rig = draw_rig(rng, "drive", gear, [needs_of(kind)])
    kinds = axis_case.draw_kinds(rng, [k for k in shows if k in POOL], rig, False)
    asked = axis_case.asked_of(axis_case.source(*key, "run", "fit"), kinds[0])
    hidden, outside = sized(kind, rig, Ruler(rig, asked), share)
    axis_case.write_case(folder, rig, kinds, hidden, key)
    return {**axis_case.answer_of(rig, kinds, []), "outside": outside}


def with_an_effect():
    """(effect, kind) of one bench, in a fixed order that mixes them: what is recorded of real drives has both."""

    def fits(effect, kind):
        return "drive" in effect.rigs and not {"heating", "not heated"} <= {needs_of(kind), *effect.needs}

    both = [(e.id, kind) for e in EFFECTS for kind in KINDS if fits(e, kind)]
    return sorted(both, key=lambda pair: hashlib.sha256("/".join(pair).encode()).hexdigest())


def energy_share(rng, least, most):
    """E / (E + 1) of an energy over the noise's that is drawn evenly in its logarithm."""
    energy = least * (most / least) ** rng.random()
    return energy / (energy + 1.0)


def make_case_with_an_effect(folder, key, effect_id, kind):
    """One effect of the list, of 1 to 100 times the noise's energy, and beside it what no list has, of 0.3 to 50 times.
    Runs of 8 s, as measured ones are."""
    rng, effect = axis_case.source(*key), BY_ID[effect_id]
    needs = [*effect.needs, needs_of(kind)]
    rig = draw_rig(rng, "drive", rng.choice(effect.gears) if effect.gears else None, list(dict.fromkeys(needs)))
    both = "+".join((rng.choice(effect.shows), rng.choice([k for k in KINDS[kind][2] if k in POOL])))
    kinds = (both, both, rng.choice(list(POOL)))
    asked = axis_case.asked_of(axis_case.source(*key, "run", "fit"), both, ROWS_WITH_AN_EFFECT)
    ruler = Ruler(rig, asked)
    hidden, answer = hidden_at(
        effect, effect.shape(rng, rig), rig, ruler, size_range(effect, rig), energy_share(rng, 1, 100), same_law(effect, rig)
    )
    strange, outside = sized(kind, rig, ruler, energy_share(rng, 0.3, 50))
    axis_case.write_case(folder, rig, kinds, {**hidden, **strange}, key, rows=ROWS_WITH_AN_EFFECT)
    return {**axis_case.answer_of(rig, kinds, [answer]), "outside": outside}
