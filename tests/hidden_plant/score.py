"""Scores one result, twin-aware, and whole sets of them."""
import math
import random
import statistics

LEAST_SHARE = 0.15  # of the residual: from here on an effect has to be named
# Of the probability that a name is right; the last but one is around 90 %.
CONFIDENCE_BINS = ((0.0, 0.3), (0.3, 0.6), (0.6, 0.85), (0.85, 0.95), (0.95, 1.01))
LARGEST_SET = 3  # a longer set of effects that cannot be told apart is no answer


def sets_of(diagnosis):
    return [set(s) for s in diagnosis.get("indistinguishable") or [] if len(s) <= LARGEST_SET]


def matches(name, effect, diagnosis):
    """Is `name` right for this hidden effect: it itself, its very law under another name, or declared its twin."""
    right = {effect["id"], *effect["same_law"]}
    return name in right or any(name in s and s & right for s in sets_of(diagnosis))


def pooled(errors, sigma):
    """Root mean square over signals, each over its noise. A measured bus voltage is an input, not an answer."""
    values = [
        (e.get("rmse", math.nan) / sigma[name]) ** 2
        for name, e in (errors or {}).items()
        if sigma.get(name) and name != "bus_voltage"
    ]
    return math.sqrt(sum(values) / len(values)) if values else math.nan


def find(tree, key):
    """The first table under this key, anywhere."""
    if isinstance(tree, dict):
        if isinstance(tree.get(key), dict):
            return tree[key]
        tree = list(tree.values())
    if isinstance(tree, list):
        for branch in tree:
            found = find(branch, key)
            if found is not None:
                return found
    return None


def error_reduction(result):
    """(baseline - tool) / (baseline - oracle) on the holdout run; NaN where the oracle gains less than 2 %."""
    d = result.get("diagnosis") or {}
    sigma = {k: v.get("noise_sigma") for k, v in (d.get("signals") or {}).items()}
    base = pooled((d.get("baseline") or {}).get("holdout"), sigma)
    tool = pooled((d.get("final") or {}).get("holdout"), sigma)
    best = pooled(find((result.get("oracle") or {}).get("compare"), "holdout"), sigma)
    if not base - best > 0.02 * base:
        return math.nan
    return (base - tool) / (base - best)


def value_at(model, path):
    for key in path.split("."):
        model = model.get(key) if isinstance(model, dict) else None
    if isinstance(model, dict):
        model = model.get("value")
    return float(model) if isinstance(model, (int, float)) else math.nan


def parameter_errors(result, answer):
    """Relative errors of the added effect's parameters, where both laws mean the same by them."""
    d, out = result.get("diagnosis") or {}, []
    for effect in answer["effects"]:
        if effect["id"] not in (d.get("effects") or []):
            continue
        ranked = next((r for r in d.get("ranking") or [] if r.get("effect") == effect["id"]), {})
        for name in effect["equal_law"]:
            true, found = effect["parameters"][name], value_at(
                result.get("final_model") or {}, f"effects.{effect['id']}.{name}"
            )
            if math.isnan(found):
                found = value_at(ranked.get("parameters") or {}, name)
            neutral = 1.0 if name.startswith("ratio_") else 0.0
            if not math.isnan(found) and abs(true - neutral) > 1e-12:
                found, true = found - neutral, true - neutral
                if name.startswith("amplitude"):  # a sign is half a turn of phase
                    found, true = abs(found), abs(true)
                out.append(abs(found - true) / abs(true))
    return out


def base_bias(result, answer):
    """Relative errors of the base parameters of the final model; those said to be not determined are left out."""
    model = result.get("final_model") or {}
    stated = ((result.get("diagnosis") or {}).get("baseline") or {}).get("parameters") or {}
    out = []
    for path, true in answer["base"].items():
        found = value_at(model, path)
        if not math.isnan(found) and true and stated.get(path, {}).get("identifiable", True):
            out.append(abs(found - true) / abs(true))
    return out


def fault_text(result):
    """What the program says about the record: findings in its JSON, else everything it printed."""
    d, out = result.get("diagnosis") or {}, []
    for key, value in d.items():
        if (
            any(word in key for word in ("fault", "finding", "sanity", "data", "quality"))
            and key != "dataset"
        ):
            out.append(str(value))
    return "\n".join(out) if out else result.get("text", "")


def judge(result, answer):
    """Everything about one case as plain values."""
    d = result.get("diagnosis") or {}
    named = list(d.get("effects") or [])
    ranked = [r.get("effect") for r in d.get("ranking") or []]
    out = {
        "case": answer["case"],
        "class": answer["class"],
        "rig": answer["rig"],
        "true": [e["id"] for e in answer["effects"]],
        "what": answer["what"],
        "shares": [e["share"] for e in answer["effects"]],
        "verdict": d.get("verdict"),
        "named": named,
        "ranked": ranked[:3],
        "seconds": result.get("seconds"),
        "of_the_run_s": result.get("of_the_run_s"),
        "code": result.get("code"),
        "answered": bool(d),
    }
    effects = answer["effects"]
    out["confidence"] = [
        (c["probability"], any(matches(c["effect"], e, d) for e in effects)) for c in d.get("confidence") or []
    ]
    if effects:
        first, second = named[:1], named[:2] + ranked[:2]
        out["first"] = any(matches(n, effects[0], d) for n in first)
        out["first_two"] = any(matches(n, effects[0], d) for n in second)
        out["all"] = all(any(matches(n, e, d) for n in named) for e in effects)
        out["extra"] = sum(not any(matches(n, e, d) for e in effects) for n in named)
        out["extra_later"] = sum(not any(matches(n, e, d) for e in effects) for n in named[1:])
        out["reduction"] = error_reduction(result)
        out["parameter_errors"] = parameter_errors(result, answer)
        out["bias"] = base_bias(result, answer) if out["all"] else []
    if "fault" in answer:
        words = answer["fault"]["words"]
        out["found"] = any(w.lower() in fault_text(result).lower() for w in words)
    return out


