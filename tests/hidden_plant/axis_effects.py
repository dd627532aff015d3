"""What can be hidden in an axis, effect by effect: how it is put into the plant, at which sizes, and what shows it.

Ids and parameter names are those of the catalogue; the laws in the plant are our own and mostly of another form.
"""
import math

from axis_effect import Effect
from axis_filters import FILTERS

TURN = 2 * math.pi


def _phase(rng, rig):
    return {"phase": rng.uniform(0, TURN)}


def _cogging_shape(rng, rig):
    poles = 2 * rig.believed["pole_pairs"]
    return {
        "phase": rng.uniform(0, TURN),
        "phase2": rng.uniform(0, TURN),
        "phase3": rng.uniform(0, TURN),
        "order": math.lcm(int(poles), rig.slots),
        "order3": rng.choice((rig.slots, int(poles))),
    }


def _heat_parameters(size, shape, rig):
    # The size is how much smaller the winding's heat capacity is than the data sheet's.
    return {
        "copper_per_K": 0.00393,
        "winding_J_per_K": rig.believed["winding_J_per_K"] / size,
        "housing_J_per_K": rig.believed["housing_J_per_K"] / size,
    }


def _heat_oracle(size, shape, rig):
    b = rig.believed
    return {
        "temperature_coefficient_per_K": 0.00393,
        "thermal_resistance_K_per_W": b["winding_K_per_W"],
        "thermal_capacity_J_per_K": b["winding_J_per_K"] / size,
        "housing_thermal_resistance_K_per_W": b["housing_K_per_W"],
        "housing_thermal_capacity_J_per_K": b["housing_J_per_K"] / size,
    }


