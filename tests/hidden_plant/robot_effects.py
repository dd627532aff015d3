"""What can be hidden in a robot: how it is put into the plant, at which sizes, and which drives show it."""
import math

from axis_effects import TURN, Effect


def _four(rng, spread):
    """Four ratios that differ but do not all go one way."""
    raw = [rng.uniform(-1, 1) for _ in range(4)]
    mean = sum(raw) / 4
    largest = max(abs(x - mean) for x in raw)
    return {"four": [(x - mean) / largest for x in raw]}


def _ratios(name, m, s):
    return {f"{name}_{k + 1}": 1 + m * x for k, x in enumerate(s["four"])}


def _way(rng, rig):
    return {"way": rng.uniform(0, TURN)}


EFFECTS = [
    Effect(
        "wheel_slip",
        (0.01, 0.4),
        shows=("hard_starts", "random_drive"),
        shape=lambda rng, r: {"grip": rng.uniform(0.5, 0.7)},
        hide=lambda m, s, r: {"brush": 1, "brush_m_s": m, "brush_grip": s["grip"]},
        oracle=lambda m, s, r: {"compliance_m_s": m, "grip": s["grip"]},
        rigs=("robot",),
    ),
    Effect(
        "lateral_roller_friction",
        (0.003, 0.15),
        shows=("directions", "random_drive"),
        rigs=("robot",),
        hide=lambda m, s, r: {"roller_drag": m},
        oracle=lambda m, s, r: {"coefficient": m},
        equal_law=("coefficient",),
    ),
    Effect(
        "roller_ripple",
        (0.005, 0.25),
        shows=("crawl", "directions"),
        rigs=("robot",),
        shape=lambda rng, r: {"phase": rng.uniform(0, TURN)},
        hide=lambda m, s, r: {"roller_ripple": m, "roller_phase": s["phase"]},
        oracle=lambda m, s, r: {"fraction": m, "order": 15.0, "phase_rad": s["phase"]},
        equal_law=("fraction",),
    ),
    Effect(
        "rolling_resistance",
        (0.002, 0.1),
        shows=("crawl", "directions"),
        rigs=("robot",),
        hide=lambda m, s, r: {"rolling": m},
        oracle=lambda m, s, r: {"coefficient": m},
        equal_law=("coefficient",),
        needs=("known dry friction",),
    ),
    Effect(
        "center_of_mass_offset",
        (0.002, 0.03),
        shows=("hard_starts", "random_drive"),
        rigs=("robot",),
        shape=_way,
        hide=lambda m, s, r: {"offset_x_m": m * math.cos(s["way"]), "offset_y_m": m * math.sin(s["way"])},
        oracle=lambda m, s, r: {"x_m": m * math.cos(s["way"]), "y_m": m * math.sin(s["way"])},
        equal_law=("x_m", "y_m"),
    ),
    Effect(
        "payload",
        (0.1, 1.5),
        shows=("hard_starts", "random_drive"),
        rigs=("robot",),
        hide=lambda m, s, r: {"payload_kg": m},
        oracle=lambda m, s, r: {"mass_kg": m},
        equal_law=("mass_kg",),
    ),
    Effect(
        "floor_tilt",
        (0.002, 0.06),
        shows=("directions", "random_drive"),
        rigs=("robot",),
        shape=_way,
        hide=lambda m, s, r: {"tilt_rad": m, "tilt_towards": s["way"]},
        oracle=lambda m, s, r: {"angle_rad": m, "direction_rad": s["way"]},
        equal_law=("angle_rad",),
    ),
    Effect(
        "wheel_radius_mismatch",
        (0.002, 0.05),
        shows=("directions", "random_drive"),
        rigs=("robot",),
        shape=_four,
        hide=lambda m, s, r: _ratios("radius", m, s),
        oracle=lambda m, s, r: _ratios("ratio", m, s),
        equal_law=("ratio_1", "ratio_2", "ratio_3", "ratio_4"),
    ),
    Effect(
        "motor_mismatch",
        (0.004, 0.12),
        shows=("directions", "random_drive"),
        rigs=("robot",),
        shape=_four,
        hide=lambda m, s, r: _ratios("flux", m, s),
        oracle=lambda m, s, r: _ratios("ratio", m, s),
        equal_law=("ratio_1", "ratio_2", "ratio_3", "ratio_4"),
    ),
    Effect(
        "dribbler_drag",
        (0.05, 3.0),
        shows=("directions", "random_drive"),
        rigs=("robot",),
        needs=("dribbler",),
        hide=lambda m, s, r: {"dribbler_N": m},
        oracle=lambda m, s, r: {"force_N": m},
        equal_law=("force_N",),
    ),
    Effect(
        "vision_delay",
        (0.001, 0.08),
        shows=("random_drive", "hard_starts"),
        rigs=("robot",),
        hide=lambda m, s, r: {"late_vision_s": m},
        oracle=lambda m, s, r: {"delay_s": m},
        equal_law=("delay_s",),
    ),
    Effect(
        "battery_sag",
        (0.005, 0.3),
        shows=("hard_starts", "random_drive"),
        rigs=("robot",),
        needs=("bus hidden",),
        hide=lambda m, s, r: {"battery_ohm": m, "battery_rc_ohm": 0.3 * m, "battery_rc_s": 0.6},
        oracle=lambda m, s, r: {"resistance_ohm": 1.2 * m},
    ),
    Effect(
        "coulomb_friction",
        (3e-4, 1e-2),
        shows=("crawl", "directions"),
        rigs=("robot",),
        needs=("no dry friction",),
        hide=lambda m, s, r: {"dry_Nm": m},
        oracle=lambda m, s, r: {"torque_Nm": m},
        equal_law=("torque_Nm",),
    ),
    Effect(
        "dead_time",
        (0.02, 0.9),
        shows=("crawl", "directions"),
        rigs=("robot",),
        hide=lambda m, s, r: {"edge_V": m, "edge_A": 0.25},
        oracle=lambda m, s, r: {"voltage_V": m, "current_width_A": 0.25},
        equal_law=("voltage_V",),
    ),
    Effect(
        "cogging",
        (3e-4, 1e-2),
        shows=("crawl", "directions"),
        rigs=("robot",),
        shape=lambda rng, r: {"phase": rng.uniform(0, TURN)},
        hide=lambda m, s, r: {"cog_Nm": m, "cog_order": 48, "cog_phase": s["phase"], "cog2_Nm": 0.12 * m},
        oracle=lambda m, s, r: {"amplitude_Nm": m, "order": 48.0, "phase_rad": s["phase"]},
        equal_law=("amplitude_Nm",),
    ),
    Effect(
        "current_limit",
        (0.1, 1.0),
        shows=("hard_starts", "random_drive"),
        rigs=("robot",),
        hide=lambda m, s, r: {"current_cap_A": 1 / m},
        oracle=lambda m, s, r: {"inverse_current_per_A": m},
        equal_law=("inverse_current_per_A",),
    ),
    Effect(
        "quadratic_drag",
        (5e-4, 2e-2),
        shows=("directions", "random_drive"),
        rigs=("robot",),
        hide=lambda m, s, r: {"drag_Nm": m},
        oracle=lambda m, s, r: {"coefficient_Nm_s2_per_rad2": m / 9e4},
        equal_law=("coefficient_Nm_s2_per_rad2",),
    ),
    Effect(
        "actuator_delay",
        (5e-4, 0.04),
        shows=("random_drive", "hard_starts"),
        rigs=("robot",),
        hide=lambda m, s, r: {"late_command_s": m},
        oracle=lambda m, s, r: {"delay_s": m},
        equal_law=("delay_s",),
    ),
]
BY_ID = {e.id: e for e in EFFECTS}
