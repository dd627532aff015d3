#!/usr/bin/env python3
"""The page docs/measured-sets.md, from what `./dev bench diagnose` left in its folder of results.

    measured_sets.py [--results DIR] [--shared DIR] [--write [PAGE]]      without --write: to stdout

What a set is, its licence and the best known figures are read from the README of the shared data; verdicts, errors and times
from the results. A set without a result keeps what the page says of it, else it is said to have none. Results named SET_… that
the README does not know are another dataset of the same recordings, by an example's script. What stands in a set's way is
written by hand, in docs/measured-sets-remarks.toml.
"""
import argparse
import json
import os
import pathlib
import re
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
REMARKS = ROOT / "docs/measured-sets-remarks.toml"
USES = ("fit", "holdout", "extrapolation")
TOLERATED = 1.05  # times the best known error: beyond it the page says missed
# Words of a section of the README -> signal, field of the comparison, factor, unit. Sections with none of them measure otherwise.
MEASURES = (
    ("relative force error", None, "relative_force_error", 100.0, "%"),
    ("position mae, mrad", "position", "mean_absolute", 1000.0, "mrad"),
    ("rmse in rad/s", "velocity", "rmse", 1.0, "rad/s"),
)


def cells(line):
    return [c.strip() for c in line.strip().strip("|").split("|")]


def tables(text):
    """Every table of a Markdown text: (heading cells, rows)."""
    for block in re.findall(r"(?:^\|.*\n?)+", text, re.M):
        lines = block.strip().splitlines()
        if len(lines) > 2:
            yield cells(lines[0]), [cells(line) for line in lines[2:]]


def names_of(cell):
    """`left`, `_right` is two sets: the second name ends the first one's stem."""
    names = re.findall(r"`([^`]+)`", cell)
    stem = names[0].rpartition("_")[0] if names else ""
    return [stem + n if n.startswith("_") else n for n in names]


def sets_of(readme):
    """Set -> what the README's table says of it, by heading; "the same" is what the row above says."""
    head, rows = next(tables(readme))
    for above, row in zip(rows, rows[1:]):
        row[:] = [before if cell == "the same" else cell for before, cell in zip(above, row)]
    return {name: dict(zip(head, row)) for row in rows for name in names_of(row[0])}


def section_of(readme, name):
    """The section of reference figures that is about a set: its heading's list names it, or its name's beginning."""
    for part in re.split(r"^### ", readme, flags=re.M)[1:]:
        part = re.split(r"^##? ", part, flags=re.M)[0]
        for named in (n.strip() for n in part.splitlines()[0].split(":")[0].split(",")):
            if named == name or name in (named + "_left", named + "_right"):
                return part
    return ""


def figures(cell):
    """"3.94 / - / 3.15 (k 4)": a figure for each use that has one."""
    parts = [p.strip(" *") for p in re.sub(r"\(.*?\)", "", cell).split("/")]
    return {use: float(p) for use, p in zip(USES, parts) if re.fullmatch(r"\d+(\.\d+)?", p)}


def best_known(section, name):
    for head, rows in tables(section):
        for row in rows:
            if "best known" in head and name in names_of(row[0]):
                return figures(row[head.index("best known")])
            if row[0].strip("* ") == "best known":
                slashed = [k for k, h in enumerate(head) if " / " in h]
                if slashed:
                    return figures(row[slashed[0]])
                columns = {use: k for use in USES for k, h in enumerate(head) if h.split()[:1] == [use]}
                return {use: value for use, k in columns.items() for value in [figures(row[k]).get("fit")] if value}
    return {}


def measure_of(section):
    return next((m for m in MEASURES if m[0] in section.lower()), None)


def compared(comparison, measure, use):
    """The error of the last model in the README's measure; None where there is none."""
    _, signal, field, factor, _ = measure
    value = (comparison.get(field) or {}).get(use) if signal is None else ((comparison.get(use) or {}).get(signal) or {}).get(field)
    return None if value is None else factor * value


def number(value):
    return "–" if value is None else f"{value:.4g}"


