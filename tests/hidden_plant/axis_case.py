"""One axis record with its answer: a bench is drawn, something is hidden in it or nothing, three runs are recorded."""
import hashlib
import random

import dataset
import plant
from axis_effects import BY_ID, EFFECTS, same_law, size_range
from axis_rig import MODEL_KEY, draw_rig, model_sections
from excitation import LOOP_POOL, PLAIN, POOL, SERVO_POOL
from share import Ruler, hidden_at

DT = 1e-3
ROWS = 20000


def source(*key):
    """A random source that depends on nothing but its key."""
    digest = hashlib.sha256("/".join(["omnihil hidden plant", *map(str, key)]).encode()).digest()
    return random.Random(int.from_bytes(digest[:8], "big"))


def draw_kinds(rng, shows, rig, generic, closed_loop=False):
    """Excitations of the fit, the holdout and the extrapolation run."""
    if rig.kind == "servo":
        main = (
            "position_mixed"
            if generic
            else rng.choice([k for k in shows if k in SERVO_POOL] or list(SERVO_POOL))
        )
        return main, main, rng.choice(list(SERVO_POOL))
    if closed_loop:
        return "speed_targets", "speed_targets", "speed_targets"
    main = "mixed" if generic else rng.choice([k for k in shows if k in POOL] or list(POOL))
    other = rng.choice([k for k in POOL if k != main])
    if (
        not generic and rng.random() < 0.25
    ):  # half of the record something else, as where two effects are hidden
        main = "+".join(rng.sample([main, rng.choice(list(POOL))], 2))
    return main, main, other


