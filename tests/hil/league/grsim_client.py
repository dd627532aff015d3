"""An old client of grSim, as those of league_bench.py: python3-protobuf's own classes, here by the published field numbers.

Run by league_test.cc: grsim_client.py PROGRAM PROTO_FOLDER WORK_FOLDER TEST. Prints nothing when all is well.
"""
import os
import socket
import subprocess
import time

from league_bench import LeagueBench, free_port, run_one


class Grsim(LeagueBench):
    def grsim_classes(self):
        """grSim's messages by their published field numbers, not by our .proto."""
        from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
        kinds = {"u": 13, "i": 5, "f": 2, "d": 1, "b": 8}  # uint32, int32, float, double, bool

        def fields(message, text, required):
            for field in text.split():
                name, number, kind = field.split(":")
                made = message.field.add(name=name, number=int(number), label=2 if required else 1)
                if kind in kinds:
                    made.type = kinds[kind]
                else:
                    made.type, made.type_name = 11, "." + kind.rstrip("*")
                    made.label = 3 if kind.endswith("*") else 1
        file = descriptor_pb2.FileDescriptorProto(name="grsim_client.proto", syntax="proto2")
        for name, must, may in (
                ("grSim_Robot_Command", "id:1:u kickspeedx:2:f kickspeedz:3:f veltangent:4:f velnormal:5:f velangular:6:f "
                 "spinner:7:b wheelsspeed:8:b", "wheel1:9:f wheel2:10:f wheel3:11:f wheel4:12:f later:99:u"),
                ("grSim_Commands", "timestamp:1:d isteamyellow:2:b", "robot_commands:3:grSim_Robot_Command*"),
                ("grSim_RobotReplacement", "x:1:d y:2:d dir:3:d id:4:u yellowteam:5:b", "turnon:6:b"),
                ("grSim_BallReplacement", "", "x:1:d y:2:d vx:3:d vy:4:d"),
                ("grSim_Replacement", "", "ball:1:grSim_BallReplacement robots:2:grSim_RobotReplacement*"),
                ("grSim_Packet", "", "commands:1:grSim_Commands replacement:2:grSim_Replacement"),
                ("Robot_Status", "robot_id:1:i infrared:2:b flat_kick:3:b chip_kick:4:b", ""),
                ("Robots_Status", "", "robots_status:1:Robot_Status*")):
            message = file.message_type.add(name=name)
            fields(message, must, True)
            fields(message, may, False)
        pool = descriptor_pool.DescriptorPool()
        pool.Add(file)

        def of(name):
            descriptor = pool.FindMessageTypeByName(name)
            if hasattr(message_factory, "GetMessageClass"):
                return message_factory.GetMessageClass(descriptor)
            return message_factory.MessageFactory(pool).GetPrototype(descriptor)
        return of("grSim_Packet"), of("Robots_Status")

    def test_old_client_of_grsim(self):
        """A robot drives by body velocity and by wheels, robots and ball are put down, the kick and the beam come back."""
        packet_of, status_of = self.grsim_classes()
        record = os.path.join(self.work, "grsim.omnirec")
        ports = [free_port(socket.SOCK_DGRAM) for _ in range(3)]
        told = []
        for port in ports[1:]:
            told.append(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            told[-1].bind(("127.0.0.1", port))
            told[-1].settimeout(0.02)
            self.addCleanup(told[-1].close)
        self.serve("--league", "--grsim", ",".join(map(str, ports)), "--field", "division-b", "--opponents", "0",
                   "--league-opponents-port", str(free_port(socket.SOCK_DGRAM)), "--ball", "0,-2", "--record", record,
                   "--sample-every", "1", quiet=())
        group = self.join()

        def send(packet):
            self.udp.sendto(packet.SerializeToString(), ("127.0.0.1", ports[0]))

        def command(robot_id, yellow=False, **fields):
            packet = packet_of()
            packet.commands.timestamp, packet.commands.isteamyellow = 0, yellow
            c = packet.commands.robot_commands.add(id=robot_id, kickspeedx=0, kickspeedz=0, veltangent=0, velnormal=0,
                                                   velangular=0, spinner=False, wheelsspeed=False)
            for name, value in fields.items():
                setattr(c, name, value)
            return packet

        def robot(frame, robot_id, yellow=False):
            return next(r for r in (frame.robots_yellow if yellow else frame.robots_blue) if r.robot_id == robot_id)

        def until(done, packet, seconds=20):
            end = time.monotonic() + seconds
            while time.monotonic() < end:
                if packet is not None:
                    send(packet)
                frame = self.detection(group)
                if done(frame):
                    return frame
            self.fail("not within 20 s")
        start = robot(self.detection(group), 3)
        frame = until(lambda f: robot(f, 3).x - start.x > 300, command(3, veltangent=0.8))
        self.assertLess(abs(robot(frame, 3).y - start.y), 60)
        left = robot(self.detection(group), 3)
        until(lambda f: robot(f, 3).y - left.y > 200, command(3, velnormal=0.6))
        # All wheels alike turn it anticlockwise.
        turned = robot(self.detection(group), 3).orientation
        until(lambda f: 0.3 < robot(f, 3).orientation - turned < 2,
              command(3, wheelsspeed=True, wheel1=10, wheel2=10, wheel3=10, wheel4=10))
        # Robots of both teams and the ball.
        packet = packet_of()
        packet.replacement.robots.add(x=-1.5, y=1.0, dir=90, id=0, yellowteam=False)
        packet.replacement.robots.add(x=2.5, y=1.25, dir=-90, id=0, yellowteam=True)
        packet.replacement.ball.x, packet.replacement.ball.y = 2.0, 0.5
        packet.replacement.ball.vx = -1.0
        send(packet)
        frame = until(lambda f: abs(robot(f, 0).x + 1500) < 2, None)
        blue, yellow = robot(frame, 0), robot(frame, 0, True)
        self.assertAlmostEqual(blue.y, 1000, delta=2)
        self.assertAlmostEqual(blue.orientation, 1.5708, delta=0.01)
        self.assertAlmostEqual(yellow.x, 2500, delta=2)
        self.assertAlmostEqual(yellow.orientation, -1.5708, delta=0.01)
        frame = until(lambda f: f.balls and f.balls[0].x < 1900, None)
        self.assertAlmostEqual(frame.balls[0].y, 500, delta=5)
        # The yellow robot looks at a ball before it, goes there and kicks; its own port hears of beam and kick.
        packet = packet_of()
        packet.replacement.ball.x, packet.replacement.ball.y = 2.5, 0.9
        packet.replacement.ball.vx = packet.replacement.ball.vy = 0
        send(packet)
        seen, end = [], time.monotonic() + 20
        kick = command(0, True, veltangent=0.4, kickspeedx=3.0, spinner=True)
        while time.monotonic() < end and not any(s.flat_kick for s in seen):
            send(kick)
            try:
                seen += status_of.FromString(told[1].recv(65536)).robots_status
            except TimeoutError:
                pass
        self.assertTrue(any(s.flat_kick and not s.chip_kick for s in seen), seen)
        self.assertEqual({s.robot_id for s in seen}, {0})
        self.assertTrue(any(s.infrared for s in seen))
        frame = until(lambda f: f.balls and f.balls[0].y < 600, None)
        # What is not known or not done is counted and said at the end, and nothing breaks.
        bad = command(3)
        bad.commands.robot_commands[0].later = 7
        send(bad)
        send(command(14))
        off = packet_of()
        off.replacement.robots.add(x=0, y=0, dir=0, id=3, yellowteam=False, turnon=False)
        send(off)
        self.udp.sendto(b"\xff\xff", ("127.0.0.1", ports[0]))
        before = robot(self.detection(group), 3)
        until(lambda f: robot(f, 3).x != before.x or robot(f, 3).y != before.y, command(3, veltangent=0.5))
        self.process.terminate()
        report = self.process.communicate(timeout=30)[0]
        self.assertRegex(report, r"grSim +\d+ packets, 4 errors, the last: UNREADABLE")
        checked = subprocess.run([self.program, "check", "--exact", "--quiet", record], capture_output=True, text=True)
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)


if __name__ == "__main__":
    run_one(Grsim)