def beside_best_known(section, name, comparison):
    """Lines, and by how many per cent each use misses the best known figure."""
    if not section:
        return ["The README has no reference figures of this set."], {}
    measure, best = measure_of(section), best_known(section, name)
    if not measure or not best:
        body = section.partition("\n")[2].strip()
        return ["The README's figures of this set are of another quantity than those above: not compared. They are:", "", body], {}
    lines = [f"Beside the best known model of the README, in its measure ({measure[0]}):", "",
             f"| runs | with the effects, {measure[4]} | best known, {measure[4]} | |", "|---|---|---|---|"]
    misses = {}
    for use, figure in best.items():
        value = compared(comparison, measure, use)
        said = "no figure" if value is None else "reached"
        if value is not None and value > TOLERATED * figure:
            misses[use] = 100.0 * (value / figure - 1.0)
            said = f"**missed by {misses[use]:.0f} %**"
        lines.append(f"| {use} | {number(value)} | {number(figure)} | {said} |")
    return lines, misses


def error_table(d):
    lines = ["| signal | runs | base model, refitted | with the effects | unit | over the sensors' noise |", "|---|---|---|---|---|---|"]
    for signal, about in d["signals"].items():
        for use in USES:
            before = d["baseline"].get(use, {}).get(signal, {}).get("rmse")
            after = d["final"].get(use, {}).get(signal, {}).get("rmse")
            if before is None and after is None:
                continue
            noise = f"{after / about['noise_sigma']:.3g} ×" if after and about["noise_sigma"] else "–"
            lines.append(f"| `{signal}` | {use} | {number(before)} | {number(after)} | {about['unit']} | {noise} |")
    return lines


def unexplained(d):
    """What the program itself says that it does not explain."""
    lines = [f"* {f['grade']} of the data: {f['sentence']}" for f in d["findings"] if f["grade"] != "note"]
    if d["unknown"]["sentence"]:
        lines.append(f"* {d['unknown']['sentence']}")
    if d["unknown"]["formula"]:
        lines.append(f"* Proposed formula: `{d['unknown']['formula']}`")
    for w in d["where"][:3]:
        share = w["explained_fraction"]
        lines.append(f"* {w['signal']} against {w['against']}: {100 * share:.0f} % of the residual" if share is not None else "")
    lines += [f"* Not told apart: {', '.join(members)}" for members in d["indistinguishable"]]
    for path, p in d["final"]["parameters"].items():
        if p["at_bound"]:
            lines.append(f"* `{path}` {p.get('sentence') or 'at its bound'}")
    return ["What is not explained, in the program's words:", ""] + [line for line in lines if line] if lines else []


def section(name, facts, readme, results):
    """The lines of one set, and its row in the table at the top."""
    lines = [f"## {name}", ""]
    lines += [f"* {head}: {facts[head]}" for head in list(facts)[1:] if facts[head] not in ("", "–")]
    if "none stated" in facts.get("licence", ""):
        lines.append("* no licence is stated: figures alone, the records are not passed on")
    entry_path, said_path = results / f"{name}.run.json", results / f"{name}.diagnosis.json"
    if not entry_path.exists():
        return lines + ["", "Not run: no result of this set."], f"| [{name}](#{name}) | not run | | | |"
    entry = json.loads(entry_path.read_text())
    first = "none" if entry["first_wall_s"] is None else f"{entry['first_wall_s']:.1f} s"
    lines += [f"* sha256 of the data: `{entry['data_sha256']}`", f"* program: {entry['program']}",
              f"* CPU {entry['cpu_s']:.1f} s, wall time {entry['wall_s']:.1f} s, first ranking {first}", ""]
    if not said_path.exists():
        why = f"Not done within {entry['limit_s']:.0f} s." if entry["timed_out"] else f"Exit code {entry['exit']}."
        return lines + [f"No answer. {why}"], f"| [{name}](#{name}) | no answer | | {entry['cpu_s']:.1f} | |"
    d = json.loads(said_path.read_text())
    effects = ", ".join(f"`{e}`" for e in d["effects"]) or "none"
    lines += [f"Verdict: **{d['outcome']}**. Effects: {effects}.", "", *error_table(d), ""]
    comparison_path = results / f"{name}.compare.json"
    comparison = json.loads(comparison_path.read_text()) if comparison_path.exists() else {}
    beside, misses = beside_best_known(section_of(readme, name), name, comparison)
    if left_out := comparison.get("left_out"):
        lines += ["Not compared: " + "; ".join(left_out) + ".", ""]
    lines += [*beside, "", *unexplained(d)]
    missed = ", ".join(f"{use} by {by:.0f} %" for use, by in misses.items())
    reached = any(line.endswith("| reached |") for line in beside)
    known = f"missed: {missed}" if missed else "reached" if reached else "not compared"
    return lines, f"| [{name}](#{name}) | {d['outcome']} | {effects} | {entry['cpu_s']:.1f} | {known} |"


