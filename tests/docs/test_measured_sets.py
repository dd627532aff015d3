#!/usr/bin/env python3
"""The page of the measured sets from made-up results, and the bench of the diagnosis with a made-up program."""
import json
import os
import stat
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOLS = Path(__file__).resolve().parents[2] / "tools"
sys.path.insert(0, str(TOOLS))
import bench_diagnose  # noqa: E402
import measured_sets  # noqa: E402

README = """# Measured

| folder | rig | licence | source |
|---|---|---|---|
| `drum_left`, `_right` | a drum | none stated | a book |
| `arm` | an arm | MIT | a shelf |
| `slide` | a slide | MIT | a shop |
| `never` | never run | MIT | a drawer |
| `top` | a top | MIT | the same |

### drum: position MAE, mrad
| model | k | fit / holdout | all |
|---|---|---|---|
| plain | 2 | 30 / 31 | |
| best known | 4 | **10.0 / 10.0** | 12 / 12 |

### arm, wheel
Free-running simulation; RMSE in rad/s.

| set | plain | best known |
|---|---|---|
| `wheel` | 3 / 3 | **1 / 1** (k 3) |
| `arm` | 9 / - / 8 | **2.0 / - / 4.0** (k 4) |

### slide: relative force error
| model | k | fit % | holdout % |
|---|---|---|---|
| best known | 7 | **2.0** | **3.0** |

### top
Rms of the torque: plain 4 mN m; best known 1.
"""


def diagnosis(signal, unit):
    errors = {"rmse": 0.5, "nrmse_percent": 1.0}
    return {
        "outcome": "found, but more remains",
        "effects": ["cogging"],
        "signals": {signal: {"noise_sigma": 0.1, "unit": unit}},
        "baseline": {"fit": {signal: {"rmse": 7.25}}, "holdout": {signal: {"rmse": 6.5}}},
        "final": {
            "fit": {signal: errors},
            "holdout": {signal: errors},
            "parameters": {"cogging.phase": {"at_bound": True, "sentence": "at its bound 1: a symptom"}, "a.b": {"at_bound": False}},
        },
        "findings": [{"grade": "doubt", "sentence": "The clock is late."}, {"grade": "note", "sentence": "A note."}],
        "unknown": {"sentence": "More remains.", "formula": ""},
        "where": [{"signal": signal, "against": "time", "explained_fraction": 0.25}],
        "indistinguishable": [["cogging", "seam"]],
    }


