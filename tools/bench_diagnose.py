#!/usr/bin/env python3
"""What a diagnosis costs and says: `./dev bench diagnose [SET…]`.

Runs `omnihil diagnose` on every measured set in $OMNIHIL_SHARED/data and on open cases of the sealed test, one at a time,
and prints a row for each. Results stay in a folder; what the same program said of the same data is not asked again.

CPU is user and system time of the process. On idle cores nothing waits, so wall time is at most CPU time there: what
somebody waits for, the first ranking and the whole, is judged by the smaller of the two, which bounds it from above beside
other work.
"""
import argparse
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading
import time
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
FIRST_S = 15.0  # to the first ranking: somebody waits for it
# Raw recordings that an example's script makes datasets of, and the name of each of its folders that is diagnosed.
IMPORTED = {"kiwi_omni": ("examples/import/kiwi_omni.sh", {"robot": "kiwi_omni", "commanded": "kiwi_omni_commanded"})}
WHOLE_S = {"axis": 60.0, "robot": 120.0}  # for everything: a coffee is not worth fetching


def arguments():
    parser = argparse.ArgumentParser(prog="./dev bench diagnose", description="what a diagnosis costs and says")
    parser.add_argument("sets", nargs="*", help="names of sets; none: all of them")
    parser.add_argument("--program", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "run/diagnose", help="folder of what was said")
    parser.add_argument("--limit", type=float, default=300.0, help="seconds of wall time one diagnosis may take (300)")
    parser.add_argument("--blind", type=int, default=20, help="so many open cases of the sealed test (20)")
    parser.add_argument("--jobs", type=int, default=2, help="threads of a diagnosis (2)")
    parser.add_argument("--again", action="store_true", help="run also what is there already")
    return parser.parse_args()


def data_sha256(folder):
    """That of `LC_ALL=C sha256sum *.csv *.toml | sha256sum`, sorted by name: the data without their README."""
    files = sorted((f for f in folder.iterdir() if f.suffix in (".csv", ".toml")), key=lambda f: f.name)
    lines = "".join(f"{hashlib.sha256(f.read_bytes()).hexdigest()}  {f.name}\n" for f in files)
    return hashlib.sha256(lines.encode()).hexdigest()


def rig_of(folder):
    return tomllib.loads((folder / "dataset.toml").read_text()).get("rig", "axis")


def imported(name, recordings, args):
    """The datasets that an example's script makes of recordings; none where it fails."""
    script, parts = IMPORTED[name]
    folders = []
    with tempfile.TemporaryDirectory() as made:
        run = subprocess.run([ROOT / script, recordings, made, args.program], capture_output=True, text=True, check=False)
        if run.returncode != 0:
            print(f"{name}: {script}: exit code {run.returncode}: {run.stderr.strip()[-300:]}", file=sys.stderr)
            return []
        for part, called in parts.items():
            folders.append(args.results / "imported" / called)
            shutil.rmtree(folders[-1], ignore_errors=True)
            shutil.copytree(pathlib.Path(made) / part, folders[-1])
    return folders


def made_by(called):
    """What a dataset was made by, and which of it; None of one that is there as it is."""
    for script, parts in IMPORTED.values():
        for part, name in parts.items():
            if name == called:
                return f"`{script}`, its folder `{part}`"
    return None


def measured_sets(args):
    """Folders of the shared data, or the reason why there are none."""
    names = args.sets
    shared = os.environ.get("OMNIHIL_SHARED")
    if not shared:
        return [], "OMNIHIL_SHARED is not set"
    data = pathlib.Path(shared) / "data"
    if not data.is_dir():
        return [], f"{data} is no folder"
    found = [f.parent for f in data.glob("*/dataset.toml") if not names or f.parent.name in names]
    raw = [n for n in IMPORTED if (data / n).is_dir() and not (data / n / "dataset.toml").exists() and (not names or n in names)]
    found += [f for n in raw for f in imported(n, data / n, args)]
    return sorted(found, key=lambda f: f.name), ""


