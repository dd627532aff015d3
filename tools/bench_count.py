#!/usr/bin/env python3
"""Host instructions of the benchmarks' rows, by valgrind --tool=callgrind: the same on every machine of one kind, whatever
else runs on it.

    ./dev bench count                     # all rows
    ./dev bench count phase,image         # of two benchmarks
    ./dev bench count --against build/older/bench   # beside another build's

Each row runs twice, the second time longer: the difference has no start of a program in it.
"""
import argparse
import pathlib
import re
import subprocess
import sys

# benchmark, row (its --count argument), shorter and longer run, unit
ROWS = [
    ("loop", "planar", 1000, 3000, "ms"),
    ("loop", "planar_six", 1000, 3000, "ms"),
    ("loop", "simbody", 300, 800, "ms"),
    ("loop", "simbody_six", 300, 800, "ms"),
    ("physics", "5x1", 20, 60, "ms"),
    ("physics", "8x12", 20, 60, "ms"),
    ("physics", "12x12", 20, 60, "ms"),
    ("phase", "dq", 200, 1200, "step"),
    ("phase", "averaged_duty_1", 200, 1200, "step"),
    ("phase", "averaged_dead_time", 200, 1200, "step"),
    ("phase", "averaged_chop", 200, 1200, "step"),
    ("phase", "switched", 200, 1200, "period"),
    ("phase", "switched_chop", 200, 1200, "period"),
    ("drive", "plant", 40, 160, "sub-step"),
    ("drive", "none", 40, 160, "sub-step"),
    ("drive", "five", 40, 160, "sub-step"),
    ("image", None, 1, 2, "s"),
]


def instructions(command):
    """(instructions, units printed) of one run."""
    run = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *command],
                         capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", run.stderr).group(1)), run.stdout.strip()


def per_unit(folder, bench, row, short, long):
    first, second = (instructions([folder / f"bench_{bench}", "--count", *([row] if row else []), str(n)])
                     for n in (short, long))
    units = long - short if bench == "image" else int(second[1]) - int(first[1])
    return (second[0] - first[0]) / units


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("only", nargs="?", default="", help="benchmarks, separated by commas")
    parser.add_argument("--programs", type=pathlib.Path, required=True)
    parser.add_argument("--against", type=pathlib.Path, help="folder of another build's benchmarks")
    args = parser.parse_args()
    only = args.only.split(",") if args.only else []
    unknown = sorted(set(only) - {bench for bench, *_ in ROWS})
    if unknown:
        print(f"{', '.join(unknown)}: no such rows; allowed: {', '.join(dict.fromkeys(b for b, *_ in ROWS))}",
              file=sys.stderr)
        return 2
    for bench, row, short, long, unit in ROWS:
        if only and bench not in only:
            continue
        now = per_unit(args.programs, bench, row, short, long)
        line = f"{bench:8s} {row or 'wheel loops':20s} {now:15,.1f} / {unit:8s}"
        if args.against:
            before = per_unit(args.against, bench, row, short, long)
            line += f" {before:15,.1f}  {100 * (now / before - 1):+6.2f} %"
        print(line, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