EFFECTS = [
    Effect(
        "coulomb_friction",
        (1e-4, 1e-2),
        scale="torque",
        needs=("no dry friction",),
        equal_law=("torque_Nm",),
        shows=("slow", "creep", "steps"),
        hide=lambda m, s, r: {"dry_Nm": m},
        oracle=lambda m, s, r: {"torque_Nm": m},
    ),
    Effect(
        "stribeck_friction",
        (0.1, 1.5),
        shows=("slow", "creep", "reversals"),
        rigs=("drive", "drive", "servo"),
        shape=lambda rng, r: {"speed": rng.uniform(3, 15) * (1 if r.kind == "drive" else 0.05)},
        hide=lambda m, s, r: {
            "bristles": 1,
            "bristle_Nm_per_rad": 30 * r.torque_scale,
            "bristle_damping_Nms": 0.03 * r.torque_scale,
            "breakaway_ratio": m,
            "breakaway_rad_s": s["speed"],
        },
        oracle=lambda m, s, r: {
            "extra_torque_Nm": m * r.true["dry_Nm"],
            "speed_rad_s": s["speed"],
            "exponent": 2.0,
        },
        equal_law=("extra_torque_Nm",),
        same=("lugre_friction",),
    ),
    Effect(
        "lugre_friction",
        (0.2, 1.5),
        shows=("slow", "creep", "reversals"),
        shape=lambda rng, r: {"speed": rng.uniform(4, 15), "stiff": rng.uniform(0.3, 1.0)},
        hide=lambda m, s, r: {
            "bristles": 1,
            "bristle_Nm_per_rad": s["stiff"] * r.torque_scale,
            "bristle_damping_Nms": 0.005 * r.torque_scale,
            "breakaway_ratio": m,
            "breakaway_rad_s": s["speed"],
        },
        oracle=lambda m, s, r: {
            "coulomb_torque_Nm": r.true["dry_Nm"],
            "static_torque_Nm": (1 + m) * r.true["dry_Nm"],
            "stribeck_speed_rad_s": s["speed"],
            "stiffness_Nm_per_rad": s["stiff"] * r.torque_scale,
            "damping_Nm_s_per_rad": 0.005 * r.torque_scale,
        },
        same=("stribeck_friction",),
    ),
    Effect(
        "friction_asymmetry",
        (0.02, 0.7),
        shows=("stairs", "steps", "slow"),
        shape=lambda rng, r: {"way": rng.choice((-1, 1)), "viscous": rng.uniform(0.8, 1.4)},
        hide=lambda m, s, r: {
            "dry_direction": s["way"] * m,
            "viscous_direction": s["way"] * min(0.9, m * s["viscous"]),
        },
        oracle=lambda m, s, r: {
            "coulomb_ratio": s["way"] * m,
            "viscous_ratio": s["way"] * min(0.9, m * s["viscous"]),
        },
        equal_law=("coulomb_ratio", "viscous_ratio"),
    ),
    Effect(
        "load_dependent_friction",
        (0.005, 0.4),
        shows=("steps", "shuttle", "hard"),
        gears=(3.0, 5.0),
        hide=lambda m, s, r: {"loaded_ratio": m},
        same=("gear_efficiency",),
        oracle=lambda m, s, r: {"drive_fraction": m, "backdrive_fraction": 0.0},
        equal_law=("drive_fraction",),
    ),
    Effect(
        "gear_efficiency",
        (0.005, 0.35),
        shows=("steps", "shuttle", "hard"),
        gears=(3.0, 5.0),
        rigs=("drive", "drive", "drive", "servo"),
        hide=lambda m, s, r: {"gear_loss": m},
        same=("load_dependent_friction",),
        oracle=lambda m, s, r: {"loss_fraction": m},
        equal_law=("loss_fraction",),
    ),
    Effect(
        "quadratic_drag",
        (2e-4, 3e-2),
        scale="torque",
        shows=("stairs", "to_the_top", "steps"),
        shape=lambda rng, r: {"power": rng.choice((2.0, 2.0, 1.85, 2.15))},
        hide=lambda m, s, r: {"drag_Nm": m, "drag_power": s["power"]},
        oracle=lambda m, s, r: {"coefficient_Nm_s2_per_rad2": m / 300**2},
        equal_law=("coefficient_Nm_s2_per_rad2",),
    ),
    Effect(
        "cogging",
        (2e-4, 1.2e-2),
        scale="torque",
        shows=("creep", "slow", "stairs"),
        shape=_cogging_shape,
        hide=lambda m, s, r: {
            "cog_Nm": m,
            "cog_order": s["order"],
            "cog_phase": s["phase"],
            "cog2_Nm": 0.12 * m,
            "cog2_order": 2 * s["order"],
            "cog2_phase": s["phase2"],
            "cog3_Nm": 0.2 * m,
            "cog3_order": s["order3"],
            "cog3_phase": s["phase3"],
        },
        oracle=lambda m, s, r: {"amplitude_Nm": m, "order": float(s["order"]), "phase_rad": s["phase"]},
        equal_law=("amplitude_Nm",),
    ),
    Effect(
        "torque_ripple",
        (0.003, 0.15),
        shows=("steps", "stairs", "shuttle"),
        shape=_phase,
        hide=lambda m, s, r: {
            "ripple": m,
            "ripple2": 0.15 * m,
            "ripple_order": 6 * r.believed["pole_pairs"],
            "ripple_phase": s["phase"],
        },
        oracle=lambda m, s, r: {
            "fraction": m,
            "order": 6.0 * r.believed["pole_pairs"],
            "phase_rad": s["phase"],
        },
        equal_law=("fraction",),
    ),
    Effect(
        "winding_heating",
        (0.005, 4.0),
        shows=("shuttle", "hard", "prbs"),
        hide=_heat_parameters,
        oracle=_heat_oracle,
        needs=("not heated",),
    ),
    Effect(
        "magnet_weakening",
        (1e-4, 3e-3),
        shows=("shuttle", "hard", "prbs"),
        needs=("heating",),
        shape=lambda rng, r: {"share": rng.uniform(0.6, 0.9)},
        hide=lambda m, s, r: {"magnet_per_K": m, "magnet_share": s["share"]},
        oracle=lambda m, s, r: {"coefficient_per_K": m * s["share"]},
        equal_law=("coefficient_per_K",),
    ),
    Effect(
        "saturation",
        (0.1, 2.5),
        scale="stall",
        shows=("hard", "shuttle", "steps"),
        hide=lambda m, s, r: {"knee_A": 1 / m},
        oracle=lambda m, s, r: {"inverse_current_per_A": m / math.sqrt(3)},
    ),
    Effect(
        "dead_time",
        (0.01, 0.9),
        shows=("creep", "slow", "steps"),
        shape=lambda rng, r: {"width": rng.uniform(0.08, 0.3)},
        hide=lambda m, s, r: {"edge_V": m, "edge_A": s["width"]},
        oracle=lambda m, s, r: {"voltage_V": m, "current_width_A": s["width"]},
        equal_law=("voltage_V",),
    ),
    Effect(
        "pwm_dead_band",
        (0.003, 0.09),
        shows=("slow", "creep", "reversals"),
        hide=lambda m, s, r: {"coast_band": m},
        oracle=lambda m, s, r: {"duty": m},
        equal_law=("duty",),
    ),
    Effect(
        "battery_sag",
        (0.002, 0.25),
        shows=("hard", "steps", "shuttle"),
        needs=("bus hidden",),
        hide=lambda m, s, r: {
            "battery_ohm": m,
            "battery_rc_ohm": 0.3 * m,
            "battery_rc_s": 0.6,
            "battery_fall_V_per_As": 0.01 * m,
        },
        oracle=lambda m, s, r: {"resistance_ohm": 1.2 * m},
    ),
    Effect(
        "current_limit",
        (1.05, 14.0),
        scale="stall",
        shows=("hard", "steps", "shuttle"),
        hide=lambda m, s, r: {"current_cap_A": 1 / m, "current_cap_ohm": 12 * r.believed["resistance_ohm"]},
        oracle=lambda m, s, r: {"inverse_current_per_A": m},
        equal_law=("inverse_current_per_A",),
    ),
    Effect(
        "duty_limit",
        (0.02, 0.5),
        shows=("to_the_top", "hard"),
        hide=lambda m, s, r: {"duty_cap": 1 - m, "duty_steps": 1000},
        oracle=lambda m, s, r: {"cut": m},
        equal_law=("cut",),
    ),
    Effect(
        "target_speed_limit",
        (0.22, 1.2),
        shows=("position_steps",),
        rigs=("servo",),
        hide=lambda m, s, r: {"target_rate_rad_s": 1 / m},
        oracle=lambda m, s, r: {"inverse_rate_s_per_rad": m},
        equal_law=("inverse_rate_s_per_rad",),
    ),
    Effect(
        "actuator_delay",
        (5e-5, 0.02),
        shows=("chirp", "prbs", "steps"),
        rigs=("drive", "drive", "drive", "servo"),
        hide=lambda m, s, r: {"late_command_s": m},
        oracle=lambda m, s, r: {"delay_s": m},
        equal_law=("delay_s",),
        same=("sampling_delay",),
    ),
    Effect(
        "winding_inductance",
        (5e-5, 5e-3),
        shows=("chirp", "prbs", "reversals"),
        needs=("no inductance", "current"),
        hide=lambda m, s, r: {"inductance_H": m},
        oracle=lambda m, s, r: {"inductance_H": m},
        equal_law=("inductance_H",),
    ),
    Effect(
        "backlash",
        (5e-4, 0.12),
        shows=("reversals", "prbs", "chirp"),
        gears=(3.0, 5.0),
        hide=lambda m, s, r: {
            "play_rad": m,
            "shaft_Nm_per_rad": 4e5 * r.true["load_kgm2"],
            "shaft_damping_Nms": 120 * r.true["load_kgm2"],
        },
        oracle=lambda m, s, r: {"gap_rad": m},
        equal_law=("gap_rad",),
    ),
    Effect(
        "shaft_compliance",
        (),
        scale="inertia",
        shows=("chirp", "prbs", "reversals"),
        shape=lambda rng, r: {"zeta": rng.uniform(0.03, 0.12)},
        hide=lambda m, s, r: {
            "shaft_Nm_per_rad": 1 / m,
            "shaft_damping_Nms": 2 * s["zeta"] * math.sqrt(_pair_kgm2(r) / m),
        },
        oracle=lambda m, s, r: {
            "compliance_rad_per_Nm": m,
            "damping_Nm_s_per_rad": 2 * s["zeta"] * math.sqrt(_pair_kgm2(r) / m),
        },
        equal_law=("compliance_rad_per_Nm",),
    ),
    Effect(
        "encoder_eccentricity",
        (2e-4, 0.04),
        shows=("stairs", "steps", "to_the_top"),
        shape=_phase,
        needs=("encoder",),
        hide=lambda m, s, r: {"encoder_swing_rad": m, "encoder_swing_phase": s["phase"]},
        oracle=lambda m, s, r: {"amplitude_rad": m, "phase_rad": s["phase"]},
        equal_law=("amplitude_rad",),
    ),
    Effect(
        "encoder_missed_counts",
        (1e-5, 3e-2),
        shows=("stairs", "steps", "to_the_top"),
        needs=("two speeds",),
        hide=lambda m, s, r: {"lost_per_count": m},
        oracle=lambda m, s, r: {"probability_per_count": m},
        equal_law=("probability_per_count",),
    ),
    Effect(
        "sampling_delay",
        (5e-5, 0.01),
        shows=("chirp", "prbs", "steps"),
        hide=lambda m, s, r: {"late_sample_s": m},
        oracle=lambda m, s, r: {"delay_s": m},
        equal_law=("delay_s",),
        same=("actuator_delay",),
    ),
    Effect(
        "sample_jitter",
        (2e-7, 2.4e-4),
        shows=("stairs", "to_the_top", "steps"),
        hide=lambda m, s, r: {"sample_jitter_s": m},
        oracle=lambda m, s, r: {"sigma_s": m},
        equal_law=("sigma_s",),
    ),
    Effect(
        "hall_speed_estimator",
        (0.001, 0.06),
        shows=("steps", "chirp", "prbs"),
        needs=("hall",),
        hide=lambda m, s, r: {"hall_pulses": 6 * r.believed["pole_pairs"], "hall_window_s": m},
        oracle=lambda m, s, r: {"pulses_per_turn": 6.0 * r.believed["pole_pairs"], "window_s": m},
        equal_law=("window_s",),
    ),
    Effect(
        "commutation_misalignment",
        (0.03, 0.7),
        shows=("steps", "hard", "stairs"),
        needs=("current",),
        shape=lambda rng, r: {"way": rng.choice((-1, 1))},
        hide=lambda m, s, r: {"advance_rad": s["way"] * m},
        oracle=lambda m, s, r: {"angle_rad": s["way"] * m},
        equal_law=("angle_rad",),
    ),
    Effect(
        "gravity_load",
        (2e-4, 3e-2),
        scale="torque",
        shows=("slow", "creep", "stairs"),
        shape=_phase,
        hide=lambda m, s, r: {"pendulum2_Nm": m * r.believed["gear"], "pendulum2_phase": s["phase"]},
        oracle=lambda m, s, r: {"torque_Nm": m * r.believed["gear"], "phase_rad": s["phase"]},
        equal_law=("torque_Nm",),
    ),
    Effect(
        "imbalance",
        (2e-4, 2e-2),
        scale="torque",
        shows=("slow", "creep", "stairs"),
        shape=_phase,
        hide=lambda m, s, r: {"unbalance_Nm": m, "unbalance_phase": s["phase"]},
        oracle=lambda m, s, r: {"torque_Nm": m, "phase_rad": s["phase"]},
        equal_law=("torque_Nm",),
    ),
    Effect(
        "constant_load",
        (1e-4, 2e-2),
        scale="torque",
        shows=("slow", "stairs", "steps"),
        rigs=("drive", "drive", "drive", "servo"),
        shape=lambda rng, r: {"way": rng.choice((-1, 1))},
        hide=lambda m, s, r: {"push_Nm": s["way"] * m * r.believed["gear"]},
        oracle=lambda m, s, r: {"torque_Nm": s["way"] * m * r.believed["gear"]},
        equal_law=("torque_Nm",),
    ),
    Effect(
        "thermal_derating",
        (0.02, 1.0),
        scale="amps",
        shows=("hard", "shuttle"),
        needs=("heating",),
        shape=lambda rng, r: {"from_K": rng.uniform(10, 25), "full": rng.uniform(0.85, 1.1)},
        hide=lambda m, s, r: {
            "derating_A_per_K": m,
            "derating_from_K": s["from_K"],
            "derating_full_A": s["full"] * r.stall_A,
            "current_cap_ohm": 12 * r.believed["resistance_ohm"],
        },
        oracle=lambda m, s, r: {
            "current_drop_A_per_K": m,
            "above_degC": 25 + s["from_K"],
            "full_current_A": s["full"] * r.stall_A,
        },
    ),
    Effect(
        "back_emf_missing",
        (0.005, 0.9),
        shows=("stairs", "steps", "to_the_top"),
        needs=("current",),
        hide=lambda m, s, r: {"back_emf_lost": m},
        oracle=lambda m, s, r: {"fraction": m},
        equal_law=("fraction",),
    ),
]


def _pair_kgm2(rig):
    """Inertia that swings against itself over the shaft, at the output."""
    rotor, load = rig.true["rotor_kgm2"] * rig.true["gear"] ** 2, rig.true["load_kgm2"]
    return rotor * load / (rotor + load)


BY_ID = {e.id: e for e in EFFECTS + FILTERS}


def size_range(effect, rig):
    """Least and largest size of an effect on a bench."""
    if effect.scale == "inertia":  # first mode from 140 Hz down to 16 Hz
        return 1 / (880**2 * _pair_kgm2(rig)), 1 / (100**2 * _pair_kgm2(rig))
    factor = {"": 1.0, "torque": rig.torque_scale, "stall": 1 / rig.stall_A, "amps": rig.stall_A / 10}[
        effect.scale
    ]
    return effect.size[0] * factor, effect.size[1] * factor


def same_law(effect, rig):
    """Ids that say the same as this one about this bench."""
    same = set(effect.same)
    if rig.believed["gear"] == 1 and effect.id in ("imbalance", "gravity_load"):
        same |= {"imbalance", "gravity_load"}
    return sorted(same - {effect.id})
