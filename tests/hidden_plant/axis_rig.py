"""A bench with one drive: what it truly is, what its owner believes, and which sensors it has."""
import dataclasses
import math

# R, L, torque constant, rotor inertia, pole pairs, slots, supply, winding K/W, housing K/W, winding J/K, housing J/K.
# The first two are Maxon EC 45 flat 30 W (200142) and 50 W (651607); the third is a small brushed motor, a guess.
MOTORS = (
    dict(
        resistance_ohm=1.2,
        inductance_H=0.56e-3,
        flux_Vs=0.0255,
        rotor_kgm2=92.5e-7,
        pole_pairs=8,
        slots=12,
        supply_V=18.0,
        winding_K_per_W=3.96,
        housing_K_per_W=5.7,
        winding_J_per_K=2.9,
        housing_J_per_K=44.0,
        viscous_Nms=3.2e-6,
        dry_Nm=2.2e-3,
    ),
    dict(
        resistance_ohm=0.447,
        inductance_H=0.243e-3,
        flux_Vs=0.0295,
        rotor_kgm2=135e-7,
        pole_pairs=8,
        slots=12,
        supply_V=24.0,
        winding_K_per_W=8.28,
        housing_K_per_W=1.57,
        winding_J_per_K=3.5,
        housing_J_per_K=50.0,
        viscous_Nms=5.4e-6,
        dry_Nm=4.0e-3,
    ),
    dict(
        resistance_ohm=2.1,
        inductance_H=0.6e-3,
        flux_Vs=0.019,
        rotor_kgm2=48e-7,
        pole_pairs=7,
        slots=12,
        supply_V=16.0,
        winding_K_per_W=6.0,
        housing_K_per_W=8.0,
        winding_J_per_K=2.0,
        housing_J_per_K=30.0,
        viscous_Nms=2.5e-6,
        dry_Nm=1.5e-3,
    ),
)
SERVO = dict(
    resistance_ohm=4.4,
    inductance_H=88e-6,
    flux_Vs=2.5,
    rotor_kgm2=0.010,
    pole_pairs=1,
    slots=0,
    supply_V=12.0,
    winding_K_per_W=10.0,
    housing_K_per_W=10.0,
    winding_J_per_K=3.0,
    housing_J_per_K=30.0,
    viscous_Nms=0.05,
    dry_Nm=0.05,
)

# Relative 1-sigma a data sheet states, and how far off the truth is (from, to).
TOLERANCE = {
    "resistance_ohm": (0.08, 0.05, 0.10),
    "inductance_H": (0.10, 0.05, 0.10),
    "flux_Vs": (0.05, 0.03, 0.06),
    "rotor_kgm2": (0.08, 0.05, 0.10),
    "load_kgm2": (0.08, 0.05, 0.10),
    "viscous_Nms": (0.30, 0.10, 0.30),
    "dry_Nm": (0.30, 0.10, 0.30),
}
MODEL_KEY = {
    "resistance_ohm": "motor.resistance_ohm",
    "inductance_H": "motor.inductance_H",
    "flux_Vs": "motor.torque_constant_Nm_per_A",
    "rotor_kgm2": "motor.rotor_inertia_kg_m2",
    "load_kgm2": "load.inertia_kg_m2",
    "viscous_Nms": "motor.viscous_friction_Nm_s_per_rad",
    "dry_Nm": "effects.coulomb_friction.torque_Nm",
    "supply_V": "supply.voltage_V",
}


@dataclasses.dataclass
class Rig:
    kind: str  # "drive" or "servo"
    believed: dict  # nominal value of every base parameter, by plant name
    true: dict  # plant parameters of the drive itself
    slots: int
    sensors: dict  # which channels there are
    left_out: set  # base parameters the model file does not have
    heating_declared: bool = False

    @property
    def torque_scale(self):
        """Size of a friction torque here over that of the 50 W drive."""
        return self.believed["dry_Nm"] / 4e-3

    @property
    def stall_A(self):
        return self.believed["supply_V"] / self.believed["resistance_ohm"]


