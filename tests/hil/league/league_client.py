"""A client of the league, message by message.

Run by league_test.cc: league_client.py PROGRAM PROTO_FOLDER WORK_FOLDER TEST. Prints nothing when all is well.
"""
import os
import socket
import subprocess
import time

from league_bench import LeagueBench, free_port, run_one


class League(LeagueBench):
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

    def test_steps_are_exact_and_repeat(self):
        first, last = self.run_in_steps(50, 0.016)
        frame = last.detection[0]
        self.assertAlmostEqual(frame.t_capture - 1_700_000_000, 50 * 0.016, places=6)
        robot = next(r for r in frame.robots_blue if r.robot_id == 0)
        self.assertGreater(robot.x, 150)
        self.assertGreater(robot.y, 80)
        again, _ = self.run_in_steps(50, 0.016)
        self.assertEqual(first, again)


if __name__ == "__main__":
    run_one(League)
