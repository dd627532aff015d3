"""What no list of effects has: the right answer is that structure remains which nothing known explains."""
import axis_case
import robot_case
from axis_rig import draw_rig
from excitation import POOL
from share import Ruler, size_for

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
ROBOT_KINDS = {
    "floor_nap": {"nap": 0.03, "nap_towards": 0.8},
    "jumping_contact_of_a_wheel": {"contact_ohm": 1.2, "contact_s": 0.4},
}


def names():
    """In the order cases go round them."""
    return list(KINDS) + list(ROBOT_KINDS)


def make_case(folder, key, kind, share=0.7):
    if kind in ROBOT_KINDS:
        answer = robot_case.make_case(folder, key, [], 0, ROBOT_KINDS[kind])
        return {**answer, "outside": {"kind": kind}}
    hide, limits, shows, gear = KINDS[kind]
    rng = axis_case.source(*key)
    needs = ["bus hidden"] if kind == "supply_ripple" else ["not heated"]
    rig = draw_rig(rng, "drive", gear, needs)
    kinds = axis_case.draw_kinds(rng, [k for k in shows if k in POOL], rig, False)
    asked = axis_case.asked_of(axis_case.source(*key, "run", "fit"), kinds[0])
    low, high = (x * rig.torque_scale for x in limits)
    size, reached = size_for(Ruler(rig, asked), lambda m: hide(m, rig), (low, high), share)
    axis_case.write_case(folder, rig, kinds, hide(size, rig), key)
    return {**axis_case.answer_of(rig, kinds, []), "outside": {"kind": kind, "size": size, "share": reached}}
