"""A client of the league that shares no code with the program: python3-protobuf's own classes of the published messages.

Run by league_test.cc: league_client.py PROGRAM PROTO_FOLDER WORK_FOLDER TEST. Prints nothing when all is well.
"""
import importlib
import os
import socket
import struct
import subprocess
import sys
import time
import unittest


def messages(proto_folder, work):
    """The generated modules, from the same .proto files by protoc's Python output."""
    subprocess.run(["protoc", "--python_out", work, "-I", proto_folder,
                    "hil/league/messages/ssl_vision.proto", "hil/league/messages/ssl_simulation.proto"],
                   cwd=proto_folder, check=True)
    sys.path.insert(0, work)
    return (importlib.import_module("hil.league.messages.ssl_simulation_pb2"),
            importlib.import_module("hil.league.messages.ssl_vision_pb2"))


def free_port(kind):
    with socket.socket(socket.AF_INET, kind) as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class League(unittest.TestCase):
    program = proto = work = None

    @classmethod
    def setUpClass(cls):
        cls.sim, cls.vision = messages(cls.proto, cls.work)

    def serve(self, *more, robots="0,3", quiet=("--quiet",)):
        """The bench on ports of its own; self.robot, self.control, self.group are where it listens and speaks."""
        self.robot, self.control = free_port(socket.SOCK_DGRAM), free_port(socket.SOCK_DGRAM)
        self.group = ("224.5.23.2", free_port(socket.SOCK_DGRAM))
        device = os.path.join(self.work, f"dongle{self.robot}")
        self.process = subprocess.Popen(
            [self.program, "serve", "--robot", "ulaval_delta", "--robots", robots, "--physics", "planar", "--device", device,
             "--league-robot-port", str(self.robot), "--league-control-port", str(self.control),
             "--vision", f"{self.group[0]}:{self.group[1]}", *quiet, *more],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.addCleanup(self.stop)
        for line in self.process.stdout:
            if line.startswith("league simulation control"):
                break
        self.udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.udp.settimeout(20)
        self.addCleanup(self.udp.close)

    def stop(self):
        if self.process.poll() is not None:
            return
        self.process.terminate()
        self.process.communicate(timeout=30)

    def ask(self, port, request, answer):
        data = request if isinstance(request, bytes) else request.SerializeToString()
        self.udp.sendto(data, ("127.0.0.1", port))
        answer.ParseFromString(self.udp.recv(65536))
        return answer

    def control_robots(self, *commands):
        request = self.sim.RobotControl()
        for fill in commands:
            fill(request.robot_commands.add())
        return self.ask(self.robot, request, self.sim.RobotControlResponse())

    def join(self):
        s = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        s.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        s.bind(("", self.group[1]))
        s.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                     struct.pack("4s4s", socket.inet_aton(self.group[0]), socket.inet_aton("127.0.0.1")))
        s.settimeout(20)
        self.addCleanup(s.close)
        return s

    def detection(self, group):
        while True:
            packet = self.vision.SSL_WrapperPacket.FromString(group.recv(65536))
            if packet.HasField("detection"):
                return packet.detection

    def test_robot_drives_and_answers_with_telemetry(self):
        self.serve("--league")
        group = self.join()

        def forward(c):
            c.id = 3
            c.move_command.local_velocity.forward = 0.8
            c.move_command.local_velocity.left = 0
            c.move_command.local_velocity.angular = 0
        start = next(r for r in self.detection(group).robots_blue if r.robot_id == 3)
        end = time.monotonic() + 20
        moved = None
        while time.monotonic() < end:
            answer = self.control_robots(forward)
            self.assertEqual(list(answer.errors), [])
            self.assertEqual([f.id for f in answer.feedback], [0, 3])
            moved = next(r for r in self.detection(group).robots_blue if r.robot_id == 3)
            if moved.x - start.x > 300:
                break
        self.assertGreater(moved.x - start.x, 300)  # mm along its own forward, the field's x
        self.assertLess(abs(moved.y - start.y), 60)
        telemetry = self.sim.Telemetry()
        self.assertTrue(answer.feedback[1].custom.Unpack(telemetry))
        self.assertEqual(answer.feedback[1].custom.type_url, "type.googleapis.com/omnihil.league.Telemetry")
        self.assertGreater(telemetry.battery_V, 10)
        self.assertEqual(len(telemetry.motor_current_A), 4)
        self.assertTrue(any(abs(w) > 5 for w in telemetry.omega_wheel_rad_s))

    def test_every_refused_field_has_its_error(self):
        self.serve("--league")
        sim = self.sim
        unknown = self.control_robots(lambda c: setattr(c, "id", 9))
        self.assertEqual([(e.code) for e in unknown.errors], ["UNKNOWN_ROBOT"])

        def wrong_unit(c):
            c.id = 0
            c.move_command.global_velocity.x = 1500
            c.move_command.global_velocity.y = 0
            c.move_command.global_velocity.angular = 0
        self.assertEqual([e.code for e in self.control_robots(wrong_unit).errors], ["OUT_OF_RANGE"])
        unreadable = self.ask(self.robot, b"\xff\xff\xff", sim.RobotControlResponse())
        self.assertEqual([e.code for e in unreadable.errors], ["UNREADABLE"])
        # Every field of simulation control and configuration, one at a time.
        fields = {
            "teleport_safely": lambda c: setattr(c.control.teleport_ball, "teleport_safely", True),
            "by_force": lambda c: setattr(c.control.teleport_ball, "by_force", True),
            "simulation_speed": lambda c: setattr(c.control, "simulation_speed", 2),
            "geometry": lambda c: c.config.geometry.field.MergeFrom(self.vision.SSL_GeometryFieldSize(
                field_length=1, field_width=1, goal_width=1, goal_depth=1, boundary_width=1)),
            "robot_specs": lambda c: c.config.robot_specs.add().id.CopyFrom(sim.RobotId(id=0, team=sim.BLUE)),
            "realism_config": lambda c: c.config.realism_config.SetInParent(),
            "vision_port": lambda c: setattr(c.config, "vision_port", 1),
        }
        for name, fill in fields.items():
            command = sim.SimulatorCommand()
            fill(command)
            answer = self.ask(self.control, command, sim.SimulatorResponse())
            self.assertEqual([e.code for e in answer.errors], ["UNSUPPORTED_FIELD"], name)
            self.assertIn(name, answer.errors[0].message)
        command = sim.SimulatorCommand()
        robot = command.control.teleport_robot.add()
        robot.id.id, robot.id.team, robot.by_force = 0, sim.BLUE, True
        answer = self.ask(self.control, command, sim.SimulatorResponse())
        self.assertEqual([e.code for e in answer.errors], ["UNSUPPORTED_FIELD"])
        command = sim.SimulatorCommand()
        robot = command.control.teleport_robot.add()
        robot.id.id, robot.id.team = 0, sim.YELLOW
        answer = self.ask(self.control, command, sim.SimulatorResponse())
        self.assertEqual([e.code for e in answer.errors], ["UNKNOWN_ROBOT"])

    def test_teleport_and_vision(self):
        self.serve("--league", "--cameras", "4")
        group = self.join()
        command = self.sim.SimulatorCommand()
        robot = command.control.teleport_robot.add()
        robot.id.id, robot.id.team = 3, self.sim.BLUE
        robot.x, robot.y, robot.orientation = 2.0, -1.5, 1.25
        answer = self.ask(self.control, command, self.sim.SimulatorResponse())
        self.assertEqual(list(answer.errors), [])
        cameras, found, geometry = set(), {}, None
        end = time.monotonic() + 20
        while time.monotonic() < end and (len(cameras) < 4 or not found or geometry is None):
            packet = self.vision.SSL_WrapperPacket.FromString(group.recv(65536))
            if packet.HasField("geometry"):
                geometry = packet.geometry
            if packet.HasField("detection"):
                cameras.add(packet.detection.camera_id)
                for r in packet.detection.robots_blue:
                    if r.robot_id == 3 and abs(r.x - 2000) < 1:
                        found[packet.detection.camera_id] = r
                self.assertEqual(len(packet.detection.balls), 0)
        self.assertEqual(cameras, {0, 1, 2, 3})
        self.assertEqual(len(found), 1)  # one quarter of the field
        seen = next(iter(found.values()))
        self.assertAlmostEqual(seen.y, -1500, delta=1)
        self.assertAlmostEqual(seen.orientation, 1.25, delta=0.01)
        self.assertEqual((geometry.field.field_length, geometry.field.field_width), (9000, 6000))
        self.assertEqual(len(geometry.calib), 4)
        self.assertGreaterEqual(len(geometry.field.field_lines), 12)

    def test_recording_of_the_league_replays(self):
        record = os.path.join(self.work, "league.omnirec")
        self.serve("--league", "--record", record, "--sample-every", "1")
        command = self.sim.SimulatorCommand()
        robot = command.control.teleport_robot.add()
        robot.id.id, robot.id.team, robot.x, robot.y, robot.orientation = 0, self.sim.BLUE, 1.0, -2.0, 0.5
        self.ask(self.control, command, self.sim.SimulatorResponse())

        def turn(c):
            c.id = 0
            c.move_command.global_velocity.x, c.move_command.global_velocity.y = 0.4, 0.2
            c.move_command.global_velocity.angular = 1.0
            c.kick_speed, c.dribbler_speed = 3, 700
        for _ in range(20):
            self.assertEqual(list(self.control_robots(turn).errors), [])
            time.sleep(0.02)
        self.stop()
        with open(record) as file:
            tags = [line.split()[0] for line in file]
        self.assertEqual(tags.count("p"), 1)
        self.assertEqual(tags.count("c"), 20)
        checked = subprocess.run([self.program, "check", "--exact", "--quiet", record], capture_output=True, text=True)
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def command_of(self, *fills):
        command = self.sim.SimulatorCommand()
        for fill in fills:
            fill(command.control)
        answer = self.ask(self.control, command, self.sim.SimulatorResponse())
        self.assertEqual(list(answer.errors), [])

    def test_two_teams_and_a_ball(self):
        record = os.path.join(self.work, "match.omnirec")
        yellow = free_port(socket.SOCK_DGRAM)
        self.serve("--league", "--field", "division-b", "--opponents", "0-1", "--league-opponents-port", str(yellow),
                   "--ball", "0.5,0.25", "--record", record, "--sample-every", "1")
        group = self.join()
        frame = self.detection(group)
        self.assertEqual(sorted(r.robot_id for r in frame.robots_blue), [0, 3])
        self.assertEqual(sorted(r.robot_id for r in frame.robots_yellow), [0, 1])
        self.assertEqual([(b.x, b.y) for b in frame.balls], [(500.0, 250.0)])

        def ball(c):
            c.teleport_ball.x, c.teleport_ball.y, c.teleport_ball.vx = 3.5, 0.0, 3.0
            c.teleport_ball.roll = True

        def gone(c):
            robot = c.teleport_robot.add()
            robot.id.id, robot.id.team, robot.present = 1, self.sim.YELLOW, False

        def placed(c):
            robot = c.teleport_robot.add()
            robot.id.id, robot.id.team = 0, self.sim.YELLOW
            robot.x, robot.y, robot.orientation, robot.v_x = -2.0, 1.0, 0.0, 1.0
        self.command_of(gone, placed)
        self.command_of(ball)
        seen, end = [], time.monotonic() + 20
        while time.monotonic() < end and (not seen or seen[-1] < 4550):
            frame = self.detection(group)
            seen += [b.x for b in frame.balls]
        self.assertGreater(seen[-1], 4550)  # in the goal
        self.assertEqual([r.robot_id for r in frame.robots_yellow], [0])
        self.assertEqual(sorted(seen[-5:]), seen[-5:])

        # A yellow robot goes to the ball that lies before it, and kicks it.
        def ahead(c):
            c.teleport_ball.x, c.teleport_ball.y, c.teleport_ball.vx = -1.0, 1.0, 0.0

        def stand(c):
            robot = c.teleport_robot.add()
            robot.id.id, robot.id.team = 0, self.sim.YELLOW
            robot.x, robot.y, robot.orientation = -1.6, 1.0, 0.0
        self.command_of(stand, ahead)
        fastest, last, end = 0.0, None, time.monotonic() + 20
        while time.monotonic() < end and fastest < 3.0:
            request = self.sim.RobotControl()
            c = request.robot_commands.add()
            c.id, c.kick_speed, c.dribbler_speed = 0, 5, 5000
            c.move_command.local_velocity.forward = 0.6
            c.move_command.local_velocity.left = c.move_command.local_velocity.angular = 0
            answer = self.ask(yellow, request, self.sim.RobotControlResponse())
            self.assertEqual(list(answer.errors), [])
            self.assertEqual([f.id for f in answer.feedback], [0])
            frame = self.detection(group)
            if last and frame.balls:
                fastest = max(fastest, (frame.balls[0].x - last[1]) / 1000 / (frame.t_capture - last[0]))
            if frame.balls:
                last = (frame.t_capture, frame.balls[0].x)
        self.assertGreater(fastest, 3.0)  # m/s
        telemetry = self.sim.Telemetry()
        answer.feedback[0].custom.Unpack(telemetry)
        self.assertGreater(telemetry.capacitor_V, 1)
        self.stop()
        with open(record) as file:
            tags = [line.split()[0] for line in file]
        self.assertEqual((tags.count("a"), tags.count("v"), tags.count("b")), (1, 1, 2))
        self.assertGreater(tags.count("w"), 50)
        checked = subprocess.run([self.program, "check", "--exact", "--quiet", record], capture_output=True, text=True)
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def sync(self, connection, request):
        data = request.SerializeToString()
        length, head = len(data), b""
        while True:
            head += bytes([length & 127 | (128 if length > 127 else 0)])
            length >>= 7
            if not length:
                break
        connection.sendall(head + data)
        size, shift = 0, 0
        while True:
            b = connection.recv(1)[0]
            size |= (b & 127) << shift
            shift += 7
            if not b & 128:
                break
        data = b""
        while len(data) < size:
            data += connection.recv(size - len(data))
        return self.sim.SimulationSyncResponse.FromString(data)

    def run_in_steps(self, steps, step_s):
        port = free_port(socket.SOCK_STREAM)
        self.serve("--league-sync", str(port), "--clock", "free")
        connection = socket.create_connection(("127.0.0.1", port), timeout=20)
        self.addCleanup(connection.close)
        states = []
        for n in range(steps):
            request = self.sim.SimulationSyncRequest(sim_step=step_s)
            c = request.robot_control.robot_commands.add()
            c.id = 0
            c.move_command.global_velocity.x = 0.5
            c.move_command.global_velocity.y = 0.3
            c.move_command.global_velocity.angular = 0.2
            answer = self.sync(connection, request)
            self.assertEqual(list(answer.robot_control_response.errors), [])
            states.append(answer.detection[0].SerializeToString())
        odd = self.sync(connection, self.sim.SimulationSyncRequest(sim_step=0.0105))
        self.assertEqual([e.code for e in odd.robot_control_response.errors], ["OUT_OF_RANGE"])
        self.assertEqual(odd.detection[0].t_capture, answer.detection[0].t_capture)  # nothing moved
        return states, answer

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

    def test_steps_are_exact_and_repeat(self):
        first, last = self.run_in_steps(50, 0.016)
        frame = last.detection[0]
        self.assertAlmostEqual(frame.t_capture - 1_700_000_000, 50 * 0.016, places=6)
        robot = next(r for r in frame.robots_blue if r.robot_id == 0)
        self.assertGreater(robot.x, 150)
        self.assertGreater(robot.y, 80)
        again, _ = self.run_in_steps(50, 0.016)
        self.assertEqual(first, again)


def run_one(case):
    case.program, case.proto, case.work = sys.argv[1:4]
    os.makedirs(case.work, exist_ok=True)
    unittest.main(argv=[sys.argv[0], case.__name__ + "." + sys.argv[4]])


if __name__ == "__main__":
    run_one(League)
