#!/usr/bin/env python3
"""The hidden robot against formulas a reader can check: kinematics, acceleration, tilt, loads, delay, firmware, determinism."""
import math
import random
import unittest

import plant
import robot_drives

ANGLES = [math.radians(a) for a in robot_drives.ANGLES]
# No friction, no noise: motion in closed form. Half full duty makes rims run at k' u.
FREE = dict(
    viscous_Nms=0,
    dry_Nm=0,
    roller_grip=0,
    current_noise_A=0,
    bus_noise_V=0,
    gyro_noise_rad_s=0,
    accel_noise_m_s2=0,
    vision_noise_m=0,
    vision_noise_rad=0,
)


def drive(twist, seconds=1.5, ramp_s=0.8):
    """Duties that hold a body twist, ramped up."""
    out = []
    for k in range(round(seconds * 1000)):
        share = min(1.0, k * 1e-3 / ramp_s)
        rims = [(-math.sin(a) * twist[0] + math.cos(a) * twist[1] + 0.0805 * twist[2]) for a in ANGLES]
        out.append([share * rim / 0.027 * 3 * 0.0335 / 22.2 for rim in rims] + [0.0])
    return out


class RobotPlantTest(unittest.TestCase):
    def test_wheels_follow_the_body_without_slip_when_it_runs_steadily(self):
        for twist in ((0.8, 0, 0), (0, -0.6, 0), (0, 0, 3)):
            c = plant.run_robot(FREE, drive(twist, 2.5))
            w = c["gyro"][-1]
            s = 1e-3
            vx, vy = (c["x"][-1] - c["x"][-2]) / s, (c["y"][-1] - c["y"][-2]) / s
            turn = c["turn"][-1]
            body = (math.cos(turn) * vx + math.sin(turn) * vy, -math.sin(turn) * vx + math.cos(turn) * vy)
            for j, want in enumerate(twist[:2]):
                self.assertAlmostEqual(body[j], want, delta=0.01)
            self.assertAlmostEqual(w, twist[2], delta=0.01 * max(1, abs(twist[2])))
            for k, a in enumerate(ANGLES):
                counts = c[f"counts_{k + 1}"]
                rim = (counts[-1] - counts[-101]) / 16384 * 2 * math.pi / 3 * 0.027 / 0.1
                self.assertAlmostEqual(
                    rim, -math.sin(a) * body[0] + math.cos(a) * body[1] + 0.0805 * w, delta=0.006
                )

    def test_its_firmware_drives_what_the_radio_asks_for(self):
        asked = [[0.0] * 5] * 300 + [[0.5, 0.3, 1.0, 0.0, 0.0]] * 2200
        late = 0.02
        c = plant.run_robot({**FREE, "radio": 1, "late_radio_s": late}, asked)
        turn, s = c["turn"][-1], 1e-3
        vx, vy = (c["x"][-1] - c["x"][-2]) / s, (c["y"][-1] - c["y"][-2]) / s
        self.assertAlmostEqual(math.cos(turn) * vx + math.sin(turn) * vy, 0.5, delta=0.01)
        self.assertAlmostEqual(-math.sin(turn) * vx + math.cos(turn) * vy, 0.3, delta=0.01)
        self.assertAlmostEqual(c["gyro"][-1], 1.0, delta=0.02)
        for k, a in enumerate(ANGLES):
            rim = -math.sin(a) * 0.5 + math.cos(a) * 0.3 + 0.0805 * 1.0
            self.assertAlmostEqual(c[f"speed_{k + 1}"][-1], rim / 0.027, delta=0.5)
        # The first speed that is not 0 comes the radio's delay after the command, and a tick of the loop later.
        first = next(k for k, v in enumerate(c["speed_1"]) if v != 0)
        self.assertAlmostEqual(1e-3 * (first - 300), late, delta=0.004)

    def test_force_makes_the_acceleration_of_mass_and_wheels(self):
        # All four motors at the same current i: moment = 4 R_b (N k i / r) on I + 4 J_w (R_b / r)^2.
        c = plant.run_robot(FREE, [[0.02] * 4 + [0.0]] * 60)
        amps = sum(c["current_1"][20:40]) / 20
        inertia = 0.012 + 4 * (2.2e-5 + 9 * 1.35e-5) * (0.0805 / 0.027) ** 2
        expected = 4 * 0.0805 / 0.027 * 3 * 0.0335 * amps / inertia
        self.assertAlmostEqual((c["gyro"][39] - c["gyro"][19]) / 0.020, expected, delta=0.02 * expected)

    def test_a_free_robot_rolls_down_a_tilted_floor(self):
        # m g sin(a) moves the robot and, through four free wheels, their inertia; windings short the motors: none at 1e9 ohm.
        c = plant.run_robot(
            dict(FREE, tilt_rad=0.02, tilt_towards=0.7, resistance_ohm=1e6), [[0.0] * 5] * 1000
        )
        along = c["x"][-1] * math.cos(0.7) + c["y"][-1] * math.sin(0.7)
        across = -c["x"][-1] * math.sin(0.7) + c["y"][-1] * math.cos(0.7)
        share = sum((-math.sin(a) * math.cos(0.7) + math.cos(a) * math.sin(0.7)) ** 2 for a in ANGLES)
        mass = 2.4 + share * (2.2e-5 + 9 * 1.35e-5) / 0.027**2
        self.assertAlmostEqual(along, 0.5 * 2.4 / mass * 9.80665 * math.sin(0.02), delta=0.02 * along)
        self.assertLess(abs(across), 0.1 * along)

    def test_dry_friction_holds_a_robot_on_a_slope_to_the_bit(self):
        c = plant.run_robot(dict(FREE, dry_Nm=5e-3, tilt_rad=0.005), [[0.0] * 5] * 500)
        self.assertEqual([c[f"counts_{k}"][-1] for k in range(1, 5)], [0.0] * 4)

    def test_camera_frames_come_at_their_rate_and_show_the_pose(self):
        c = plant.run_robot(FREE, drive((0.5, 0, 1)))
        frames = [k for k, x in enumerate(c["cam_x"]) if x == x]
        self.assertEqual(len(frames), 90)  # 60 Hz for 1.5 s
        for k in frames:
            self.assertEqual((c["cam_x"][k], c["cam_turn"][k]), (c["x"][k], c["turn"][k]))
        late = plant.run_robot(dict(FREE, late_vision_s=0.010), drive((0.5, 0, 1)))
        self.assertAlmostEqual(late["cam_x"][frames[-1]], c["x"][frames[-1] - 10], delta=1e-12)

    def test_sagging_supply_is_low_by_resistance_times_current(self):
        c = plant.run_robot(dict(FREE, battery_ohm=0.1), drive((1, 0, 0), 0.4))
        duty = drive((1, 0, 0), 0.4)[300]
        drawn = sum(d * c[f"current_{k + 1}"][300] for k, d in enumerate(duty[:4]))
        self.assertAlmostEqual(22.2 - c["bus"][300], 0.1 * drawn, delta=0.02)

    def test_same_seed_same_record(self):
        noisy = dict(seed=3)
        a, b = plant.run_robot(noisy, drive((1, 0, 0), 0.3)), plant.run_robot(noisy, drive((1, 0, 0), 0.3))
        self.assertEqual(list(a["current_1"]), list(b["current_1"]))
        other = plant.run_robot(dict(seed=4), drive((1, 0, 0), 0.3))
        self.assertNotEqual(list(a["current_1"]), list(other["current_1"]))

    def test_shorter_steps_change_nothing_that_can_be_seen(self):
        asked = [
            row + [0.0]
            for row in robot_drives.duties(
                robot_drives.random_drive(random.Random(1), 4000, 1e-3), plant.ROBOT.defaults
            )
        ]
        coarse, fine = plant.run_robot(FREE, asked), plant.run_robot(dict(FREE, step_s=10e-6), asked)
        for name, least in (("x", 1e-4), ("turn", 5e-4), ("gyro", 1e-3), ("current_1", 0.005)):
            rms = math.sqrt(sum((a - b) ** 2 for a, b in zip(coarse[name], fine[name])) / 4000)
            self.assertLess(rms, least, name)

    def test_row_by_row_is_the_same_robot(self):
        params = dict(radio=1, late_radio_s=0, seed=7, payload_kg=0.3, radius_2=1.02)
        asked = [[0.8, 0.2, 1.0, 0.0, 0.0]] * 400 + [[-0.5, 0.0, 0.0, 0.0, 0.0]] * 400
        whole = plant.run_robot(params, asked)
        live = plant.LiveRobot(params)
        for k, row in enumerate(asked):
            now = live.row(row[:3])
            for name in ("x", "y", "turn", "speed_1", "bus", "gyro", "counts_3"):
                self.assertEqual(now[name], whole[name][k], (k, name))
        live.close()


if __name__ == "__main__":
    unittest.main()
