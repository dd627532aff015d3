#!/usr/bin/env python3
"""Calibration of the names' probabilities and the comparison of rules, on numbers made up for the purpose."""
import math
import random
import unittest

import calibrate
import rules
import score


def row(effect, **more):
    return {
        "effect": effect,
        "refitted": True,
        "plausible": True,
        "accepted": True,
        "accepted_by": "gain",
        "share_of_base": 0.5,
        "selection_frequency": 0.8,
        "noise_share": 0.0,
        **more,
    }


def diagnosis(effects, ladder, outcome="found"):
    return {
        "effects": effects,
        "outcome": outcome,
        "ranking": ladder[0]["ranking"],
        "ladder": ladder,
        "indistinguishable": [["cogging", "imbalance"]],
        "signals": {"velocity": {"noise_sigma": 2.0}},
        "final": {"holdout": {"velocity": {"rmse": 3.0}}},
    }


TWO_ROUNDS = diagnosis(
    ["stribeck_friction", "cogging"],
    [
        {"added": "base parameters refitted", "ranking": [row("lugre_friction"), row("cogging", share_of_base=0.2)]},
        {"added": "lugre_friction", "ranking": [row("cogging", share_of_base=0.04), row("backlash")]},
        {"added": "cogging", "ranking": [row("backlash", accepted=False)]},
        {"added": "stribeck_friction in place of lugre_friction"},
    ],
)


class CalibrateTest(unittest.TestCase):
    def test_evidence_is_that_of_the_round_that_took_the_name(self):
        (first, of_first), (_, of_second) = calibrate.evidence(TWO_ROUNDS)
        self.assertEqual(first, "stribeck_friction")
        self.assertAlmostEqual(of_first["log10_share_of_base"], math.log10(0.5))
        self.assertEqual(of_second["later"], 1.0)
        self.assertAlmostEqual(of_second["log10_share_of_base"], math.log10(0.04))
        self.assertEqual(of_second["undecided"], 1.0)
        self.assertAlmostEqual(of_second["log10_error_over_noise"], math.log10(1.5))
        self.assertEqual(len(calibrate.features(TWO_ROUNDS)[0][1]), len(calibrate.FEATURES["found"]))

    def test_what_remains_is_the_energy_above_the_noise_over_the_base_models(self):
        more = {**TWO_ROUNDS, "outcome": "found, but more remains", "baseline": {"holdout": {"velocity": {"rmse": 5.0}}}}
        # (1.5^2 - 1) / (2.5^2 - 1) = 0.238
        second = calibrate.evidence(more)[1][1]
        self.assertAlmostEqual(second["log10_share_over_remaining"], math.log10(0.04 / (1.25 / 5.25)))
        self.assertEqual(calibrate.features(more)[1][1][2], second["log10_share_over_remaining"])

    def test_the_fit_finds_the_slopes_that_made_the_data(self):
        draw, beta = random.Random(1), [1.0, -2.0, 0.0, 0.0, 1.5, 0.0, 0.0]
        rows = []
        for _ in range(3000):
            x = [1.0, float(draw.random() < 0.5), 0.0, 0.0, draw.random(), 0.0, 0.0]
            rows.append((x, draw.random() < calibrate.probability(x, beta)))
        found = calibrate.fit(rows)
        for b, f in zip(beta, found):
            self.assertAlmostEqual(b, f, delta=0.6)  # 4 standard errors of the slope of a uniform variable

    def test_calibration_error_is_the_mean_distance_of_said_and_right(self):
        said = [(0.9, True)] * 8 + [(0.9, False)] * 2 + [(0.2, False)] * 10
        self.assertAlmostEqual(score.expected_calibration_error(said), 0.5 * 0.1 + 0.5 * 0.2)

    def test_what_chance_makes_of_a_few_names(self):
        # n names of p in one bin: mean of |sum - n p| / n, about sqrt(2 p (1 - p) / (pi n)) of a normal law
        few, many = [(0.5, True)] * 16, [(0.5, True)] * 1600
        self.assertAlmostEqual(score.calibration_by_chance(few)[0], math.sqrt(0.5 / (math.pi * 16)), delta=0.01)
        self.assertAlmostEqual(score.calibration_by_chance(many, 200)[0], math.sqrt(0.5 / (math.pi * 1600)), delta=0.001)
        self.assertGreater(score.expected_calibration_error(many), score.calibration_by_chance(many, 200)[1])
        self.assertEqual(score.calibration_by_chance([(1.0, True)] * 5), (0.0, 0.0))

    def test_names_of_a_case_with_nothing_hidden_count_as_wrong(self):
        d = {"effects": ["cogging"], "confidence": [{"effect": "cogging", "probability": 0.7}]}
        empty = {"case": "x", "class": "outside", "rig": "axis", "what": [], "effects": []}
        self.assertEqual(score.judge({"diagnosis": d}, empty)["confidence"], [(0.7, False)])


class RulesTest(unittest.TestCase):
    def test_trials_are_of_a_hidden_effect_or_beside_all_of_them(self):
        hidden = {"effects": [{"id": e, "same_law": []} for e in ("lugre_friction", "cogging")]}
        told = [(n, is_true, r["effect"]) for n, is_true, r in rules.trials(TWO_ROUNDS, hidden)]
        self.assertEqual(
            told, [(0, True, "lugre_friction"), (0, True, "cogging"), (1, True, "cogging"), (2, False, "backlash")]
        )

    def test_a_model_with_something_false_in_it_is_no_trial(self):
        hidden = {"effects": [{"id": "cogging", "same_law": []}]}
        self.assertEqual([r["effect"] for _, _, r in rules.trials(TWO_ROUNDS, hidden)], ["cogging"])


if __name__ == "__main__":
    unittest.main()