def draw_rig(rng, kind="drive", gear=None, needs=()):
    """A bench. `needs`: any of "bus hidden", "current", "no inductance", "no dry friction", "heating", "two speeds",
    "encoder", "hall", "not heated"."""
    motor = dict(SERVO if kind == "servo" else rng.choice(MOTORS))
    slots = motor.pop("slots")
    motor["gear"] = 1.0 if kind == "servo" else gear or rng.choice((1.0, 1.0, 3.0, 5.0))
    reflected = rng.uniform(1.0, 2.0) if kind == "servo" else rng.uniform(2.5, 7)
    motor["load_kgm2"] = motor["rotor_kgm2"] * reflected * motor["gear"] ** 2
    believed = {k: float(f"{v:.4g}") for k, v in motor.items()}
    left_out = set()
    if kind == "servo" or "no inductance" in needs:
        left_out.add("inductance_H")
    true = dict(believed)
    for name, (_, least, most) in TOLERANCE.items():
        true[name] *= 1 + rng.choice((-1, 1)) * rng.uniform(least, most)
    no_dry = "no dry friction" in needs or (not needs and rng.random() < 0.1)
    if no_dry:
        left_out.add("dry_Nm")
        true["dry_Nm"] = 0.0
    loud = rng.choice((0.3, 1.0, 1.0, 3.0))
    bus = "bus hidden" not in needs and rng.random() < 0.75
    sensors = sensors_of(rng, kind, needs, bus)
    true.update(
        current_noise_A=0.03 * loud,
        bus_noise_V=0.02 * loud,
        speed_noise_rad_s=0.25 * loud / believed["gear"],
        encoder_cpr=rng.choice((4096.0, 4096.0, 2048.0, 16384.0)),
    )
    if bus:
        true.update(
            supply_drift_V=rng.uniform(0, 0.01) * believed["supply_V"],
            supply_drift_Hz=rng.uniform(0.03, 0.08),
        )
    true["supply_V"] *= 1 + rng.uniform(-0.005, 0.005)
    rig = Rig(kind, believed, true, slots, sensors, left_out)
    if kind == "servo":
        true.update(
            command_kind=1,
            servo_duty_per_rad=rng.choice((2.0, 2.6)),
            servo_duty_limit=0.97,
            pendulum_Nm=0.8,
            speed_noise_rad_s=0.05,
            angle_noise_rad=5e-4,
            step_s=12.5e-6,
        )
    if "heating" in needs or ("not heated" not in needs and rng.random() < 0.06):
        declare_heating(rng, rig)
    return rig


def sensors_of(rng, kind, needs, bus):
    if kind == "servo":
        return dict(position=True, velocity=True, bus=bus, sigma=True)
    current = "current" in needs or rng.random() < 0.85
    channels = dict(current=current, bus=bus, sigma=rng.random() < 0.8)
    if "hall" in needs:
        return dict(channels, velocity=True)
    roll = rng.random()
    if "two speeds" in needs or roll < 0.12:
        return dict(channels, encoder=True, velocity=True)
    return (
        dict(channels, velocity=True)
        if roll < 0.27 and "encoder" not in needs
        else dict(channels, encoder=True)
    )


def declare_heating(rng, rig):
    """Heating that is known and in the model: a small winding without much of a housing."""
    rig.heating_declared = True
    rig.true.update(copper_per_K=0.00393, winding_J_per_K=rig.believed["winding_J_per_K"] * rng.uniform(2, 5))
    rig.believed["winding_J_per_K"] = rig.true["winding_J_per_K"]


def base_parameters(rig):
    """Names of the base parameters a fit may move, with their tolerance."""
    out = {k: t for k, (t, _, _) in TOLERANCE.items() if k not in rig.left_out}
    if not rig.sensors.get("bus"):
        out["supply_V"] = 0.01
    return out


def model_sections(rig, gear=None):
    """The nominal model.toml as {section: {key: text}}."""
    b = rig.believed

    def rough(name):
        return f"{{ value = {b[name]:.6g}, tolerance = {TOLERANCE[name][0]:g} }}"

    motor = {
        MODEL_KEY[k].split(".")[1]: rough(k)
        for k in ("resistance_ohm", "inductance_H", "flux_Vs")
        if k not in rig.left_out
    }
    if rig.kind == "drive":
        motor.update(pole_pairs=f"{b['pole_pairs']:.0f}", slots=str(rig.slots))
    motor.update({MODEL_KEY[k].split(".")[1]: rough(k) for k in ("rotor_kgm2", "viscous_Nms")})
    sections = {
        "motor": motor,
        "gear": {"ratio": f"{gear or b['gear']:g}"},
        "load": {"inertia_kg_m2": rough("load_kgm2")},
        "supply": {"voltage_V": f"{{ value = {b['supply_V']:g}, tolerance = 0.01 }}"},
    }
    if rig.kind == "servo":
        sections["load"]["gravity_torque_Nm"] = f"{rig.true['pendulum_Nm']:g}"
        sections["servo"] = {
            "kp_duty_per_rad": f"{rig.true['servo_duty_per_rad']:g}",
            "duty_limit": f"{rig.true['servo_duty_limit']:g}",
        }
    if "dry_Nm" not in rig.left_out:
        sections["effects.coulomb_friction"] = {"torque_Nm": rough("dry_Nm")}
    if rig.heating_declared:
        sections["effects.winding_heating"] = heating_section(rig)
    return sections


def heating_section(rig):
    t = {**rig.believed, **rig.true}
    return {
        "temperature_coefficient_per_K": "0.00393",
        "thermal_resistance_K_per_W": f"{t['winding_K_per_W']:.6g}",
        "thermal_capacity_J_per_K": f"{t['winding_J_per_K']:.6g}",
        "housing_thermal_resistance_K_per_W": f"{t['housing_K_per_W']:.6g}",
        "housing_thermal_capacity_J_per_K": f"{t['housing_J_per_K']:.6g}",
    }


def speed_noise(rig):
    """1-sigma of one sample of the measured speed, rad/s."""
    if rig.sensors.get("encoder"):
        return math.sqrt(2 / 12) * 2 * math.pi / rig.true["encoder_cpr"] / 1e-3
    return rig.true["speed_noise_rad_s"]
