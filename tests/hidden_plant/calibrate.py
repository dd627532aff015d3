"""Fits the map from what a diagnosis knows of a name to the probability that the name is right.

    ./dev blind --cases 66 --only single,generic,pair,control,loop,loop-control,outside,faint,beside --keep run/blind
    python3 tests/hidden_plant/calibrate.py run/blind dev

Two maps: one for answers that leave nothing, one for those beside which structure remains. Prints the coefficients of both
for identify/select/confidence.cc, and the reliability of predictions of cases that a fit has not seen (ten folds by case).
Logistic regression with a ridge (le Cessie, van Houwelingen, Appl. Statist. 41(1), 1992):
maximum likelihood has no end where a feature separates the wrong names.
"""
import argparse
import json
import math
import pathlib
import zlib

import score
import table

RIDGE = 1.0  # prior precision of the slopes of standardised features: one unit of logit each; a choice
FOLDS = 10
# From here on the made records hold too few names to tell; measured ones go further.
MOST_OVER_NOISE = 2.0
LEAST_REMAINING = 1e-3  # of the base model's energy: below, the noise's level is not known that well
FEATURES = {
    "found": ("one", "later", "log10_share_of_base", "selection_frequency", "undecided", "log10_error_over_noise"),
    "found, but more remains": ("one", "later", "log10_share_over_remaining", "selection_frequency", "undecided"),
}


def over_noise(diagnosis, errors):
    """Pooled error of a model's runs over the sensors' noise, at least 1; errors: {signal: {"rmse": …}}, may be empty."""
    sigma = {k: v.get("noise_sigma") for k, v in (diagnosis.get("signals") or {}).items()}
    value = score.pooled(errors, sigma) if errors else 1.0
    return max(value, 1.0) if math.isfinite(value) else 1.0


def share_of_step(diagnosis, before, after):
    """What a step removes of the base model's energy above the noise, on held-out runs."""
    square = [over_noise(diagnosis, m.get("holdout")) ** 2 for m in (diagnosis.get("baseline") or {}, before, after)]
    return min(max((square[1] - square[2]) / (square[0] - 1.0), 0.0), 1.0) if square[0] > 1.0 else 0.0


def rounds(diagnosis):
    """{effect: its row of the ranking that it was taken from}; of two taken together the share is what both remove."""
    ladder, out = diagnosis.get("ladder") or [], {}
    for step, taken in zip(ladder, ladder[1:]):
        names = taken["added"].split(" and ")
        least = share_of_step(diagnosis, step, taken) if len(names) > 1 else 0.0
        for r in step.get("ranking") or []:
            if r["effect"] in names:
                out[r["effect"]] = {**r, "share_of_base": max(r.get("share_of_base") or 0.0, least)}
    for step in ladder:
        if " in place of " in step["added"]:
            new, old = step["added"].split(" in place of ")
            out[new] = out.get(old, {})
    return out


def evidence(diagnosis):
    """One table per name of the answer: [(name, {feature: value})]."""
    taken, out = rounds(diagnosis), []
    last, base = max(
        (
            [over_noise(diagnosis, (diagnosis.get(model) or {}).get(split)) for model in ("final", "baseline")]
            for split in ("holdout", "fit")
        ),
        key=lambda both: both[0],
    )
    remaining = (last**2 - 1.0) / max(base**2 - 1.0, 1e-9)
    for position, name in enumerate(diagnosis.get("effects") or []):
        r = taken.get(name, {})
        by_noise = next(
            (q["noise_share"] for q in diagnosis["ranking"] if q["effect"] == name and q["accepted_by"] == "noise"), 0.0
        )
        share = min(max(by_noise or r.get("share_of_base") or 0.0, 1e-3), 1.0)
        table = {
            "one": 1.0,
            "later": float(position > 0),
            "log10_share_of_base": math.log10(share),
            "log10_share_over_remaining": math.log10(share / min(max(remaining, LEAST_REMAINING), 1.0)),
            "selection_frequency": 1.0 if by_noise else r.get("selection_frequency") or 0.0,
            "undecided": float(any(name in s and len(s) > 1 for s in diagnosis.get("indistinguishable") or [])),
            "log10_error_over_noise": math.log10(min(last, MOST_OVER_NOISE)),
        }
        out.append((name, table))
    return out


