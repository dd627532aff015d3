#!/usr/bin/env python3
"""The hidden robot behind a RoboTeam REM v8 base station: a serial device with its own packets, and SSL-Vision by multicast.

    radio_bench.py --device ./real --robot 3 --vision 224.5.23.2:10006 --hide '{"radius_1": 1.03}' --model my_robot.toml

Shares nothing with the program but the packets' public table and the league's messages. Lives in real time: rows of 1 ms up to now,
whenever the loop comes round; a command acts late_radio_s after it came. With --break it is another robot (or the same, broken)
from --break-after seconds after the first command on. Prints "ready" when the device can be opened; ends on SIGTERM.
"""
import argparse
import json
import math
import os
import pathlib
import pty
import random
import select
import signal
import socket
import struct
import time
import tty

import dataset
import plant
import radio_case

COMMAND, FEEDBACK, STATE = (0x22, 28), (0x27, 28), (0x28, 99)
VERSION, PI = 8, math.pi
BLUE = 1
PROCESSING_S = 0.005  # from a frame's capture to its sending, as its packet says: or the cameras' clock is 5 ms off the host's


class Bits:
    """Fields at byte.bit offsets, most significant bit first."""

    def __init__(self, data):
        self.number, self.size = int.from_bytes(data, "big"), 8 * len(data)

    def put(self, byte, bit, bits, raw):
        self.number |= (raw & (1 << bits) - 1) << (self.size - (8 * byte + bit) - bits)

    def get(self, byte, bit, bits):
        return self.number >> (self.size - (8 * byte + bit) - bits) & ((1 << bits) - 1)

    def bytes(self):
        return self.number.to_bytes(self.size // 8, "big")


def raw(value, low, high, bits=16):
    return int((min(max(value, low), high) - low) / (high - low) * (2**bits - 1))


def number(count, low, high, bits=16):
    return low + (high - low) * count / (2**bits - 1)


def wrapped(angle):
    return math.remainder(angle, 2 * PI)


def packet_from(robot, kind, message_id):
    code, size = kind
    packet = Bits(bytes(size))
    for byte, bit, bits, value in ((0, 0, 8, code), (1, 7, 1, 1), (2, 0, 4, robot), (2, 4, 1, BLUE), (3, 0, 4, VERSION),
                                   (3, 4, 4, message_id), (10, 0, 8, size)):
        packet.put(byte, bit, bits, value)
    return packet


def answers(robot, message_id, row):
    feedback = packet_from(robot, FEEDBACK, message_id)
    feedback.put(15, 0, 16, raw(wrapped(row["turn"]), -PI, PI))
    feedback.put(17, 0, 16, raw(row["bus"], 15, 30))
    state = packet_from(robot, STATE, message_id)
    state.put(15, 0, 32, raw(row["turn"], -50000, 50000, 32))
    state.put(19, 0, 16, raw(row["gyro"], -20, 20))
    for wheel in range(4):
        state.put(21 + 2 * wheel, 0, 16, raw(row[f"speed_{wheel + 1}"], -1000, 1000))
    return feedback.bytes() + state.bytes()


def commands_in(buffer, robot):
    """(message id, field velocity x, y, yaw rate) of each whole RobotCommand; what is no packet is passed over."""
    found = []
    while len(buffer) >= 11:
        size = buffer[10]
        if (buffer[0], size) != COMMAND:
            del buffer[: size if 11 <= size <= 127 else 1]
            continue
        if len(buffer) < size:
            break
        packet = Bits(bytes(buffer[:size]))
        del buffer[:size]
        if packet.get(1, 0, 4) != robot or packet.get(3, 0, 4) != VERSION:
            continue
        rho, theta = number(packet.get(11, 0, 16), 0, 30), number(packet.get(13, 0, 16), -PI, PI)
        spin = number(packet.get(17, 0, 16), -10 * PI, 10 * PI)
        found.append((packet.get(3, 4, 4), rho * math.cos(theta), rho * math.sin(theta), spin))
    return found


def varint(value):
    out = b""
    while value > 0x7F:
        out += bytes([value & 0x7F | 0x80])
        value >>= 7
    return out + bytes([value])


def vision_packet(frame, captured, sent, robot, x, y, turn):
    """SSL_WrapperPacket by its field numbers."""
    def key(field, kind):
        return varint(field << 3 | kind)

    seen = b"".join((key(1, 5), struct.pack("<f", 1.0), key(2, 0), varint(robot),
                     *(key(n, 5) + struct.pack("<f", v) for n, v in ((3, 1e3 * x), (4, 1e3 * y), (5, turn), (6, 0), (7, 0)))))
    body = b"".join((key(1, 0), varint(frame), key(2, 1), struct.pack("<d", captured), key(3, 1), struct.pack("<d", sent),
                     key(4, 0), varint(0), key(7, 2), varint(len(seen)), seen))
    return key(1, 2) + varint(len(body)) + body


class Bench:
    def __init__(self, words):
        self.words, self.rng = words, random.Random(words.seed)
        drawn = radio_case.draw_robot(random.Random(words.seed), [])
        drawn.true.update(supply_drift_V=0)
        self.params = {**drawn.true, **json.loads(words.hide), "seed": words.seed}
        if words.model:
            dataset.write_model(pathlib.Path(words.model), "robot", radio_case.model_sections(drawn))
        self.robot = plant.LiveRobot(self.params)
        self.master, self.slave = pty.openpty()
        tty.setraw(self.slave)
        os.set_blocking(self.master, False)
        if os.path.lexists(words.device):
            os.unlink(words.device)
        os.symlink(os.ttyname(self.slave), words.device)
        group, port = words.vision.split(":")
        self.group = (group, int(port))
        self.udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.udp.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton("127.0.0.1"))
        self.buffer, self.waiting, self.heard = bytearray(), [], (0.0, 0.0, 0.0)
        self.rows, self.frames, self.taken = 0, 0, []
        self.broken = json.loads(words.break_)
        self.breaks_s = None if self.broken else math.inf  # None: after the first command
        self.row = self.robot.row((0.0, 0.0, 0.0))
        self.start_s, self.clock_s = time.monotonic(), 1000.0 + time.time()  # the cameras' clock is not ours

    def break_it(self):
        self.robot.change({**self.params, **self.broken})
        self.breaks_s = math.inf
        print(f"broken {self.rows * 1e-3:.3f}", flush=True)

    def advance(self, now_s):
        late_s = self.params["late_radio_s"]
        while self.rows * 1e-3 < now_s:
            at_s = self.rows * 1e-3
            if self.breaks_s is not None and at_s >= self.breaks_s:
                self.break_it()
            while self.waiting and self.waiting[0][0] + late_s <= at_s:
                self.heard = self.waiting.pop(0)[1]
            x, y, spin = self.heard
            c, s = math.cos(self.row["turn"]), math.sin(self.row["turn"])
            self.row = self.robot.row((c * x + s * y, -s * x + c * y, spin))
            self.rows += 1
            if at_s >= self.frames / 60:
                self.see(at_s)

    def see(self, at_s):
        p = self.params
        x, y = (self.row[n] + self.rng.gauss(0, p["vision_noise_m"]) for n in ("x", "y"))
        turn = wrapped(self.row["turn"] + self.rng.gauss(0, p["vision_noise_rad"]))
        captured = self.clock_s + at_s
        self.taken.append((at_s + PROCESSING_S,
                           vision_packet(self.frames, captured, captured + PROCESSING_S, self.words.robot, x, y, turn)))
        self.frames += 1

    def send_frames(self, now_s):
        while self.taken and self.taken[0][0] <= now_s:
            self.udp.sendto(self.taken.pop(0)[1], self.group)

    def take(self, now_s):
        try:
            self.buffer += os.read(self.master, 4096)
        except BlockingIOError:
            return
        for message_id, *velocity in commands_in(self.buffer, self.words.robot):
            if self.breaks_s is None:
                self.breaks_s = now_s + self.words.break_after
            self.waiting.append((now_s, tuple(velocity)))
            try:
                os.write(self.master, answers(self.words.robot, message_id, self.row))
            except BlockingIOError:
                pass  # nobody reads

    def run(self):
        alive = [True]
        signal.signal(signal.SIGTERM, lambda *_: alive.clear())
        print("ready", flush=True)
        while alive:
            select.select([self.master], [], [], 0.002)
            now_s = time.monotonic() - self.start_s
            self.advance(now_s)
            self.send_frames(now_s)
            self.take(now_s)
        os.unlink(self.words.device)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--device", default="./real")
    parser.add_argument("--robot", type=int, default=3)
    parser.add_argument("--vision", default="224.5.23.2:10006")
    parser.add_argument("--hide", default="{}")
    parser.add_argument("--model", default="")
    parser.add_argument("--break", dest="break_", default="{}")
    parser.add_argument("--break-after", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=1)
    Bench(parser.parse_args()).run()


if __name__ == "__main__":
    main()
