"""A host of SSL A-Team robots (RNP, 2025) that counts: it answers each robot that looks for one, commands it at a fixed rate
from a socket of its own, and keeps account of every packet both ways. Written from the format's page alone
(docs/radio/ateam-rnp-stspin-2025.md), it shares no code with the bench.

    host = Host()                       # robots look for it at host.port
    host.run(until_s, period_s=0.01)    # monotonic seconds
    host.robots[7].sent, host.robots[7].telemetry, host.robots[7].missing
"""
import math
import select
import socket
import struct
import time
import zlib

HELLO_REQUEST, TELEMETRY, CONTROL, HELLO_RESPONSE = 0x65, 0x66, 0xC9, 0xCA
HEADER = struct.Struct("<IHHBBH")  # CRC-32 of what follows it, version 0.1, command, padding, bytes after the header
VERSION = (0, 1)
BUFFER_BYTES = 1 << 20  # of a socket: what comes while another program has the processor waits
LARGEST = 65536


def packet(command, payload):
    rest = HEADER.pack(0, *VERSION, command, 0, len(payload))[4:] + payload
    return struct.pack("<I", zlib.crc32(rest)) + rest


def packets_in(datagram):
    """The packets of a datagram as (command, payload); (None, rest) for what is none."""
    while datagram:
        if len(datagram) < HEADER.size:
            yield None, datagram
            return
        _, major, minor, command, _, size = HEADER.unpack_from(datagram)
        if (major, minor) != VERSION or len(datagram) < HEADER.size + size:
            yield None, datagram
            return
        yield command, datagram[HEADER.size:HEADER.size + size]
        datagram = datagram[HEADER.size + size:]


def udp_socket():
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
    made.bind(("127.0.0.1", 0))
    made.setblocking(False)
    return made


class Robot:
    """What the host knows of one robot: its address, and what has gone to and fro."""

    def __init__(self, number, address):
        self.number, self.address = number, address
        self.socket = udp_socket()
        self.sent = 0        # packets of ours, the answer to hello_request among them
        self.controls = 0
        self.hellos = 0      # more than one: it has lost us and looked for us again
        self.telemetry = 0
        self.damaged = 0     # what was no packet, or none that a robot sends
        self.missing = 0     # numbers of telemetry that never came
        self.repeated = 0    # numbers that came again, or late
        self.next_number = 0
        self.due_s = 0.0

    @property
    def received(self):
        return self.hellos + self.telemetry

    def number_came(self, number):
        ahead = (number - self.next_number) % 65536
        if ahead >= 32768:
            self.repeated += 1
            return
        self.missing += ahead
        self.next_number = (number + 1) % 65536


class Host:
    def __init__(self):
        self.door = udp_socket()
        self.port = self.door.getsockname()[1]
        self.robots = {}
        self.epoll = select.epoll()
        self.epoll.register(self.door, select.EPOLLIN)
        self.of_socket = {self.door.fileno(): (self.door, None)}
        self.worst_send_s = 0.0  # how late a command left here

    def greet(self, number, address):
        robot = self.robots.get(number)
        if robot is None:
            robot = self.robots[number] = Robot(number, address)
            self.of_socket[robot.socket.fileno()] = (robot.socket, robot)
            self.epoll.register(robot.socket, select.EPOLLIN)
        robot.hellos += 1
        payload = bytes([127, 0, 0, 1]) + struct.pack("<H", robot.socket.getsockname()[1])
        self.send(robot, packet(HELLO_RESPONSE, payload))

    def send(self, robot, data):
        robot.socket.sendto(data, robot.address)  # a full buffer raises: it is never dropped in silence
        robot.sent += 1

    def command(self, robot):
        turn = 0.05 * robot.controls
        control = struct.pack("<fffffI", 0.4 * math.cos(turn), 0.4 * math.sin(turn), 0.5, 0.0, 0.0, 1)
        self.send(robot, packet(CONTROL, control))
        robot.controls += 1

    def receive(self, handle):
        source, robot = self.of_socket[handle]
        while True:
            try:
                datagram, address = source.recvfrom(LARGEST)
            except BlockingIOError:
                return
            for kind, payload in packets_in(datagram):
                if kind == HELLO_REQUEST and len(payload) == 2:
                    self.greet(payload[0], address)
                elif kind == TELEMETRY and robot is not None and len(payload) == 40:
                    robot.telemetry += 1
                    robot.number_came(struct.unpack_from("<H", payload)[0])
                else:
                    (robot or next(iter(self.robots.values()))).damaged += 1

    def listen(self, at_most_s):
        for handle, _ in self.epoll.poll(max(0.0, at_most_s)):
            self.receive(handle)

    def meet(self, count, deadline_s):
        """Until `count` robots have looked for a host."""
        while len(self.robots) < count and time.monotonic() < deadline_s:
            self.listen(0.1)
        return len(self.robots) == count

    def run(self, until_s, period_s, each_s, watch):
        """Commands each robot every `period_s`, robots evenly spread over it; calls `watch` every `each_s`."""
        start_s = next_watch_s = time.monotonic()
        robots = list(self.robots.values())
        for place, robot in enumerate(robots):
            robot.due_s = start_s + period_s * place / len(robots)
        while True:
            now_s = time.monotonic()
            if now_s >= next_watch_s:
                watch()
                next_watch_s += each_s
            if now_s >= until_s:
                return
            for robot in robots:
                while robot.due_s <= now_s:  # what is late is sent late, never left out
                    self.worst_send_s = max(self.worst_send_s, now_s - robot.due_s)
                    self.command(robot)
                    robot.due_s += period_s
            self.listen(min(robot.due_s for robot in robots) - time.monotonic())

    def settle(self, more, deadline_s):
        """Without commands: until `more` further telemetry of each robot has come. What we sent was read before it."""
        wanted = {number: robot.telemetry + more for number, robot in self.robots.items()}
        while time.monotonic() < deadline_s:
            if all(self.robots[number].telemetry >= count for number, count in wanted.items()):
                return True
            self.listen(0.05)
        return False