def features(diagnosis):
    """The regression's rows of the answer's names: [(name, x)]."""
    wanted = FEATURES[diagnosis["outcome"]]
    return [(name, [table[f] for f in wanted]) for name, table in evidence(diagnosis)]


def probability(x, beta):
    return 1.0 / (1.0 + math.exp(-sum(a * b for a, b in zip(x, beta))))


def solve(a, b):
    """Gauss-Jordan with pivots."""
    n = len(b)
    m = [row[:] + [v] for row, v in zip(a, b)]
    for i in range(n):
        p = max(range(i, n), key=lambda r: abs(m[r][i]))
        m[i], m[p] = m[p], m[i]
        for r in range(n):
            if r != i:
                f = m[r][i] / m[i][i]
                m[r] = [u - f * v for u, v in zip(m[r], m[i])]
    return [m[i][n] / m[i][i] for i in range(n)]


def fit(rows):
    """Newton's method on the penalised log-likelihood; rows: [(x, right)]."""
    k = len(rows[0][0])
    scale = [1.0] + [
        max(math.sqrt(sum((x[j] - sum(y[j] for y, _ in rows) / len(rows)) ** 2 for x, _ in rows) / len(rows)), 1e-3)
        for j in range(1, k)
    ]
    beta = [0.0] * k
    for _ in range(50):
        gradient = [-RIDGE * beta[j] * scale[j] ** 2 if j else 0.0 for j in range(k)]
        hessian = [[(RIDGE * scale[j] ** 2 if j else 1e-9) * (i == j) for i in range(k)] for j in range(k)]
        for x, right in rows:
            p = probability(x, beta)
            for j in range(k):
                gradient[j] += (right - p) * x[j]
                for i in range(k):
                    hessian[j][i] += p * (1 - p) * x[j] * x[i]
        step = solve(hessian, gradient)
        beta = [b + s for b, s in zip(beta, step)]
        if max(map(abs, step)) < 1e-9:
            break
    return beta


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("keep", type=pathlib.Path)
    parser.add_argument("set")
    parser.add_argument("--program", help="name of the folder of results; default: the one that holds the most")
    args = parser.parse_args()
    folders = sorted((args.keep / "results" / args.set).iterdir(), key=lambda p: len(list(p.iterdir())))
    folder = args.keep / "results" / args.set / args.program if args.program else folders[-1]
    cases = {outcome: {} for outcome in FEATURES}
    for path in sorted(folder.glob("*.json")):
        answer = json.loads((args.keep / "answers" / args.set / path.name).read_text())
        diagnosis = json.loads(path.read_text()).get("diagnosis")
        if diagnosis and diagnosis.get("effects"):
            cases[diagnosis["outcome"]][path.stem] = [
                (x, any(score.matches(name, e, diagnosis) for e in answer["effects"]))
                for name, x in features(diagnosis)
            ]
    for outcome, of in cases.items():
        if of:
            print_map(outcome, of)


def print_map(outcome, cases):
    """Reliability of unseen cases and the coefficients of one outcome's map; cases: {case: [(x, right)]}."""
    rows = [row for case in cases.values() for row in case]
    print(f"{outcome}: {len(cases)} cases, {len(rows)} names, {sum(right for _, right in rows)} of them right")
    predicted = []
    for fold in range(FOLDS):
        held = {c for c in cases if zlib.crc32(c.encode()) % FOLDS == fold}
        seen = [row for c, case in cases.items() if c not in held for row in case]
        beta = fit(seen) if held and seen else None
        predicted += [(probability(x, beta), right) for c in held if beta for x, right in cases[c]]
    print("Reliability of predictions of cases not fitted to")
    print("\n".join(table.reliability(predicted)))
    print("Coefficients of the fit to all")
    for name, b in zip(FEATURES[outcome], fit(rows)):
        print(f"  {name:26s} {b:8.3f}")


if __name__ == "__main__":
    main()
