#!/usr/bin/env python3
"""How often the live twin is wrong, and how soon it is right: hidden robots that break while they drive, watched by `omnihil twin`.

    twin.py --robots 3 --healthy 3600 [--faults torque,encoder] [--keep FOLDER]

Per robot: a model fitted to a drive of 60 s and its card, a healthy drive, and each fault on a wheel in turn. Prints a line per
record and the shares at the end; 1 when something was not as it should be.
"""
import argparse
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import twin_case

LEARN_S, BREAKS_S, AFTER_S = 60.0, 80.0, 20.0
WITHIN_S = 5.0
KINDS = ("random_drive", "hard_starts", "directions")


def omnihil(program, *words):
    done = subprocess.run([program, *map(str, words)], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        raise RuntimeError(f"{' '.join(map(str, words))}\n{done.stdout}{done.stderr}")
    return done.stdout


class Owner:
    """A robot, a model of it that was fitted, and the model's card."""

    def __init__(self, program, folder, seed, fit_s=60):
        self.program, self.folder, self.seed = program, folder, seed
        self.robot = twin_case.draw_robot(seed)
        runs = []
        for part, (use, seconds) in enumerate((("fit", fit_s), ("holdout", fit_s / 2))):
            sent, heard = twin_case.drive(f"{seed} learn {part}", KINDS, seconds, self.robot)
            runs.append((twin_case.record(self.robot, self.robot.true, sent, heard, seed + part), use))
        self.bench = folder / f"robot_{seed}"
        twin_case.write(self.bench, self.robot, runs)
        self.model = self.bench / "fitted.toml"
        omnihil(program, "fit", self.bench, "--write", self.model, "--jobs", 2)
        omnihil(program, "card", self.model, "--data", self.bench, "--out", self.bench / "cards", "--no-evidence")

    def watch(self, name, seconds, change=None):
        """Events of the twin over one drive; `change`: what breaks at BREAKS_S, before it is learned from."""
        sent, heard = twin_case.drive(f"{self.seed} {name}", KINDS, seconds, self.robot)
        then = (round(BREAKS_S * 1000), {**self.robot.true, **change, "seed": self.seed}) if change else None
        columns = twin_case.record(self.robot, self.robot.true, sent, heard, random.Random(name).randrange(1 << 30), then)
        folder = self.folder / f"{name.replace(' ', '_')}_{self.seed}"
        twin_case.write(folder, self.robot, [(columns, "fit")])
        log = folder / "events.jsonl"
        omnihil(self.program, "twin", folder, "--model", self.model, "--twin-learn", LEARN_S, "--twin-log", log)
        return [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()]


def alarms(events):
    return [e for e in events if e["event"] == "alarm"]


def named(events, suspect):
    """(seconds from the fault to its name, all is well)."""
    told = alarms(events)
    if any(a["time_s"] < BREAKS_S for a in told):
        return None, False
    first = next((a for a in told if a["fault"] != "unknown"), None)
    if first is None:
        return None, False
    after_s = first["time_s"] - BREAKS_S
    return after_s, first["suspect"] == suspect and after_s <= WITHIN_S


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", default=os.environ.get("OMNIHIL_PROGRAM", "omnihil"))
    parser.add_argument("--robots", type=int, default=2)
    parser.add_argument("--first", type=int, default=1, help="seed of the first robot")
    parser.add_argument("--healthy", type=float, default=600.0, help="seconds of healthy driving per robot")
    parser.add_argument("--faults", default=",".join([*twin_case.FAULTS, *twin_case.UNKNOWN]))
    parser.add_argument("--wheels", default="1,2,3,4")
    parser.add_argument("--keep", type=pathlib.Path)
    words = parser.parse_args()
    folder = words.keep or pathlib.Path(tempfile.mkdtemp(prefix="omnihil-twin-"))
    score, healthy_s, false = {}, 0.0, 0
    for seed in range(words.first, words.first + words.robots):
        owner = Owner(words.program, folder, seed)
        if words.healthy > 0:
            told = alarms(owner.watch("healthy", LEARN_S + words.healthy))
            healthy_s += words.healthy
            false += len(told)
            print(f"robot {seed}: {words.healthy:.0f} s healthy: {len(told)} alarms", *[a["sentence"] for a in told], sep="\n  ", flush=True)
        for fault in filter(None, words.faults.split(",")):
            wheels = [1] if fault in twin_case.UNKNOWN or fault == "battery" else map(int, words.wheels.split(","))
            for wheel in wheels:
                unknown = fault in twin_case.UNKNOWN
                change, suspect = (twin_case.UNKNOWN[fault], None) if unknown else twin_case.FAULTS[fault](wheel)
                events = owner.watch(f"{fault} {wheel}", BREAKS_S + AFTER_S, change)
                told = alarms(events)
                if unknown:  # seen, and no name that is wrong
                    good = bool(told) and all(a["fault"] == "unknown" for a in told)
                    after_s = told[0]["time_s"] - BREAKS_S if told else None
                else:
                    after_s, good = named(events, suspect)
                score.setdefault(fault, []).append(good)
                print(f"robot {seed}: {fault} {wheel}: {'as it should be' if good else 'WRONG'}, "
                      f"{'never' if after_s is None else f'{after_s:.1f} s'}",
                      *[f"{a['time_s'] - BREAKS_S:.1f} s {a['sentence']}" for a in told[:3]], sep="\n  ", flush=True)
    print(f"healthy: {false} false alarms in {healthy_s / 3600:.2f} h")
    for fault, good in score.items():
        print(f"{fault}: {sum(good)} of {len(good)}")
    return 0 if false == 0 and all(all(good) for good in score.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