def expected_calibration_error(pairs):
    """Mean distance of predicted and observed rate over the bins, weighted by their numbers (Naeini et al., AAAI 2015)."""
    total, bad = len(pairs), 0.0
    for low, high in CONFIDENCE_BINS:
        inside = [(p, right) for p, right in pairs if low <= p < high]
        bad += abs(sum(p for p, _ in inside) - sum(right for _, right in inside))
    return bad / total if total else math.nan


def calibration_by_chance(pairs, draws=1000):
    """(mean, 95 % point) of that error where each name is right as often as was said: a few names in a bin are never right in
    just that share (parametric bootstrap)."""
    chance = random.Random(1)
    errors = [expected_calibration_error([(p, chance.random() < p) for p, _ in pairs]) for _ in range(draws)]
    return (statistics.fmean(errors), quantile(errors, 0.95)) if pairs else (math.nan, math.nan)


def wilson(k, n, z=1.96):
    """Interval of a rate (Wilson 1927)."""
    if n == 0:
        return (math.nan, math.nan)
    p, d = k / n, 1 + z * z / n
    middle, half = (p + z * z / (2 * n)) / d, z * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n)) / d
    return (max(0.0, middle - half), min(1.0, middle + half))


def quantile(values, q):
    values = sorted(v for v in values if not math.isnan(v))
    if not values:
        return math.nan
    at = q * (len(values) - 1)
    low = int(at)
    return values[low] + (at - low) * (values[min(low + 1, len(values) - 1)] - values[low])


def median(values):
    return quantile(values, 0.5)


def rate(rows, test):
    hits = sum(bool(test(r)) for r in rows)
    return {
        "hits": hits,
        "of": len(rows),
        "rate": hits / len(rows) if rows else math.nan,
        "interval": wilson(hits, len(rows)),
    }


def large(rows):
    return [r for r in rows if r["shares"] and min(r["shares"]) >= LEAST_SHARE]


def summary(rows):
    """All figures of a set of judged cases."""
    of = {}
    for r in rows:
        of.setdefault(r["class"], []).append(r)

    def get(name):
        return of.get(name, [])

    def alarm(r):
        return r["verdict"] != "adequate" or r["named"]

    single, generic, robot = large(get("single")), large(get("generic")), large(get("robot"))
    both = single + generic
    reductions = [r["reduction"] for r in both if not math.isnan(r["reduction"])]
    control_s = [r["of_the_run_s"] for r in get("control") if r["of_the_run_s"]]
    return {
        "single first": rate(single, lambda r: r["first"]),
        "single first two": rate(single, lambda r: r["first_two"]),
        "generic first": rate(generic, lambda r: r["first"]),
        "generic first two": rate(generic, lambda r: r["first_two"]),
        "small single first": rate([r for r in get("single") if r not in single], lambda r: r["first"]),
        "extra effects per case": statistics.fmean([r["extra"] for r in both]) if both else math.nan,
        "second names not hidden": rate(both, lambda r: r["extra_later"]),
        "false alarm": rate(get("control"), alarm),
        "controls minutes": sum(control_s) / 60 if control_s else math.nan,
        "robot false alarm": rate(get("robot-control"), alarm),
        "closed-loop false alarm": rate(get("loop-control"), alarm),
        "closed-loop first": rate(large(get("loop")), lambda r: r["first"]),
        "torque-driven first": rate(large(get("torque")), lambda r: r["first"]),
        "torque-driven false alarm": rate(get("torque-control"), alarm),
        "torque-driven extra names": statistics.fmean([r["extra"] for r in get("torque")])
        if get("torque")
        else math.nan,
        "filter first": rate(large(get("filter")), lambda r: r["first"]),
        "pair both": rate(large(get("pair")), lambda r: r["all"]),
        "pair one": rate(large(get("pair")), lambda r: r["first"] or r["extra"] < len(r["named"])),
        "outside unknown": rate(get("outside"), lambda r: r["verdict"] == "unknown"),
        "outside wrong name": rate(get("outside"), lambda r: r["verdict"] == "effect"),
        "beside named": rate(large(get("beside")), lambda r: r["all"]),
        "beside wrong names": statistics.fmean([r["extra"] for r in get("beside")]) if get("beside") else math.nan,
        "faint wrong name": rate(get("faint"), lambda r: r["named"] and not r["first"]),
        "fault found": rate(get("fault"), lambda r: r["found"]),
        "fault named as effect": rate(get("fault"), lambda r: r["verdict"] == "effect" and not r["found"]),
        "robot first": rate(robot, lambda r: r["first"]),
        "robot first two": rate(robot, lambda r: r["first_two"]),
        "radio first": rate(large(get("radio")), lambda r: r["first"]),
        # Lost packets are in no model: that something remains is true there, a name is not.
        "radio false name": rate(get("radio-control"), lambda r: bool(r["named"])),
        "reduction median": median(reductions),
        "reduction p10": quantile(reductions, 0.1),
        "reduction cases": len(reductions),
        "parameter error median": median([e for r in both for e in r["parameter_errors"]]),
        "base bias median": median([e for r in both for e in r["bias"]]),
        "calibration error": expected_calibration_error([c for r in rows for c in r["confidence"]]),
        "no answer": rate(rows, lambda r: not r["answered"]),
    }
