#!/usr/bin/env python3
"""The sealed test of the diagnosis: makes records with something hidden in them, lets the program say what it is, scores it.

    blind.py --program build/release/tools/omnihil [--set dev|release|sealed] [--only CLASS[,CLASS]] [--cases N]
             [--jobs N] [--keep DIR] [--generate-only] [--json OUT]
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import shutil
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import cases  # noqa: E402


def arguments():
    parser = argparse.ArgumentParser(prog="./dev blind", description="the sealed test of the diagnosis")
    parser.add_argument("--program", type=pathlib.Path, help="the program to test")
    parser.add_argument("--set", choices=cases.SETS[:2], default="dev", help="dev: open, to develop against (default)")
    parser.add_argument("--sealed", action="store_true", help="the third set, for a closing score only")
    parser.add_argument("--only", help="classes, separated by commas: " + ", ".join(cases.classes()))
    parser.add_argument("--cases", type=int, help="at most so many of each class")
    parser.add_argument("--jobs", type=int, default=2, help="cases at a time (2)")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for cases, answers and results; what is there is not done again")
    parser.add_argument("--generate-only", action="store_true", help="write the cases and their answers, run nothing")
    parser.add_argument("--timeout", type=float, default=600, help="seconds one diagnosis may take (600)")
    parser.add_argument("--no-oracle", action="store_true", help="leave out the fits of the true effect")
    parser.add_argument("--json", type=pathlib.Path, help="every result and the table, as JSON")
    parser.add_argument("--floors", action="store_true", help="exit 1 when a score is below its floor (for ctest)")
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


def main():
    args = arguments()
    set_name = "sealed" if args.sealed else args.set
    only = args.only.split(",") if args.only else None
    unknown = set(only or ()) - set(cases.classes())
    if unknown:
        print(f"blind: no such class: {', '.join(sorted(unknown))}; there are {', '.join(cases.classes())}", file=sys.stderr)
        return 2
    todo = cases.list_cases(set_name, only, args.cases)
    with tempfile.TemporaryDirectory(prefix="blind-") as scratch:
        keep = (args.keep or pathlib.Path(scratch)).resolve()
        with concurrent.futures.ProcessPoolExecutor(args.jobs) as pool:
            jobs = {pool.submit(generate, case, keep): case for case in todo}
            for done, job in enumerate(concurrent.futures.as_completed(jobs), 1):
                job.result()
                if done % 10 == 0 or done == len(jobs):
                    print(f"{done} of {len(jobs)} cases written", file=sys.stderr, flush=True)
        if args.generate_only:
            print(f"cases: {keep / 'cases' / set_name}; answers: {keep / 'answers' / set_name}")
            return 0
    return 0


if __name__ == "__main__":
    sys.exit(main())
