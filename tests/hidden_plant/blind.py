#!/usr/bin/env python3
"""The sealed test of the diagnosis: makes records with something hidden in them, lets the program say what it is, scores it.

    blind.py --program build/release/tools/omnihil [--set dev|release|sealed] [--only CLASS[,CLASS]] [--cases N]
             [--skip N] [--jobs N] [--keep DIR] [--generate-only] [--json OUT]
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import shutil
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import cases  # noqa: E402
import run_program  # noqa: E402
import score  # noqa: E402
import table  # noqa: E402

SKIPPED = 77


def arguments():
    parser = argparse.ArgumentParser(prog="./dev blind", description="the sealed test of the diagnosis")
    parser.add_argument("--program", type=pathlib.Path, help="the program to test")
    parser.add_argument(
        "--set", choices=cases.SETS[:2], default="dev", help="dev: open, to develop against (default)"
    )
    parser.add_argument("--sealed", action="store_true", help="the third set, for a closing score only")
    parser.add_argument("--only", help="classes, separated by commas: " + ", ".join(cases.classes()))
    parser.add_argument("--cases", type=int, help="at most so many of each class")
    parser.add_argument(
        "--skip", type=int, default=0, help="not the first so many of each class, as those developed against"
    )
    parser.add_argument("--jobs", type=int, default=2, help="cases at a time (2)")
    parser.add_argument(
        "--keep",
        type=pathlib.Path,
        help="folder for cases, answers and results; what is there is not done again",
    )
    parser.add_argument(
        "--generate-only", action="store_true", help="write the cases and their answers, run nothing"
    )
    parser.add_argument("--timeout", type=float, default=600, help="seconds one diagnosis may take (600)")
    parser.add_argument("--no-oracle", action="store_true", help="leave out the fits of the true effect")
    parser.add_argument("--json", type=pathlib.Path, help="every result and the table, as JSON")
    parser.add_argument(
        "--reduced",
        action="store_true",
        help="a few cases of each class of the open set; exit 1 when a score is below its floor (for ctest)",
    )
    return parser.parse_args()


def generate(case, keep):
    """Writes case and answer unless they are there. The answer comes last: it says that the case is whole."""
    answer_path = keep / "answers" / case.set / f"{case.name}.json"
    if answer_path.exists():
        return json.loads(answer_path.read_text())
    folder = keep / "cases" / case.set / case.name
    shutil.rmtree(folder, ignore_errors=True)
    answer = cases.make(case, folder)
    answer_path.parent.mkdir(parents=True, exist_ok=True)
    part = answer_path.with_suffix(f".{os.getpid()}")
    part.write_text(json.dumps(answer, indent=1, sort_keys=True) + "\n")
    part.replace(answer_path)
    return answer


def work(case, keep, args, stamp):
    """Makes a case, lets the program diagnose it, judges. What was done by this very program is not done again."""
    answer = generate(case, keep)
    if args.generate_only:
        return None
    path = keep / "results" / case.set / stamp / f"{case.name}.json"
    folder = keep / "cases" / case.set / case.name
    result = run_program.read_json(path)
    if result is None:
        result = run_program.diagnose(args.program, folder, args.timeout, 1)
        result["of_the_run_s"] = result["seconds"] / args.jobs  # its part of the whole run's time
    wants_oracle = case.cls in ("single", "generic") and not args.no_oracle and not result.get("oracle")
    if wants_oracle and min(e["share"] for e in answer["effects"]) >= score.LEAST_SHARE:
        result["oracle"] = run_program.oracle(args.program, folder, answer, args.timeout)
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_suffix(f".{os.getpid()}")
    part.write_text(json.dumps(result) + "\n")
    part.replace(path)
    return score.judge(result, answer)


def has_verbs(program, *verbs):
    """Does the program have what is to be tested?"""
    if not program or not program.exists():
        return False
    return all(run_program.call(program, [verb, "--help"], 120, None)["code"] == 0 for verb in verbs)


def run_all(todo, keep, args, stamp):
    """All cases, several at a time; progress on stderr. Results come back in the order of the list."""
    rows = {}
    with concurrent.futures.ProcessPoolExecutor(args.jobs) as pool:
        jobs = {pool.submit(work, case, keep, args, stamp): case for case in todo}
        for done, job in enumerate(concurrent.futures.as_completed(jobs), 1):
            case, row = jobs[job], job.result()
            rows[case.key] = row
            if row:
                said = " + ".join(row["named"]) or "-"
                print(
                    f"{done}/{len(jobs)} {case.cls} {case.name}: {row['verdict'] or 'no answer'} {said} ({row['seconds']:.0f} s)",
                    file=sys.stderr,
                    flush=True,
                )
            elif done % 10 == 0 or done == len(jobs):
                print(f"{done} of {len(jobs)} cases written", file=sys.stderr, flush=True)
    return [rows[case.key] for case in todo]


def main():
    args = arguments()
    set_name = "sealed" if args.sealed else args.set
    only = args.only.split(",") if args.only else None
    unknown = set(only or ()) - set(cases.classes())
    if unknown:
        print(
            f"blind: no such class: {', '.join(sorted(unknown))}; there are {', '.join(cases.classes())}",
            file=sys.stderr,
        )
        return 2
    if args.program:
        args.program = args.program.resolve()
    if not args.generate_only and not has_verbs(args.program, "diagnose"):
        print(f"blind: skipped: {args.program} has no verb diagnose")
        return SKIPPED
    if not (args.generate_only or args.no_oracle or has_verbs(args.program, "fit", "compare")):
        print(
            "blind: without the verbs fit and compare there is no oracle: the error reduction is not scored",
            file=sys.stderr,
        )
        args.no_oracle = True
    if args.generate_only and args.sealed:
        print("blind: sealed cases are made only to be scored", file=sys.stderr)
        return 2
    todo = cases.reduced() if args.reduced else cases.list_cases(set_name, only, args.cases, args.skip)
    stamp = "" if args.generate_only else hashlib.sha256(args.program.read_bytes()).hexdigest()[:12]
    with tempfile.TemporaryDirectory(prefix="blind-") as scratch:
        keep = (args.keep or pathlib.Path(scratch)).resolve()
        rows = run_all(todo, keep, args, stamp)
        if args.generate_only:
            print(f"cases: {keep / 'cases' / set_name}; answers: {keep / 'answers' / set_name}")
            return 0
    figures = score.summary(rows)
    table.print_all(rows, figures)
    if args.json:
        args.json.write_text(
            json.dumps({"set": set_name, "program": stamp, "figures": figures, "cases": rows}, indent=1)
            + "\n"
        )
    low = table.below_floor(figures) if args.reduced else []
    for line in low:
        print(f"below the floor: {line}")
    return 1 if low else 0


if __name__ == "__main__":
    sys.exit(main())
