"""A bench with the league's ports and a client that shares no code with the program: python3-protobuf's own classes of the published
messages. Base of league_client.py, match_client.py and grsim_client.py.
"""
import importlib
import os
import socket
import struct
import subprocess
import sys
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


class LeagueBench(unittest.TestCase):
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

    def command_of(self, *fills):
        command = self.sim.SimulatorCommand()
        for fill in fills:
            fill(command.control)
        answer = self.ask(self.control, command, self.sim.SimulatorResponse())
        self.assertEqual(list(answer.errors), [])

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


def run_one(case):
    case.program, case.proto, case.work = sys.argv[1:4]
    os.makedirs(case.work, exist_ok=True)
    unittest.main(argv=[sys.argv[0], case.__name__ + "." + sys.argv[4]])