class Page(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.results = Path(self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def put(self, name, said, comparison, **entry):
        run = {"set": name, "data_sha256": "5eed", "program": "0.1 (abc)", "cpu_s": 4.25, "wall_s": 3.0, "first_wall_s": 1.5}
        run |= {"timed_out": False, "limit_s": 300.0, "exit": 0} | entry
        for kind, value in (("run", run), ("diagnosis", said), ("compare", comparison)):
            if value is not None:
                (self.results / f"{name}.{kind}.json").write_text(json.dumps(value))

    def section(self, name):
        return measured_sets.page(README, self.results).split(f"\n## {name}\n")[1].split("\n## ")[0]

    def test_what_misses_the_best_known_error_by_more_than_five_per_cent_is_said(self):
        self.put("arm", diagnosis("velocity", "rad/s"),
                 {"fit": {"velocity": {"rmse": 2.09}}, "extrapolation": {"velocity": {"rmse": 5.0}}})
        said = self.section("arm")
        self.assertIn("| fit | 2.09 | 2 | reached |", said)
        self.assertIn("| extrapolation | 5 | 4 | **missed by 25 %** |", said)
        self.assertNotIn("| holdout | 5", said)  # no figure, no comparison
        self.assertIn("| `velocity` | holdout | 6.5 | 0.5 | rad/s | 5 × |", said)
        page = measured_sets.page(README, self.results)
        self.assertIn("| [arm](#arm) | found, but more remains | `cogging` | 4.2 | missed: extrapolation by 25 % |", page)

    def test_measures_of_the_readme_have_their_fields_and_units(self):
        error = {"position": {"mean_absolute": 0.0104, "rmse": 9.0}}
        self.put("drum_right", diagnosis("position", "rad"), {"fit": error, "holdout": {"position": {"mean_absolute": 0.011}}})
        said = self.section("drum_right")
        self.assertIn("| fit | 10.4 | 10 | reached |", said)
        self.assertIn("| holdout | 11 | 10 | **missed by 10 %** |", said)
        self.put("slide", diagnosis("motor_torque", "N"), {"relative_force_error": {"fit": 0.019, "holdout": 0.04}})
        said = self.section("slide")
        self.assertIn("| fit | 1.9 | 2 | reached |", said)
        self.assertIn("**missed by 33 %**", said)

    def test_provenance_licence_and_what_is_not_explained_stand_there(self):
        self.put("drum_left", diagnosis("position", "rad"), {})
        said = self.section("drum_left")
        for words in ("source: a book", "no licence is stated: figures alone", "`5eed`", "0.1 (abc)", "doubt of the data: The clock is late.",
                      "More remains.", "position against time: 25 %", "cogging, seam", "`cogging.phase` at its bound 1", "no figure"):
            self.assertIn(words, said)
        self.assertNotIn("A note.", said)

    def test_figures_of_another_quantity_are_quoted_and_not_compared(self):
        self.put("top", diagnosis("motor_torque", "N m"), {"fit": {"motor_torque": {"rmse": 0.5}}})
        self.assertIn("not compared. They are:\n\nRms of the torque: plain 4 mN m; best known 1.", self.section("top"))
        self.assertIn("source: a drawer", self.section("top"))
        self.assertIn("| `cogging` | 4.2 | not compared |", measured_sets.page(README, self.results))

    def test_a_set_that_was_not_run_again_keeps_what_the_page_says(self):
        self.put("arm", diagnosis("velocity", "rad/s"), {})
        old = measured_sets.page(README, self.results)
        (self.results / "arm.run.json").unlink()
        self.put("drum_left", diagnosis("position", "rad"), {})
        new = measured_sets.page(README, self.results, old)
        row = next(line for line in old.splitlines() if line.startswith("| [arm]"))
        self.assertIn(row, new)
        self.assertEqual(new.split("\n## arm\n")[1].split("\n## ")[0], old.split("\n## arm\n")[1].split("\n## ")[0])
        self.assertIn("Not run", self.section("arm"))  # without the page there is nothing to keep
        self.assertEqual(new.count("\n## arm\n"), 1)
        self.assertIn("Verdict", new.split("\n## drum_left\n")[1].split("\n## ")[0])

    def test_a_remark_is_written_once_however_often_the_page_is_made(self):
        remarks = {"arm": {"in_the_way": "nobody saw it", "would_settle": "a lamp"}}
        once = measured_sets.page(README, self.results, "", remarks)
        self.assertIn("In the way: nobody saw it. It would settle it: a lamp.", once)
        with tempfile.TemporaryDirectory() as nothing:
            again = measured_sets.page(README, Path(nothing), once, {"arm": remarks["arm"] | {"would_settle": "a day"}})
        self.assertEqual(again, once.replace("a lamp", "a day"))

    def test_every_remark_is_of_a_set_on_the_page(self):
        remarks = measured_sets.tomllib.loads(measured_sets.REMARKS.read_text())
        page = (measured_sets.ROOT / "docs/measured-sets.md").read_text()
        self.assertEqual([name for name in remarks if f"\n## {name}\n" not in page], [])

    def test_another_dataset_of_the_same_recordings_follows_its_set(self):
        self.put("top", diagnosis("velocity", "rad/s"), {}, imported="`a.sh`, its folder `x`")
        self.put("top_spun", diagnosis("velocity", "rad/s"), {}, imported="`a.sh`, its folder `y`")
        page = measured_sets.page(README, self.results)
        self.assertLess(page.index("\n## top\n"), page.index("\n## top_spun\n"))
        self.assertIn("dataset: `a.sh`, its folder `y`", self.section("top_spun"))
        self.assertIn("licence: MIT", self.section("top_spun"))
        self.assertIn("| [top_spun](#top_spun) |", page)
        (self.results / "top_spun.run.json").unlink()
        self.assertEqual(measured_sets.page(README, self.results, page), page)

    def test_a_set_without_an_answer_is_said_to_have_none(self):
        self.put("arm", None, None, timed_out=True, first_wall_s=None)
        self.assertIn("No answer. Not done within 300 s.", self.section("arm"))
        self.assertIn("Not run", self.section("never"))


PROGRAM = """#!/usr/bin/env python3
import json, sys, time
if sys.argv[1] == "--version": print("0.1 (abc)")
elif sys.argv[1] == "diagnose":
    print("    0.1 s   20 %  first ranking: cogging", file=sys.stderr, flush=True)
    if "slow" in sys.argv[2]: time.sleep(600)
    out = sys.argv[sys.argv.index("--json") + 1]
    json.dump({"outcome": "found", "effects": ["cogging"], "final": {"model": "a = 1\\nb = 2\\n"}}, open(out, "w"))
elif sys.argv[1] == "compare": json.dump({}, open(sys.argv[sys.argv.index("--json") + 1], "w"))
"""


class Bench(unittest.TestCase):
    def bench(self, folder, *words, **environment):
        program = Path(folder) / "program"
        program.write_text(PROGRAM)
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        command = [sys.executable, TOOLS / "bench_diagnose.py", "--program", program, "--results", Path(folder) / "results", *words]
        own = {k: v for k, v in os.environ.items() if k not in ("OMNIHIL_SHARED", "HIDDEN_PLANT_LIBRARY")}
        return subprocess.run(list(map(str, command)), env=own | environment, capture_output=True, text=True, check=False)

    def test_without_shared_data_it_says_what_it_skips_and_why(self):
        with tempfile.TemporaryDirectory() as folder:
            done = self.bench(folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("skipped: measured sets: OMNIHIL_SHARED is not set", done.stdout)
        self.assertIn("skipped: open cases: the hidden plant is not built", done.stdout)

    def test_answers_are_rows_what_takes_too_long_is_missed_and_nothing_is_run_twice(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("quick", "slow"):
                (Path(folder) / "data" / name).mkdir(parents=True)
                (Path(folder) / "data" / name / "dataset.toml").write_text('rig = "axis"\n')
            done = self.bench(folder, "--limit", "2", OMNIHIL_SHARED=folder)
            results = Path(folder) / "results"
            first = json.loads((results / "quick.run.json").read_text())
            self.assertEqual((results / "quick.model.toml").read_text(), "a = 1\nb = 2\n")
            self.assertTrue((results / "quick.compare.json").exists())
            self.assertFalse((results / "slow.diagnosis.json").exists())
            self.bench(folder, "quick", OMNIHIL_SHARED=folder)
            self.assertEqual(json.loads((results / "quick.run.json").read_text()), first)
        self.assertEqual(done.returncode, 1, done.stderr)
        rows = {line.split()[0]: line for line in done.stdout.splitlines()}
        self.assertIn("found                    cogging", rows["quick"])
        self.assertNotIn("missed", rows["quick"])
        self.assertRegex(rows["slow"], "cut off .*missed: not done in 2 s")
        self.assertIsNotNone(first["first_wall_s"])

    def test_targets_are_those_of_the_rig_and_waiting_for_a_core_is_no_fault(self):
        entry = {"rig": "axis", "timed_out": False, "first_wall_s": 20.0, "first_cpu_s": 14.0, "cpu_s": 59.0, "wall_s": 70.0,
                 "limit_s": 300.0}
        self.assertEqual(bench_diagnose.missed(entry), "")
        self.assertEqual(bench_diagnose.missed(entry | {"cpu_s": 61.0}), "missed: whole")
        self.assertEqual(bench_diagnose.missed(entry | {"cpu_s": 110.0, "wall_s": 59.0}), "")
        self.assertEqual(bench_diagnose.missed(entry | {"cpu_s": 61.0, "rig": "robot"}), "")
        self.assertEqual(bench_diagnose.missed(entry | {"first_cpu_s": 16.0}), "missed: first ranking")


if __name__ == "__main__":
    unittest.main()
