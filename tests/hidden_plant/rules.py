"""Compares rules of acceptance on what the diagnosis tried: their power, and how often they take what is not there.

    ./dev blind --cases 66 --only single,generic,pair,control,loop,loop-control,faint --keep run/blind
    python3 tests/hidden_plant/rules.py run/blind dev

A trial is one addition that was fitted in full. It is a true one if it adds a hidden effect (or its very law under
another name) to a model whose effects are all hidden ones; a false one if the model has all hidden effects already. All
others (the wrong effect beside a missing one) are not counted: taking the better of two is not the rule's task. A round
is false if the rule takes any of its false trials.
Limit: the trials are those of today's search; another rule would have walked another way from its first other answer.
"""
import argparse
import json
import pathlib

RULES = {
    "today's": lambda r: r["accepted"],
    "today's, without BIC": lambda r: r["accepted"] or "does not pay for its numbers" in r["why"],
    "today's, without model discrepancy": lambda r: r["accepted"] or "the form of an effect" in r["why"],
    "bootstrap: gain above the null's largest (p < 1/13)": lambda r: r["signal_to_null"] > 1,
    "bootstrap: above twice the null's largest": lambda r: r["signal_to_null"] > 2,
    "BIC, effective sample size": lambda r: r["delta_bic"] < 0,
    "BIC, difference above 10": lambda r: r["delta_bic"] < -10,
    "held-out log density, above 2 standard errors": lambda r: r["delta_elpd"] > 2 * r["delta_elpd_se"],
    "... and above 4 nat": lambda r: r["delta_elpd"] > max(4, 2 * r["delta_elpd_se"]),
    "... above 4 standard errors": lambda r: r["delta_elpd"] > 4 * r["delta_elpd_se"],
    "BIC, plausible": lambda r: r["delta_bic"] < 0 and r["plausible"],
    "log density, plausible": lambda r: r["delta_elpd"] > 2 * r["delta_elpd_se"] and r["plausible"],
    "BIC, plausible, model discrepancy": lambda r: r["delta_bic"] < 0 and r["plausible"] and exceeds_form(r),
    "log density, plausible, model discrepancy": lambda r: r["delta_elpd"] > 2 * r["delta_elpd_se"]
    and r["plausible"]
    and exceeds_form(r),
}


def exceeds_form(r):
    """More than 1 % of the base model's error energy, or nearly all that was left (acceptance.cc)."""
    return r["share_of_base"] >= 0.01 or r["holdout_error_ratio"] ** 2 < 0.3


def models(diagnosis):
    """[(effects of the model, rows tried on it)] along the ladder."""
    effects, out = [], []
    for step in diagnosis.get("ladder") or []:
        added = step["added"]
        if added.startswith("removed "):
            effects = [e for e in effects if e != added.removeprefix("removed ")]
        elif " in place of " in added:
            new, old = added.split(" in place of ")
            effects = [new if e == old else e for e in effects]
        elif added not in ("nominal", "base parameters refitted"):
            effects = effects + added.split(" and ")
        tried = [r for r in step.get("ranking") or [] if r["refitted"] and "plausible" in r]
        if tried:
            out.append((effects, tried))
    return out


def trials(diagnosis, answer):
    """[(round's number, is it a true one, row)]"""
    laws = [{e["id"], *e["same_law"]} for e in answer["effects"]]
    out = []
    for n, (effects, tried) in enumerate(models(diagnosis)):
        if any(not any(e in law for law in laws) for e in effects):
            continue  # something false is in the model already
        missing = [law for law in laws if not any(e in law for e in effects)]
        for r in tried:
            is_true = any(r["effect"] in law for law in missing)
            if is_true or not missing:
                out.append((n, is_true, r))
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("keep", type=pathlib.Path)
    parser.add_argument("set")
    parser.add_argument("--program", help="name of the folder of results; default: the one that holds the most")
    args = parser.parse_args()
    folders = sorted((args.keep / "results" / args.set).iterdir(), key=lambda p: len(list(p.iterdir())))
    folder = args.keep / "results" / args.set / args.program if args.program else folders[-1]
    cases, true, false = 0, [], {}
    for path in sorted(folder.glob("*.json")):
        answer = json.loads((args.keep / "answers" / args.set / path.name).read_text())
        diagnosis = json.loads(path.read_text()).get("diagnosis")
        if not diagnosis or answer["class"] == "outside":
            continue
        cases += 1
        for n, is_true, row in trials(diagnosis, answer):
            if is_true:
                true.append(row)
            else:
                false.setdefault((path.stem, n), []).append(row)
    of_false = [r for rows in false.values() for r in rows]
    print(f"{cases} cases; {len(true)} true trials, {len(of_false)} false ones in {len(false)} rounds")
    print("| rule | takes the true | takes the false | false rounds |\n|---|---|---|---|")
    for name, rule in RULES.items():
        taken = (sum(map(bool, map(rule, true))), sum(map(bool, map(rule, of_false))))
        rounds = sum(any(rule(r) for r in rows) for rows in false.values())
        cells = [(taken[0], len(true)), (taken[1], len(of_false)), (rounds, len(false))]
        print(f"| {name} | " + " | ".join(f"{100 * k / n:.1f} % ({k} of {n})" if n else "-" for k, n in cells) + " |")


if __name__ == "__main__":
    main()
