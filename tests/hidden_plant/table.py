"""Prints the scores: the rows that say when the diagnosis is good enough, all other figures, the confusion matrix."""
import math

import score

# row, figures of score.summary, and what each has to reach: (name, bound, "at least" or "at most")
DONE_WHEN = (
    (
        "one hidden effect, at least 15 % of the residual, recommended excitation: named first",
        (("single first", 0.92, 1),),
    ),
    ("... in the first two", (("single first two", 0.98, 1),)),
    ("no hidden effect: false alarm", (("false alarm", 0.02, -1),)),
    ("... all of its records, minutes", (("controls minutes", 60, -1),)),
    ("two effects: both named", (("pair both", 0.75, 1),)),
    ("outside the catalogue: unknown", (("outside unknown", 0.85, 1),)),
    ("... wrong confident name", (("outside wrong name", 0.05, -1),)),
    ("held-out error reduction over the oracle's: median", (("reduction median", 0.95, 1),)),
    ("... 10th percentile", (("reduction p10", 0.80, 1),)),
    ("added parameter: median error", (("parameter error median", 0.10, -1),)),
    ("base parameters: median bias afterwards", (("base bias median", 0.03, -1),)),
    ("robot: named first", (("robot first", 0.85, 1),)),
    ("robot by radio: named first", (("radio first", 0.80, 1),)),
    ("... a name where nothing is hidden", (("radio false name", 0.03, -1),)),
    ("names: expected calibration error of their probabilities", (("calibration error", 0.03, -1),)),
)
# Below these the reduced run of the tests fails: so few cases say only that the diagnosis has not fallen apart.
FLOORS = {
    "single first": (0.5, 1),
    "single first two": (0.75, 1),
    "false alarm": (0.34, -1),
    "no answer": (0.0, -1),
}


def number(figure):
    return figure["rate"] if isinstance(figure, dict) else figure


def reached(figure, bound, way):
    """True, False, or None where nothing was measured."""
    value = number(figure)
    return None if math.isnan(value) else value * way >= bound * way


def show(figure):
    if not isinstance(figure, dict):
        return "-" if isinstance(figure, float) and math.isnan(figure) else f"{figure:.3g}"
    if not figure["of"]:
        return "-"
    low, high = figure["interval"]
    return f"{100 * figure['rate']:.1f} % ({figure['hits']} of {figure['of']}; 95 %: {100 * low:.1f} to {100 * high:.1f} %)"


def done_when(figures):
    lines, words = [], {True: "pass", False: "MISS", None: "-"}
    for title, parts in DONE_WHEN:
        for name, bound, way in parts:
            verdict = words[reached(figures[name], bound, way)]
            lines.append(
                f"{verdict:5s} {title}: {show(figures[name])}   [{'>=' if way > 0 else '<='} {bound:g}]"
            )
    return lines


def confusion(rows):
    """One line per hidden effect: what was named first, how often."""
    counts = {}
    for r in rows:
        if (
            len(r["true"]) == 1
            and r["class"] in ("single", "generic", "filter", "loop", "torque", "robot", "radio")
            and r["shares"][0] >= 0.15
        ):
            said = r["named"][0] if r["named"] else f"({r['verdict'] or 'no answer'})"
            counts.setdefault((r["rig"], r["true"][0]), {}).setdefault((r["first"], said), 0)
            counts[(r["rig"], r["true"][0])][(r["first"], said)] += 1
    lines = []
    for (rig, true), said in sorted(counts.items()):
        total, right = sum(said.values()), sum(n for (ok, _), n in said.items() if ok)
        names = ", ".join(
            f"{'' if ok else '!'}{name} {n}" for (ok, name), n in sorted(said.items(), key=lambda kv: -kv[1])
        )
        lines.append(f"  {rig:5s} {true:26s} {right:3d}/{total:<3d} {names}")
    return lines


def others(rows):
    """What was said where nothing of the catalogue was hidden, and about pairs."""
    lines = []
    for cls in ("control", "loop-control", "torque-control", "robot-control", "outside", "fault", "pair", "beside"):
        for r in rows:
            if r["class"] != cls:
                continue
            good = {"outside": r["verdict"] == "unknown", "fault": r.get("found"), "pair": r.get("all"), "beside": r.get("all")}.get(
                cls, r["verdict"] == "adequate" and not r["named"]
            )
            if not good:
                hidden = " + ".join(r["what"]) or "nothing"
                lines.append(
                    f"  {cls:13s} {r['case']} {hidden}: {r['verdict'] or 'no answer'} {' + '.join(r['named'])}"
                )
    return lines


def reliability(pairs):
    """How often names are right, by the probability that was said; pairs: [(said, right)]."""
    lines = []
    for low, high in score.CONFIDENCE_BINS:
        inside = [(p, right) for p, right in pairs if low <= p < high]
        if not inside:
            continue
        hits = sum(right for _, right in inside)
        left, right = score.wilson(hits, len(inside))
        said = sum(p for p, _ in inside) / len(inside)
        lines.append(
            f"  said {100 * said:5.1f} %  right {100 * hits / len(inside):5.1f} % ({hits} of {len(inside)}; "
            f"95 %: {100 * left:.1f} to {100 * right:.1f} %)"
        )
    mean, most = score.calibration_by_chance(pairs)
    lines.append(
        f"  expected calibration error {100 * score.expected_calibration_error(pairs):.1f} points, {len(pairs)} names; "
        f"were all of it true, by chance {100 * mean:.1f} (95 %: up to {100 * most:.1f})"
    )
    return lines


def print_all(rows, figures):
    print("\nNamed first, by what was hidden (! is wrong)")
    print("\n".join(confusion(rows)) or "  none")
    missed = others(rows)
    if missed:
        print("\nOther answers that were not right")
        print("\n".join(missed))
    said = [c for r in rows for c in r["confidence"]]
    if said:
        print("\nNames, by the probability that was said of them")
        print("\n".join(reliability(said)))
    print("\nFigures")
    for name, figure in figures.items():
        print(f"  {name:26s} {show(figure)}")
    print("\nDone when")
    print("\n".join(done_when(figures)))


def below_floor(figures):
    return [
        f"{name}: {show(figures[name])}, floor {bound:g}"
        for name, (bound, way) in FLOORS.items()
        if reached(figures[name], bound, way) is False
    ]
