"""Records that are broken, not physics: the program is to say so instead of naming an effect."""
import axis_case
from axis_rig import draw_rig


def glitches(columns, rng):
    """Single rows of the counter jump away and back."""
    ticks = columns["ticks"]
    for _ in range(len(ticks) // 600):
        ticks[rng.randrange(10, len(ticks))] += rng.choice((-1, 1)) * rng.randint(800, 6000)
    return columns


def swapped_sign(columns, rng):
    """The encoder counts backwards."""
    columns["ticks"] = [-x for x in columns["ticks"]]
    return columns


def dropped_ticks(columns, rng):
    """The counter stands still for a while and has lost what passed."""
    ticks, lost, k = columns["ticks"], 0.0, 0
    gaps = sorted(rng.randrange(200, len(ticks) - 200) for _ in range(20))
    out = list(ticks)
    for gap in gaps:
        length = rng.randint(15, 60)
        held = out[gap]
        lost = out[gap + length] - held
        for k in range(gap, len(out)):
            out[k] = held if k < gap + length else out[k] - lost
    columns["ticks"] = out
    return columns


def late_timestamps(columns, rng):
    """A host that was busy stamps some rows late; the rows after them bunch up."""
    last, out = -1.0, []
    delay = 0.0
    for t in columns["time_s"]:
        if rng.random() < 0.01:
            delay = rng.uniform(0.003, 0.009)
        delay = max(0.0, delay - 0.0007)
        last = max(last + 2e-5, t + delay)
        out.append(round(last, 6))
    columns["time_s"] = out
    return columns


def milliamperes(columns, rng):
    columns["current_A"] = [1000 * x for x in columns["current_A"]]
    return columns


def unchanged(columns, rng):
    return columns


# name: (change of a run's columns, words of which one has to be in what the program says)
KINDS = {
    "glitches": (glitches, ("glitch", "jump", "outlier", "spike")),
    "swapped_sign": (swapped_sign, ("sign", "backwards", "reversed", "opposite", "direction")),
    "wrong_gear_ratio": (unchanged, ("gear", "ratio")),
    "dropped_ticks": (
        dropped_ticks,
        ("dropped", "lost", "missed", "missing", "stuck", "stands still", "frozen", "jump", "glitch"),
    ),
    "late_timestamps": (late_timestamps, ("stamp", "jitter", "clock", "late", "timing")),
    "wrong_counts_per_turn": (unchanged, ("scale", "counts_per_rev", "counts per", "factor", "gear")),
    "current_in_milliamperes": (milliamperes, ("scale", "milliamp", "mA", "factor", "unit")),
}


def make_case(folder, key, kind):
    rng = axis_case.source(*key)
    gear = {"wrong_gear_ratio": 3.0}.get(kind)
    needs = ["encoder", "not heated"] + (["current"] if kind == "current_in_milliamperes" else [])
    rig = draw_rig(rng, "drive", gear, needs)
    rig.sensors.pop("velocity", None)
    stated_gear = None
    if kind == "wrong_gear_ratio":  # the encoder sits on the output; the file names another gear
        rig.true["encoder_on_output"] = 1
        stated_gear = rng.choice((4.4, 5.0, 2.0))
    kinds = axis_case.draw_kinds(rng, ("steps", "stairs", "chirp", "prbs", "mixed"), rig, False)
    axis_case.write_case(folder, rig, kinds, {}, key, KINDS[kind][0], stated_gear)
    toml = folder / "dataset.toml"
    text = toml.read_text()
    if kind == "wrong_gear_ratio":
        text = text.replace('shaft = "rotor"', 'shaft = "output"')
    if kind == "wrong_counts_per_turn":
        stated = f'counts_per_rev = {rig.true["encoder_cpr"]:.0f}'
        text = text.replace(stated, f'counts_per_rev = {rig.true["encoder_cpr"] / 4:.0f}')
    toml.write_text(text)
    return {**axis_case.answer_of(rig, kinds, []), "fault": {"kind": kind, "words": list(KINDS[kind][1])}}