def kept(old, name):
    """The section of a set on the page that is there, and its row; None where it has none."""
    part = re.search(rf"^## {re.escape(name)}\n.*?(?=^## |\Z)", old, re.M | re.S)
    row = re.search(rf"^\| \[{re.escape(name)}\].*$", old, re.M)
    return (part[0].rstrip(), row[0]) if part and row else None


def names_with_parts(sets, results, old):
    """Names of the README, each followed by those of further datasets of it."""
    of_results = {f.name.removesuffix(".run.json") for f in results.glob("*.run.json")}
    further = (of_results | set(re.findall(r"^## (\S+)$", old, re.M))) - set(sets)
    for name in sets:
        yield name, name
        for part in sorted(n for n in further if n.startswith(name + "_")):
            yield part, name


def remarked(body, remark):
    """A section with what was written by hand of its set, in place of what stood there."""
    body = re.sub(r"\n\nWritten by hand\. .*\Z", "", body, flags=re.S)
    if not remark:
        return body
    return f"{body}\n\nWritten by hand. In the way: {remark['in_the_way']}. It would settle it: {remark['would_settle']}."


def page(readme, results, old="", remarks=None):
    parts, rows = [], []
    sets = sets_of(readme)
    for name, of_set in names_with_parts(sets, results, old):
        before = None if (results / f"{name}.run.json").exists() else kept(old, name)
        if before is None:
            facts = dict(sets[of_set])
            entry = results / f"{name}.run.json"
            if made := json.loads(entry.read_text()).get("imported") if entry.exists() else None:
                facts["dataset"] = made
            lines, row = section(name, facts, readme, results)
            before = "\n".join(lines).rstrip(), row
        parts.append(remarked(before[0], (remarks or {}).get(name)))
        rows.append(before[1])
    head = f"""# What the diagnosis says of measured records

Made by `./dev bench diagnose`, then `python3 tools/measured_sets.py --write`, from the results and from the README of the shared data: do not
edit. Real recordings, published by others; nobody knows what they lack. Errors are RMSE of model minus measurement. "Missed" is
an error more than {100 * (TOLERATED - 1):.0f} % above that of the best model known to the README. CPU is user and system time of all threads.

| set | verdict | effects | CPU s | best known |
|---|---|---|---|---|
"""
    return head + "\n".join(rows) + "\n\n" + "\n\n".join(parts) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "run/diagnose", help="folder of ./dev bench diagnose")
    parser.add_argument("--shared", type=pathlib.Path, default=os.environ.get("OMNIHIL_SHARED"), help="shared folder ($OMNIHIL_SHARED)")
    parser.add_argument("--write", type=pathlib.Path, nargs="?", const=ROOT / "docs/measured-sets.md", help="the page to write")
    args = parser.parse_args()
    if not args.shared or not (args.shared / "data/README.md").exists():
        print("measured_sets: skipped: no data/README.md in OMNIHIL_SHARED", file=sys.stderr)
        return 77
    there = args.write or ROOT / "docs/measured-sets.md"
    old = there.read_text(encoding="utf-8") if there.exists() else ""
    remarks = tomllib.loads(REMARKS.read_text(encoding="utf-8"))
    text = page((args.shared / "data/README.md").read_text(encoding="utf-8"), args.results, old, remarks)
    if args.write:
        args.write.write_text(text, encoding="utf-8")
    else:
        sys.stdout.write(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
