#!/usr/bin/env python3
"""The hidden axis against formulas a reader can check: energy, steady speed, time constants, step size, determinism."""
import math
import types
import unittest

import axis_effects
import plant

# A drive without friction: everything in closed form.
BARE = dict(
    resistance_ohm=1.0,
    inductance_H=0.2e-3,
    flux_Vs=0.03,
    rotor_kgm2=1e-5,
    load_kgm2=4e-5,
    viscous_Nms=0.0,
    dry_Nm=0.0,
    supply_V=20.0,
)


def speeds(params, asked):
    raw, sums = plant.run_axis(params, asked)
    return plant.raw_columns(raw), sums


class AxisPlantTest(unittest.TestCase):
    def test_energy_in_is_lost_or_stored(self):
        wave = [0.6 * math.sin(2 * math.pi * 3 * k * 1e-3) for k in range(5000)]
        _, sums = speeds(dict(BARE, viscous_Nms=1e-5, dry_Nm=4e-3), wave)
        self.assertGreater(sums["in_J"], 1)
        self.assertAlmostEqual(sums["in_J"], sums["lost_J"] + sums["stored_J"], delta=1e-6 * sums["in_J"])

    def test_energy_balance_holds_over_a_compliant_shaft(self):
        wave = [0.4 if (k // 150) % 2 else -0.4 for k in range(4050)] + [
            0.0
        ] * 3000  # ends at rest, shaft relaxed
        _, sums = speeds(dict(BARE, viscous_Nms=1e-5, shaft_Nm_per_rad=20, gear=3, load_kgm2=2e-4), wave)
        self.assertAlmostEqual(sums["in_J"], sums["lost_J"] + sums["stored_J"], delta=1e-5 * sums["in_J"])

    def test_a_pendulum_hangs_at_the_angle_of_the_output(self):
        # push = m g l sin(angle of the output), whatever the gear; friction lets it settle
        for gear in (1, 3):
            params = dict(BARE, viscous_Nms=2e-3, gear=gear, load_kgm2=1e-4, push_Nm=0.01, pendulum_Nm=0.02)
            columns, _ = speeds(params, [0.0] * 20000)
            self.assertAlmostEqual(columns["out_angle"][-1], math.asin(0.5), delta=1e-3)

    def test_steady_speed_is_voltage_less_friction(self):
        # k i = b w + c and u = R i + k w give w = (k u / R - c) / (k^2 / R + b).
        b, c, u, k, r = 2e-5, 3e-3, 10.0, BARE["flux_Vs"], BARE["resistance_ohm"]
        columns, _ = speeds(dict(BARE, viscous_Nms=b, dry_Nm=c), [0.5] * 3000)
        self.assertAlmostEqual(columns["speed"][-1], (k * u / r - c) / (k * k / r + b), delta=1e-6)
        self.assertAlmostEqual(columns["current"][-1], (b * columns["speed"][-1] + c) / k, delta=1e-6)

    def test_a_live_axis_is_the_recorded_one(self):
        params = dict(BARE, viscous_Nms=2e-5, dry_Nm=3e-3, bristles=0)
        asked = [0.5 if (k // 70) % 3 else -0.2 for k in range(400)]
        columns, _ = speeds(params, asked)
        live = plant.LiveAxis(params)
        for k, duty in enumerate(asked):
            for looks in (live.look, lambda on=duty: live.row(plant.LiveAxis.DUTY, on)):
                looks()
                for name in ("speed", "angle", "current", "bus"):
                    self.assertAlmostEqual(live.raw[plant.RAW.index(name)], columns[name][k], delta=1e-11, msg=(name, k))
        live.close()

    def test_a_live_axis_takes_a_voltage_a_current_or_nothing(self):
        b, c, k, r, j = 2e-5, 3e-3, BARE["flux_Vs"], BARE["resistance_ohm"], 5e-5
        params = dict(BARE, viscous_Nms=b, dry_Nm=c, sample_s=0.25e-3)
        speed, current = plant.RAW.index("speed"), plant.RAW.index("current")
        live = plant.LiveAxis(params)
        for _ in range(8000):
            live.row(plant.LiveAxis.VOLTAGE, 10.0)
        self.assertAlmostEqual(live.raw[speed], (k * 10.0 / r - c) / (k * k / r + b), delta=1e-6)
        live = plant.LiveAxis(params)
        for _ in range(801):
            live.row(plant.LiveAxis.CURRENT, 1.0)
        # J w' = k i - c - b w from rest: w = (k i - c) / b (1 - exp(-b t / J))
        self.assertAlmostEqual(live.raw[current], 1.0, delta=1e-3)
        self.assertAlmostEqual(live.raw[speed], (k - c) / b * -math.expm1(-b * 0.2 / j), delta=0.2)
        before = live.raw[speed]
        for _ in range(401):
            live.row(plant.LiveAxis.OFF, 0.0)
        self.assertAlmostEqual(live.raw[current], 0.0, delta=1e-3)
        # c and b alone brake it: w = (w0 + c / b) exp(-b t / J) - c / b
        self.assertAlmostEqual(live.raw[speed], (before + c / b) * math.exp(-b * 0.1 / j) - c / b, delta=0.2)

    def test_step_answer_has_the_two_poles_of_winding_and_rotor(self):
        # L J s^2 + R J s + k^2 = 0; the slow pole is left alone after a few milliseconds.
        j, r, ell, k = 5e-5, BARE["resistance_ohm"], BARE["inductance_H"], BARE["flux_Vs"]
        slow = (-r + math.sqrt(r * r - 4 * ell * k * k / j)) / (2 * ell)
        columns, _ = speeds(BARE, [0.5] * 400)
        end = 10 / k
        ratio = (end - columns["speed"][80]) / (end - columns["speed"][40])
        self.assertAlmostEqual(math.log(ratio) / 0.040, slow, delta=1e-4 * abs(slow))

    def test_dry_friction_holds_until_the_torque_exceeds_it(self):
        # k u / R = 4 mNm at a duty of 4e-3 * 1 / (0.03 * 20) = 0.00667
        for duty, moves in ((0.0066, False), (0.0068, True)):
            columns, _ = speeds(dict(BARE, dry_Nm=4e-3), [duty] * 500)
            self.assertEqual(columns["angle"][-1] != 0, moves)

    def test_coasting_down_under_dry_friction_is_a_straight_line_to_an_exact_stop(self):
        params = dict(BARE, dry_Nm=20e-3, coast_band=0.5)  # no drive below half duty: the winding is open
        columns, _ = speeds(params, [0.8] * 300 + [0.0] * 4000)
        w = columns["speed"]
        self.assertAlmostEqual((w[1200] - w[400]) / 0.8, -20e-3 / 5e-5, delta=0.01)
        self.assertEqual(w[-1], 0.0)

    def test_commutation_that_is_early_one_way_is_late_the_other_way(self):
        # the same load both ways: drag of the winding's own speed; more torque per ampere where it is early
        params = dict(BARE, advance_rad=0.3, inductance_H=6e-4, viscous_Nms=3e-5)
        forwards, _ = speeds(params, [0.8] * 3000)
        backwards, _ = speeds(params, [-0.8] * 3000)
        self.assertLess(forwards["current"][-1], 0.99 * -backwards["current"][-1])
        mirrored, _ = speeds(dict(params, advance_rad=-0.3), [-0.8] * 3000)
        self.assertAlmostEqual(mirrored["current"][-1], -forwards["current"][-1], delta=1e-6)

    def test_filters_settle_exponentially_and_ramps_at_their_rate(self):
        asked = [0.0] * 20 + [0.5] * 400
        steady = dict(BARE, load_kgm2=1.0, inductance_H=5e-5, step_s=25e-6)  # rotor as good as held: i = D U / R

        def current(k, **hidden):
            params = dict(steady, **hidden)
            raw, _ = plant.run_axis(params, asked)
            seen = plant.sense_axis(dict(params, current_noise_A=0.0), raw, 1)
            return plant.raw_columns(raw)["current"][k], seen["current"][k]

        for k in (30, 60, 200):
            turns_ms = [k - 21 + turn / 4 for turn in (1, 2, 3, 4)]  # of the firmware within the row
            smooth = [10.0 * (1 - math.exp(-t / 30)) for t in turns_ms]
            self.assertAlmostEqual(current(k, smooth_s=0.03)[0], sum(smooth) / 4, delta=0.02)
            ramp = [min(10.0, 20.0 * t / 200) for t in turns_ms]
            self.assertAlmostEqual(current(k, most_duty_per_s=5.0)[0], sum(ramp) / 4, delta=0.02)
            slow = 10.0 * (1 - math.exp(-(k - 20) / 30))
            self.assertAlmostEqual(current(k, current_filter_s=0.03)[1], slow, delta=0.02)
        raw, _ = plant.run_axis(dict(BARE, load_kgm2=1e-2), [0.5] * 1000)
        seen = plant.sense_axis(dict(BARE, speed_filter_s=0.02, speed_noise_rad_s=0.0), raw, 1)
        speed = plant.raw_columns(raw)["out_speed"]  # as good as a ramp: late by the filter's time less half a row
        self.assertAlmostEqual(seen["speed"][-1], 0.5 * (speed[-20] + speed[-21]), delta=0.01 * (speed[-1] - speed[-41]))

    def test_a_derating_drive_has_no_limit_while_it_is_cold(self):
        rig = types.SimpleNamespace(stall_A=20 / BARE["resistance_ohm"], believed=BARE)
        hidden = axis_effects.BY_ID["thermal_derating"].hide(1e-9, {"from_K": 15, "full": 1}, rig)
        reversed_at_speed = [1.0] * 1000 + [-1.0] * 1000
        cold, _ = speeds(dict(BARE, **hidden), reversed_at_speed)
        free, _ = speeds(BARE, reversed_at_speed)
        self.assertLess(min(free["current"]), -1.5 * rig.stall_A)
        for a, b in zip(cold["current"], free["current"]):
            self.assertAlmostEqual(a, b, delta=1e-6)

    def test_half_the_step_changes_nothing_that_can_be_seen(self):
        wave = [0.5 * math.sin(2 * math.pi * (0.5 + k * 1e-3) * k * 1e-3) for k in range(6000)]
        for hidden in (
            {},
            {"bristles": 1, "breakaway_ratio": 0.8, "bristle_Nm_per_rad": 3},
            {"current_cap_A": 5},
            {
                "play_rad": 0.01,
                "shaft_Nm_per_rad": 40,
                "shaft_damping_Nms": 0.01,
                "gear": 3,
                "load_kgm2": 4e-4,
            },
            {"edge_V": 0.4},
            {"cog_Nm": 2e-3},
        ):
            params = {**BARE, "dry_Nm": 3e-3, "viscous_Nms": 1e-5, **hidden}
            coarse, _ = speeds(params, wave)
            fine, _ = speeds(dict(params, step_s=12.5e-6), wave)
            rms = math.sqrt(sum((a - b) ** 2 for a, b in zip(coarse["speed"], fine["speed"])) / len(wave))
            self.assertLess(rms, 0.05, hidden)  # rad/s; one count a sample is 1.5

    def test_same_seed_same_record(self):
        params = dict(BARE, dry_Nm=4e-3, sample_jitter_s=1e-4, lost_per_count=1e-3, seed=5)
        records = []
        for _ in range(2):
            raw, _ = plant.run_axis(params, [0.3] * 800)
            records.append({k: list(v) for k, v in plant.sense_axis(params, raw, 9).items()})
        self.assertEqual(records[0], records[1])
        raw, _ = plant.run_axis(dict(params, seed=6), [0.3] * 800)
        self.assertNotEqual(records[0]["speed"], list(plant.sense_axis(params, raw, 9)["speed"]))


class AxisSensorTest(unittest.TestCase):
    def test_counts_are_the_floor_of_the_angle(self):
        raw, _ = plant.run_axis(BARE, [0.3] * 500)
        angle, counts = plant.raw_columns(raw)["angle"], plant.sense_axis(BARE, raw, 1)["counts"]
        self.assertEqual([math.floor(a / (2 * math.pi / 4096)) for a in angle], list(counts))

    def test_speed_and_position_are_the_output_s(self):
        params = dict(BARE, gear=4, speed_noise_rad_s=0, angle_noise_rad=0)
        raw, _ = plant.run_axis(params, [0.3] * 300)
        seen, columns = plant.sense_axis(params, raw, 1), plant.raw_columns(raw)
        self.assertAlmostEqual(seen["speed"][-1], columns["speed"][-1] / 4)
        self.assertAlmostEqual(seen["angle"][-1], columns["angle"][-1] / 4)

    def test_late_samples_show_the_past(self):
        now, _ = speeds(BARE, [0.3] * 500)
        late, _ = speeds(dict(BARE, late_sample_s=0.003), [0.3] * 500)
        for k in (10, 100, 400):
            self.assertAlmostEqual(late["angle"][k], now["angle"][k - 3], delta=1e-9)

    def test_lost_counts_are_as_many_as_asked(self):
        params = dict(BARE, lost_per_count=0.01)
        raw, _ = plant.run_axis(params, [0.5] * 2000)
        true = plant.raw_columns(raw)["angle"][-1] / (2 * math.pi / 4096)
        lost = true - plant.sense_axis(params, raw, 1)["counts"][-1]
        self.assertAlmostEqual(lost / true, 0.01, delta=4 * math.sqrt(0.01 / true))

    def test_current_noise_has_the_size_asked_for(self):
        raw, _ = plant.run_axis(BARE, [0.0] * 4000)
        seen = plant.sense_axis(dict(BARE, current_noise_A=0.05), raw, 3)["current"]
        rms = math.sqrt(sum(x * x for x in seen) / len(seen))
        self.assertAlmostEqual(rms, 0.05, delta=0.05 * 4 / math.sqrt(2 * 4000))


if __name__ == "__main__":
    unittest.main()
