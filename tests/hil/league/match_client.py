"""Whole matches over the league's ports: two scripted teams, and a real game's vision with our robots in it.

Run by league_test.cc: match_client.py PROGRAM PROTO_FOLDER WORK_FOLDER TEST. Prints nothing when all is well.
"""
import math
import os
import socket
import subprocess
import sys
import time

from league_bench import LeagueBench, free_port, run_one


class Match(LeagueBench):
    def test_mixed_match(self):
        """A real game's vision comes in: its robot pushes ours away, its ball is there, both stand in what goes out."""
        record = os.path.join(self.work, "mixed.omnirec")
        real = ("224.5.23.2", free_port(socket.SOCK_DGRAM))
        self.serve("--league", "--mixed-vision", f"{real[0]}:{real[1]}", "--field", "division-b", "--record", record)
        group = self.join()
        def place(c):
            for robot_id, x, y in ((0, 0.0, 0.0), (3, 2.0, 2.0)):
                robot = c.teleport_robot.add()
                robot.id.id, robot.id.team, robot.x, robot.y, robot.orientation = robot_id, self.sim.BLUE, x, y, 0.0
        self.command_of(place)
        out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        out.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
        self.addCleanup(out.close)
        start = time.monotonic()
        seen_real = pushed = ball = closest = None
        n = 0
        while n < 150:
            t = n / 60
            packet = self.vision.SSL_WrapperPacket()
            frame = packet.detection
            frame.frame_number, frame.camera_id, frame.t_capture, frame.t_sent = n, 0, 50 + t, 50 + t + 0.005
            for robot_id, x in ((4, -600 + 500 * t), (7, 3000)):
                r = frame.robots_yellow.add()
                r.confidence, r.robot_id, r.x, r.y, r.orientation, r.pixel_x, r.pixel_y = 1, robot_id, x, 0, 0, 0, 0
            b = frame.balls.add()
            b.confidence, b.x, b.y, b.pixel_x, b.pixel_y = 1, -1000 + 200 * t, -1500, 0, 0
            out.sendto(packet.SerializeToString(), real)
            n += 1
            while time.monotonic() - start < n / 60:
                group.settimeout(max(0.001, n / 60 - (time.monotonic() - start)))
                try:
                    got = self.vision.SSL_WrapperPacket.FromString(group.recv(65536))
                except TimeoutError:
                    break
                if not got.HasField("detection"):
                    continue
                yellow = {r.robot_id: r for r in got.detection.robots_yellow}
                blue = {r.robot_id: r for r in got.detection.robots_blue}
                self.assertLessEqual(set(yellow), {4, 7})
                self.assertEqual(set(blue), {0, 3})
                if 4 in yellow:
                    seen_real = yellow[4].x
                    gap = blue[0].x - yellow[4].x
                    closest = gap if closest is None else min(closest, gap)
                pushed = blue[0].x
                if got.detection.balls:
                    ball = got.detection.balls[0]
        self.assertGreater(seen_real, 300)
        self.assertGreater(pushed, 400)  # it stood at 0
        self.assertGreater(closest, 140)  # flat front against round side
        self.assertAlmostEqual(ball.y, -1500, delta=5)
        self.assertGreater(ball.x, -700)
        self.stop()
        with open(record) as file:
            tags = [line.split()[0] for line in file]
        self.assertGreater(tags.count("m"), 60)
        self.assertGreater(tags.count("b"), 60)
        checked = subprocess.run([self.program, "check", "--exact", "--quiet", record], capture_output=True, text=True)
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_match_of_two_scripted_teams(self):
        """Six against six, a minute (OMNIHIL_MATCH_SECONDS: longer): whoever is nearest goes behind the ball and kicks at the other goal, the rest
        keep places of their own. No error, no number that is not finite, nobody stuck, goals on both sides are put back."""
        import math
        seconds, step = float(os.environ.get("OMNIHIL_MATCH_SECONDS", "60")), 0.016
        port, yellow = free_port(socket.SOCK_STREAM), free_port(socket.SOCK_DGRAM)
        record = os.path.join(self.work, "match.omnirec")
        self.serve("--league-sync", str(port), "--clock", "free", "--opponents", "0-5",
                   "--league-opponents-port", str(yellow), "--field", "division-b", "--ball", "0,0.3",
                   "--record", record, "--sample-every", "100", robots="0-5")
        connection = socket.create_connection(("127.0.0.1", port), timeout=60)
        self.addCleanup(connection.close)
        self.udp.setblocking(False)
        sim, ball, robots, goals, kicks, outs, last_speed = self.sim, None, {}, 0, 0, 0, 0.0
        moved = {}
        places = [(-1.0, 0.0), (-1.5, 1.2), (-1.5, -1.2), (-2.8, 0.7), (-2.8, -0.7), (-4.2, 0.0)]

        def steer(control, team):
            side = 1 if team == "blue" else -1
            own = {i: pose for (t, i), pose in robots.items() if t == team}
            if not own or ball is None:
                return
            nearest = min(own, key=lambda i: math.hypot(own[i][0] - ball[0], own[i][1] - ball[1]))
            for i, (x, y, yaw) in own.items():
                c = control.robot_commands.add()
                c.id = i
                wx, wy = places[i][0] * side, places[i][1] * side
                look = 0.0 if side > 0 else math.pi
                if i == nearest:
                    look = math.atan2(0.0 - ball[1], 4.5 * side - ball[0])
                    bx, by = ball[0] - 0.3 * math.cos(look), ball[1] - 0.3 * math.sin(look)
                    behind = math.hypot(bx - x, by - y) < 0.12
                    ahead = abs((ball[0] - x) * math.sin(look) - (ball[1] - y) * math.cos(look)) < 0.04
                    wx, wy = ball if behind or (ahead and math.hypot(ball[0] - x, ball[1] - y) < 0.35) else (bx, by)
                    c.kick_speed, c.dribbler_speed = 4.0, 5000.0
                dx, dy = wx - x, wy - y
                size = max(1e-6, math.hypot(dx, dy))
                v = min(1.5, 2.5 * size)
                turn = math.remainder(look - yaw, 2 * math.pi)
                c.move_command.global_velocity.x = v * dx / size
                c.move_command.global_velocity.y = v * dy / size
                c.move_command.global_velocity.angular = max(-4.0, min(4.0, 4.0 * turn))
                key = (team, i)
                if key not in moved or math.hypot(moved[key][0] - x, moved[key][1] - y) > 0.05 or size < 0.25:
                    moved[key] = (x, y, now)
                self.assertLess(now - moved[key][2], 20.0, f"{key} is stuck at {x:.2f}, {y:.2f}")

        now, n = 0.0, 0
        while now < seconds:
            request = sim.SimulationSyncRequest(sim_step=step)
            steer(request.robot_control, "blue")
            other = sim.RobotControl()
            steer(other, "yellow")
            if other.robot_commands:
                self.udp.sendto(other.SerializeToString(), ("127.0.0.1", yellow))
            out = ball and (abs(ball[0]) > 4.45 or abs(ball[1]) > 2.95)
            if out:
                goals += abs(ball[1]) < 0.5
                t = request.simulator_command.control.teleport_ball
                outs += 1  # each half in turn
                t.x, t.y, t.vx, t.vy, t.vz = 1.8 * (-1) ** outs, 0.3, 0.0, 0.0, 0.0
                t.z = 0.0
            answer = self.sync(connection, request)
            self.assertEqual(list(answer.robot_control_response.errors), [])
            try:
                while True:
                    said = sim.RobotControlResponse.FromString(self.udp.recv(65536))
                    self.assertEqual(list(said.errors), [])
            except BlockingIOError:
                pass
            for frame in answer.detection:
                for team, seen in (("blue", frame.robots_blue), ("yellow", frame.robots_yellow)):
                    for r in seen:
                        self.assertTrue(math.isfinite(r.x + r.y + r.orientation))
                        self.assertLess(max(abs(r.x) / 4900, abs(r.y) / 3400), 1.0)
                        robots[(team, r.robot_id)] = (r.x / 1000, r.y / 1000, r.orientation)
                for b in frame.balls:
                    self.assertTrue(math.isfinite(b.x + b.y))
                    speed = 0.0 if ball is None or out else math.hypot(b.x / 1000 - ball[0], b.y / 1000 - ball[1]) / step
                    kicks += speed > last_speed + 1.0
                    last_speed, ball = speed, (b.x / 1000, b.y / 1000)
            n += 1
            now = n * step
        self.assertEqual(len(robots), 12)
        self.assertGreater(kicks, seconds / 20)
        if seconds >= 300:
            self.assertGreater(goals, 0)
        print(f"{kicks} kicks, {goals} goals in {now:.0f} s", file=sys.stderr)
        connection.close()
        self.stop()
        checked = subprocess.run([self.program, "check", "--exact", "--quiet", record], capture_output=True, text=True)
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)


if __name__ == "__main__":
    run_one(Match)
