#!/usr/bin/env python3
"""The scoring, on answers made up for the purpose."""
import math
import unittest

import cases
import run_program
import score
import table


def answer(*effects, cls="single", share=0.5, **more):
    return {
        "case": "x",
        "class": cls,
        "rig": "axis",
        "what": list(effects),
        "base": {},
        **more,
        "effects": [
            {"id": e, "same_law": [], "share": share, "parameters": {"a": 2.0}, "equal_law": ["a"]}
            for e in effects
        ],
    }


def said(*effects, verdict="effect", twins=(), ranking=()):
    return {
        "seconds": 1.0,
        "code": 0,
        "text": "",
        "diagnosis": {
            "verdict": verdict,
            "effects": list(effects),
            "indistinguishable": [list(t) for t in twins],
            "ranking": [{"effect": r, "parameters": {}} for r in ranking],
        },
    }


class ScoreTest(unittest.TestCase):
    def test_the_right_name_is_right_and_another_is_not(self):
        self.assertTrue(score.judge(said("cogging"), answer("cogging"))["first"])
        self.assertFalse(score.judge(said("imbalance"), answer("cogging"))["first"])
        self.assertFalse(score.judge(said(verdict="adequate"), answer("cogging"))["first"])

    def test_a_twin_counts_only_when_it_is_declared_and_the_set_is_small(self):
        a = answer("battery_sag")
        self.assertFalse(score.judge(said("winding_heating"), a)["first"])
        self.assertTrue(
            score.judge(said("winding_heating", twins=[("battery_sag", "winding_heating")]), a)["first"]
        )
        large = ("battery_sag", "winding_heating", "current_limit", "saturation")
        self.assertFalse(score.judge(said("winding_heating", twins=[large]), a)["first"])

    def test_the_same_law_under_another_name_is_right(self):
        a = answer("gear_efficiency")
        a["effects"][0]["same_law"] = ["load_dependent_friction"]
        self.assertTrue(score.judge(said("load_dependent_friction"), a)["first"])

    def test_second_place_counts_for_the_first_two(self):
        row = score.judge(said("imbalance", "cogging"), answer("cogging"))
        self.assertEqual((row["first"], row["first_two"], row["extra"]), (False, True, 1))
        self.assertEqual(row["extra_later"], 0)  # a wrong first name is counted where first names are
        self.assertEqual(score.judge(said("cogging", "imbalance"), answer("cogging"))["extra_later"], 1)
        self.assertTrue(
            score.judge(said("imbalance", ranking=["imbalance", "cogging"]), answer("cogging"))["first_two"]
        )

    def test_pairs_need_both(self):
        a = answer("cogging", "dead_time", cls="pair")
        self.assertTrue(score.judge(said("dead_time", "cogging"), a)["all"])
        self.assertFalse(score.judge(said("dead_time"), a)["all"])

    def test_no_answer_is_a_false_alarm_and_counted(self):
        rows = [
            score.judge({"seconds": 1.0, "code": None, "text": "", "diagnosis": None}, answer(cls="control"))
        ]
        figures = score.summary(rows)
        self.assertEqual((figures["false alarm"]["hits"], figures["no answer"]["hits"]), (1, 1))

    def test_error_reduction_is_the_oracle_s_share(self):
        result = said("cogging")
        result["diagnosis"].update(
            signals={"velocity": {"noise_sigma": 0.5}},
            baseline={"holdout": {"velocity": {"rmse": 3.0}}},
            final={"holdout": {"velocity": {"rmse": 1.5}}},
        )
        result["oracle"] = {"compare": {"error": {"holdout": {"velocity": {"rmse": 1.0}}}}}
        self.assertAlmostEqual(score.error_reduction(result), (3.0 - 1.5) / (3.0 - 1.0))
        result["oracle"]["compare"]["error"]["holdout"]["velocity"]["rmse"] = 2.99
        self.assertTrue(math.isnan(score.error_reduction(result)))

    def test_parameter_errors_come_from_the_final_model(self):
        result = said("cogging")
        result["final_model"] = {"effects": {"cogging": {"a": {"value": 2.2}}}}
        self.assertAlmostEqual(score.parameter_errors(result, answer("cogging"))[0], 0.1)

    def test_wilson_s_interval(self):
        low, high = score.wilson(0, 150)  # z^2 / (n + z^2)
        self.assertEqual(low, 0)
        self.assertAlmostEqual(high, 1.96**2 / (150 + 1.96**2))

    def test_a_row_passes_at_its_bound_and_misses_beyond(self):
        self.assertTrue(table.reached(0.92, 0.92, 1))
        self.assertFalse(table.reached(0.919, 0.92, 1))
        self.assertFalse(table.reached({"rate": 0.021}, 0.02, -1))
        self.assertIsNone(table.reached(math.nan, 1, 1))

    def test_every_row_and_floor_is_a_figure(self):
        figures = score.summary([])
        for _, parts in table.DONE_WHEN:
            for name, _, _ in parts:
                self.assertIn(name, figures)
        self.assertLessEqual(set(table.FLOORS), set(figures))

    def test_the_oracle_s_model_keeps_the_nominal_and_adds_the_effect(self):
        nominal = {
            "format": "omnihil-model/1",
            "motor": {"resistance_ohm": {"value": 1.2, "tolerance": 0.1}, "slots": 12},
            "effects": {"coulomb_friction": {"torque_Nm": {"value": 0.003, "tolerance": 0.3}}},
        }
        effect = {"id": "cogging", "parameters": {"amplitude_Nm": 0.002, "order": 48.0}}
        sections = run_program.oracle_sections(nominal, [effect])
        self.assertEqual(sections["motor"]["slots"], "12")
        self.assertEqual(
            sections["effects.coulomb_friction"]["torque_Nm"], "{ value = 0.003, tolerance = 0.3 }"
        )
        self.assertEqual(
            sections["effects.cogging"],
            {"amplitude_Nm": "{ value = 0.002, tolerance = 0.3 }", "order": "48.0"},
        )

    def test_the_reduced_run_takes_open_cases_of_every_kind(self):
        chosen = cases.reduced()
        self.assertEqual({c.set for c in chosen}, {"dev"})
        self.assertLessEqual(
            {"single", "control", "pair", "outside", "fault", "robot"}, {c.cls for c in chosen}
        )


if __name__ == "__main__":
    unittest.main()