def blind_cases(count, results):
    """The first open cases of every class in turn, made where they are not there; or the reason why there are none."""
    if count <= 0:
        return [], "--blind 0"
    if not os.environ.get("HIDDEN_PLANT_LIBRARY"):
        return [], "the hidden plant is not built"
    blind = ROOT / "tests/hidden_plant/blind.py"
    words = [sys.executable, blind, "--generate-only", "--keep", results / "blind", "--cases", str(count // 11 + 1)]
    made = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False)
    if made.returncode != 0:
        return [], "they could not be made: " + (made.stderr.strip().splitlines() or ["no reason given"])[-1]
    answers = [json.loads(f.read_text()) for f in sorted((results / "blind/answers/dev").glob("*.json"))]
    answers.sort(key=lambda a: (a["index"], a["class"]))
    return [results / "blind/cases/dev" / a["case"] for a in answers[:count]], ""


def cpu_s_of(pid):
    """User and system time so far; None where it cannot be read."""
    try:
        fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    except (OSError, ValueError, IndexError):
        return None


def timed(words, limit_s, out):
    """Runs a diagnosis; what it prints goes to `out`. Its times, and those of its first ranking."""
    run = {"first_wall_s": None, "first_cpu_s": None, "timed_out": False, "limit_s": limit_s}
    start = time.monotonic()
    with open(out, "w", encoding="utf-8") as text:
        process = subprocess.Popen(words, stdout=text, stderr=subprocess.PIPE, text=True, errors="replace")

        def kill():
            run["timed_out"] = True
            process.kill()

        timer = threading.Timer(limit_s, kill)
        timer.start()
        said = []
        for line in process.stderr:
            said.append(line)
            if "first ranking: " in line and run["first_wall_s"] is None:
                run["first_wall_s"], run["first_cpu_s"] = time.monotonic() - start, cpu_s_of(process.pid)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        timer.cancel()
    run |= {"wall_s": time.monotonic() - start, "cpu_s": usage.ru_utime + usage.ru_stime, "exit": process.returncode}
    run["stderr"] = "".join(said)[-2000:]
    return run


def diagnosed(folder, args, program):
    """What the program says of a set, from the results where they hold; its entry."""
    out = args.results / f"{folder.name}.json"
    said, entry_path = out.with_suffix(".diagnosis.json"), out.with_suffix(".run.json")
    key = {"set": folder.name, "rig": rig_of(folder), "data_sha256": data_sha256(folder), **program, "jobs": args.jobs}
    old = json.loads(entry_path.read_text()) if entry_path.exists() else {}
    if not args.again and old.items() >= key.items() and (not old["timed_out"] or old["limit_s"] >= args.limit):
        return old
    said.unlink(missing_ok=True)
    model, comparison = out.with_suffix(".model.toml"), out.with_suffix(".compare.json")
    comparison.unlink(missing_ok=True)
    words = [args.program, "diagnose", folder, "--progress", "--json", said, "--jobs", args.jobs]
    if made := made_by(folder.name):
        key |= {"imported": made}
    entry = key | timed(list(map(str, words)), args.limit, out.with_suffix(".txt"))
    if said.exists():
        d = json.loads(said.read_text())
        entry |= {"verdict": d["outcome"], "effects": d["effects"]}
        if "\n" in d["final"]["model"]:
            model.write_text(d["final"]["model"])
            words = [args.program, "compare", folder, "--model", model, "--json", comparison]
            subprocess.run(list(map(str, words)), capture_output=True, check=False, timeout=300)
    entry_path.write_text(json.dumps(entry, indent=1) + "\n")
    return entry


def missed(entry):
    """Which targets an entry misses, in words."""
    out = []
    first = [s for s in (entry["first_wall_s"], entry["first_cpu_s"]) if s is not None]
    if first and min(first) > FIRST_S:
        out.append("first ranking")
    if entry["timed_out"]:
        out.append(f"not done in {entry['limit_s']:.0f} s")
    elif min(entry["wall_s"], entry["cpu_s"]) > WHOLE_S[entry["rig"]]:
        out.append("whole")
    return "missed: " + ", ".join(out) if out else ""


def row(entry):
    first = "-" if entry["first_wall_s"] is None else f"{entry['first_wall_s']:.1f}"
    first_cpu = "-" if entry["first_cpu_s"] is None else f"{entry['first_cpu_s']:.1f}"
    verdict = entry.get("verdict") or ("cut off" if entry["timed_out"] else f"exit code {entry['exit']}")
    effects = " + ".join(entry.get("effects", [])) or "-"
    return (f"{entry['set']:<30} {first:>7} {first_cpu:>7} {entry['wall_s']:>7.1f} {entry['cpu_s']:>7.1f}  "
            f"{verdict:<24} {effects:<44} {missed(entry)}").rstrip()


def main():
    args = arguments()
    args.program, args.results = args.program.resolve(), args.results.resolve()
    args.results.mkdir(parents=True, exist_ok=True)
    version = subprocess.run([args.program, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    program = {"program": version, "program_sha256": hashlib.sha256(args.program.read_bytes()).hexdigest()}
    print(f"omnihil {version}; targets: first ranking within {FIRST_S:.0f} s; everything within {WHOLE_S['axis']:.0f} s "
          f"on an axis, {WHOLE_S['robot']:.0f} s on a robot, on {args.jobs} idle cores")
    print(f"{'set':<30} {'first s':>7} {'its CPU':>7} {'wall s':>7} {'CPU s':>7}  {'verdict':<24} effects", flush=True)
    count = count_missed = 0
    for what, (folders, why) in (("measured sets", measured_sets(args)),
                                 ("open cases", ([], "") if args.sets else blind_cases(args.blind, args.results))):
        if why:
            print(f"skipped: {what}: {why}")
        for folder in folders:
            entry = diagnosed(folder, args, program)
            print(row(entry), flush=True)
            count, count_missed = count + 1, count_missed + bool(missed(entry))
    print(f"{count} diagnosed, {count_missed} missed a target; results: {args.results}")
    print(f"processes that wanted a core at the end: {os.getloadavg()[0]:.1f} of {os.cpu_count()}; only on idle cores is a missed "
          "target sure")
    return 1 if count_missed else 0


if __name__ == "__main__":
    sys.exit(main())