def asked_of(rng, kind, rows=ROWS):
    both = kind.split("+")
    if len(both) == 2:  # half a run each
        return asked_of(rng, both[0], rows // 2) + asked_of(rng, both[1], rows - rows // 2)
    return {**POOL, **SERVO_POOL, **LOOP_POOL}[kind](rng, rows, DT)


def channels_of(rig):
    s = rig.sensors
    sigma = (lambda x: {"sigma": f"{x:.3g}"}) if s.get("sigma") else (lambda x: {})
    drive = "position_target" if rig.kind == "servo" else "duty"
    out = {"time": {"column": '"time_s"'}}
    if s.get("torque"):
        out["motor_torque"] = {"column": '"torque_Nm"', **sigma(0.5 * rig.true["current_noise_A"] * rig.true["flux_Vs"])}
    else:
        out[drive] = {"column": f'"{drive}"'}
    if s.get("bus"):
        out["bus_voltage"] = {"column": '"bus_V"', **sigma(rig.true["bus_noise_V"])}
    if s.get("current"):
        out["motor_current"] = {"column": '"current_A"', **sigma(rig.true["current_noise_A"])}
    if s.get("encoder"):
        out["encoder"] = {
            "column": '"ticks"',
            "counts_per_rev": f'{rig.true["encoder_cpr"]:.0f}',
            "shaft": '"rotor"',
        }
    if s.get("position"):
        out["position"] = {"column": '"angle_rad"', **sigma(rig.true["angle_noise_rad"])}
    if s.get("velocity"):
        out["velocity"] = {"column": '"speed_rad_s"', **sigma(rig.true["speed_noise_rad_s"])}
    return out


def record(rig, params, asked, seed):
    """Columns of one run."""
    params = dict(params, seed=seed % 100000)
    raw, _ = plant.run_axis(params, asked)
    seen = plant.sense_axis(params, raw, seed % 1000003)
    n, command = len(asked), plant.raw_columns(raw)["command"]
    out = {"time_s": [round(k * DT, 6) for k in range(n)]}
    out["position_target" if rig.kind == "servo" else "duty"] = [round(x, 6) for x in command]
    for sensor, column, source_name in (
        ("bus", "bus_V", "bus"),
        ("current", "current_A", "current"),
        ("encoder", "ticks", "counts"),
        ("position", "angle_rad", "angle"),
        ("velocity", "speed_rad_s", "speed"),
    ):
        if rig.sensors.get(sensor):
            out[column] = list(seen[source_name])
    return out


def close_loop(rng, rig):
    """A speed controller of moderate gain drives the axis; its duty is what gets recorded."""
    b = rig.believed
    stiff = rng.uniform(1.5, 5) * b["flux_Vs"] / b["supply_V"]
    rig.true.update(command_kind=2, loop_kp=stiff, loop_ki=stiff * rng.uniform(5, 15))


def write_case(folder, rig, kinds, hidden_params, key, change=None, gear=None, rows=ROWS):
    """The folder the program sees. `change` may spoil the columns of a run (data faults)."""
    folder.mkdir(parents=True, exist_ok=True)
    params = {**rig.true, **hidden_params}
    dataset.write_model(folder / "model.toml", "axis", model_sections(rig, gear))
    runs = []
    for number, (use, kind) in enumerate(zip(("fit", "holdout", "extrapolation"), kinds)):
        rng = source(*key, "run", use)
        asked = asked_of(rng, kind, rows)
        columns = record(rig, params, asked, rng.randrange(1 << 30))
        if change:
            columns = change(columns, source(*key, "change", use))
        name = f"run_{number + 1}.csv"
        dataset.write_csv(folder / name, columns)
        words = " then ".join(PLAIN.get(k, k.replace("_", " ")) for k in kind.split("+"))
        runs.append({"file": name, "use": use, "excitation": words})
    dataset.write_dataset(folder, f"axis bench {folder.name}", "axis", channels_of(rig), runs)


def base_answer(rig):
    """True base parameters by their path in the model file."""
    skip = {"supply_V"} if rig.sensors.get("bus") else set()
    return {path: rig.true[name] for name, path in MODEL_KEY.items() if name not in rig.left_out | skip}


def make_effects_case(folder, key, effects, share, generic=False, closed_loop=False):
    """A case with these effects, each of about this share. Returns the answer."""
    rng = source(*key)
    wanted = [BY_ID[e] for e in effects]
    needs = [n for e in wanted for n in e.needs]
    gears = [g for e in wanted for g in e.gears]
    kinds_of_rig = [set(e.rigs) for e in wanted]
    rig_kind = "drive" if len(wanted) > 1 or closed_loop else rng.choice(wanted[0].rigs)
    assert all(rig_kind in k for k in kinds_of_rig)
    rig = draw_rig(rng, rig_kind, rng.choice(gears) if gears else None, needs)
    if closed_loop:
        close_loop(rng, rig)
    if len(wanted) == 2 and not generic:
        kind = "+".join(rng.choice(e.shows) for e in wanted)
        kinds = (kind, kind, rng.choice(list(POOL)))
    else:
        kinds = draw_kinds(rng, wanted[0].shows, rig, generic, closed_loop)
    asked = asked_of(source(*key, "run", "fit"), kinds[0])
    params, answers = {}, []
    for e in wanted:
        shape = e.shape(rng, rig)
        hidden, answer = hidden_at(e, shape, rig, Ruler(rig, asked), size_range(e, rig), share, same_law(e, rig))
        params.update(hidden)
        answers.append(answer)
    write_case(folder, rig, kinds, params, key)
    return answer_of(rig, kinds, answers)


def make_control_case(folder, key, closed_loop=False):
    """A case with nothing hidden: base errors, noise, any excitation."""
    rng = source(*key)
    servo = not closed_loop and rng.random() < 0.12
    needs = ["no inductance"] if rng.random() < 0.06 else []
    rig = draw_rig(rng, "servo" if servo else "drive", None, needs)
    if "inductance_H" in rig.left_out and not servo:  # so little that it cannot be seen
        rig.true["inductance_H"] = 4e-6 * rig.true["resistance_ohm"]
        rig.true["step_s"] = 8e-6 / 2
    if closed_loop:
        close_loop(rng, rig)
    shows = [rng.choice(EFFECTS).shows for _ in range(1)][0]
    kinds = draw_kinds(rng, shows, rig, rng.random() < 0.2, closed_loop)
    write_case(folder, rig, kinds, {}, key)
    return answer_of(rig, kinds, [])


def answer_of(rig, kinds, effects):
    return {
        "rig": "axis",
        "effects": effects,
        "excitation": list(kinds),
        "base": base_answer(rig),
        "believed": {MODEL_KEY[k]: v for k, v in rig.believed.items() if k in MODEL_KEY},
        "sensors": rig.sensors,
        "heating_declared": rig.heating_declared,
    }
