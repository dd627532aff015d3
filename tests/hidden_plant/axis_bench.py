#!/usr/bin/env python3
"""The hidden axis behind a real motor controller's messages, or behind a board with the serial shim. In real time.

    axis_bench.py --speaks moteus --device ./can --hide '{"dry_direction": 0.3}' --model motor.toml
    axis_bench.py --speaks odrive --device ./can …       both: a USB-CAN stick (LAWICEL) at a pseudo-terminal
    axis_bench.py --speaks shim --device ./board …       frames of docs/remote-mcu.md at a pseudo-terminal
    axis_bench.py --speaks shim --udp 20131 …            the same as datagrams, to 127.0.0.1:20131

Shares nothing with the program but the vendors' and the page's tables. A device's current and voltage are its q axis's: of the
amplitude of a phase. Prints "ready" when the device can be opened; ends on SIGTERM. With --mute-after N it stops answering after N
messages, with --sag-after V falls to that supply, with --fault-after N reports a fault.
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
from axis_rig import draw_rig, model_sections

ROW_S = 0.25e-3
PERIOD_S = 2e-3  # of the board with the shim: its control period
ROOT_3 = math.sqrt(3)
CURRENT = plant.RAW.index("current")
FD_LENGTH = [0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64]


class Axis:
    """The hidden plant on the wall clock, and what its device asks of it."""

    def __init__(self, words):
        rng = random.Random(words.seed)
        rig = draw_rig(rng, "drive", 1.0, ("current", "encoder", "not heated"))
        self.believed, self.params = rig.believed, {
            **rig.true, **json.loads(words.hide), "sample_s": ROW_S, "step_s": 25e-6, "seed": words.seed, "supply_drift_V": 0.0}
        if words.model:
            dataset.write_model(pathlib.Path(words.model), "axis", model_sections(rig))
        self.live = plant.LiveAxis(self.params)
        self.how, self.asked, self.rows, self.currents = plant.LiveAxis.OFF, 0.0, 0, []
        self.start_s = time.monotonic()
        self.live.look()

    def now_s(self):
        return time.monotonic() - self.start_s

    def advance(self, to_s):
        del self.currents[:-10000]
        while self.rows * ROW_S < to_s:
            self.live.row(self.how, self.asked)
            self.live.look()
            self.rows += 1
            self.currents.append(self.live.raw[CURRENT])

    def drive(self, how, asked=0.0):
        self.how, self.asked = how, asked

    def mean_current(self, seen):
        """Since it was last asked for, with the noise of what is seen."""
        mean = sum(self.currents) / len(self.currents) if self.currents else 0.0
        self.currents.clear()
        return mean + seen["current"] - self.live.raw[CURRENT]

    def turns(self, seen):
        return seen["counts"] / self.params["encoder_cpr"]

    def turns_s(self):
        return self.live.raw[plant.RAW.index("speed")] / (2 * math.pi)

    def torque_to_current(self, torque_Nm):
        return torque_Nm / self.believed["flux_Vs"]


class Stick:
    """CAN frames as lines: (id, extended, remote, data) in and out."""

    def __init__(self):
        self.text = b""

    def frames(self, data, answer):
        self.text += data
        found = []
        while b"\r" in self.text:
            line, self.text = self.text.split(b"\r", 1)
            kind = line[:1].decode()
            if kind not in "tTrRbBdD" or not kind:
                answer(b"\r")
                continue
            digits = 8 if kind.isupper() else 3
            number, code = int(line[1:1 + digits], 16), int(line[1 + digits:2 + digits], 16)
            body = bytes.fromhex(line[2 + digits:].decode())
            if kind not in "rR" and len(body) != FD_LENGTH[code]:
                answer(b"\a")
                continue
            answer((b"Z" if kind.isupper() else b"z") + b"\r")
            found.append((number, kind.isupper(), kind in "rR", body))
        return found

    @staticmethod
    def line(number, data, fd):
        length = next(n for n in FD_LENGTH if n >= len(data))
        data += b"\x50" * (length - len(data))
        return f"{'b' if fd else 't'}{number:03X}{FD_LENGTH.index(length):X}{data.hex().upper()}\r".encode()


class Moteus:
    """Registers over CAN FD, device 1: modes stopped, voltage, position as feed-forward torque alone."""

    BYTES = (1, 2, 4, 4)

    def __init__(self, axis, words):
        self.axis, self.words, self.stick = axis, words, Stick()
        self.mode, self.fault, self.registers, self.heard, self.fed_s = 0, 0, {}, 0, 0.0

    def varuint(self, data, at):
        value = shift = 0
        while True:
            value |= (data[at] & 0x7F) << shift
            shift += 7
            at += 1
            if data[at - 1] < 0x80:
                return value, at

    def accesses(self, data):
        at = 0
        while at < len(data):
            head, at = data[at], at + 1
            if head == 0x50:
                continue
            kind, form, count = head >> 4, head >> 2 & 3, head & 3
            if count == 0:
                count, at = self.varuint(data, at)
            first, at = self.varuint(data, at)
            for k in range(count):
                value = None
                if kind == 0:
                    raw = data[at:at + self.BYTES[form]]
                    at += self.BYTES[form]
                    value = struct.unpack("<" + "bhif"[form], raw)[0]
                yield kind, first + k, form, value

    def measured(self, register):
        seen = self.axis.live.seen()
        current = seen["current"]
        return {0: self.mode, 1: self.axis.turns(seen), 2: self.axis.turns_s(), 3: current * self.axis.believed["flux_Vs"],
                4: current * 2 / ROOT_3, 0x0D: seen["bus"], 0x0F: self.fault}[register]

    def act(self):
        r = self.registers
        if self.words.fault_after and self.heard > self.words.fault_after:
            self.mode, self.fault = 1, 33
        if self.mode == 8:
            self.axis.drive(plant.LiveAxis.VOLTAGE, ROOT_3 * r.get(0x1B, 0.0))
        elif self.mode == 10:
            assert r[0x23] == 0 and r[0x24] == 0, "only feed-forward is known here"
            self.axis.drive(plant.LiveAxis.CURRENT, self.axis.torque_to_current(r[0x22]))
        else:
            self.axis.drive(plant.LiveAxis.OFF)

    def take(self, data, send):
        for number, extended, _, body in self.stick.frames(data, send):
            if not extended or number != 0x8001:
                continue
            self.heard += 1
            now_s = self.axis.now_s()
            self.axis.advance(now_s)
            reply, writes = b"", {}
            for kind, register, form, value in self.accesses(body):
                if kind == 0:
                    writes[register] = value
                    continue
                # The state before this frame acts.
                told = 0 if register == 0 and 0 in writes else self.measured(register)
                told = writes[0] if register == 0 and 0 in writes and self.mode != 1 else told
                reply += bytes([0x20 | form << 2 | 1, register]) + struct.pack(
                    "<" + "bhif"[form], int(told) if form < 3 else told)
            if 0 in writes and self.mode != 1:
                self.mode, self.registers = writes.pop(0), writes
            self.fed_s = now_s
            self.act()
            if not self.words.mute_after or self.heard < self.words.mute_after:
                send(Stick.line(0x100, reply, True))

    def idle(self, send):
        self.axis.advance(self.axis.now_s())
        if self.mode == 10 and self.axis.now_s() - self.fed_s > 0.1:
            self.mode = 11
            self.act()


class Odrive:
    """CANSimple, node 0: torque control."""

    def __init__(self, axis, words):
        self.axis, self.words, self.stick = axis, words, Stick()
        self.state, self.control, self.error, self.torque, self.heard = 1, 2, 0, 0.0, 0
        self.next_s = {0x01: 0.1, 0x09: 0.01}

    def told(self, command):
        seen = self.axis.live.seen()
        if command == 0x01:
            return struct.pack("<IBBBB", self.error, self.state, 0, 1, 0)
        if command == 0x09:
            return struct.pack("<ff", self.axis.turns(seen), self.axis.turns_s())
        if command == 0x14:
            return struct.pack("<ff", self.axis.torque_to_current(self.torque) * 2 / ROOT_3, seen["current"] * 2 / ROOT_3)
        return struct.pack("<ff", seen["bus"], 0.0)

    def act(self):
        if self.state == 8 and self.control == 1:
            self.axis.drive(plant.LiveAxis.CURRENT, self.axis.torque_to_current(self.torque))
        else:
            self.axis.drive(plant.LiveAxis.OFF)

    def take(self, data, send):
        for number, extended, remote, body in self.stick.frames(data, send):
            if extended or number >> 5 != 0:
                continue
            self.heard += 1
            self.axis.advance(self.axis.now_s())
            command = number & 0x1F
            if remote:
                if not self.words.mute_after or self.heard < self.words.mute_after:
                    send(Stick.line(command, self.told(command), False))
            elif command == 0x0B:
                self.control = struct.unpack("<II", body)[0]
            elif command == 0x07:
                self.state = struct.unpack("<I", body)[0]
            elif command == 0x0E:
                self.torque = struct.unpack("<f", body)[0]
            self.act()

    def idle(self, send):
        now_s = self.axis.now_s()
        self.axis.advance(now_s)
        for command, due_s in self.next_s.items():
            if now_s >= due_s and not self.words.mute_after:
                self.next_s[command] += 0.1 if command == 0x01 else 0.01
                send(Stick.line(command, self.told(command), False))


def crc16(data):
    crc = 0xFFFF
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xFFFF
    return crc


def stuffed(body):
    out = b""
    for piece in (body + b"\0").split(b"\0")[:-1]:
        out += bytes([len(piece) + 1]) + piece  # no piece is longer than 253 bytes here
    return out + b"\0"


def unstuffed(data):
    out, at = b"", 0
    while at < len(data):
        code = data[at]
        if code == 0 or at + code > len(data):
            return None
        out += data[at + 1:at + code]
        at += code
        if code < 0xFF and at < len(data):
            out += b"\0"
    return out


class Shim:
    """A board with motors: HELLO until it is answered, then sensors every period; what it is told is in force from the next on."""

    TIMEOUT = 25  # periods

    def __init__(self, axis, words):
        self.axis, self.words = axis, words
        self.line, self.greeted, self.periods, self.number, self.silent = b"", False, 0, 0, 0
        self.came, self.force, self.next_hello_s = None, (0, 0, 0), 0.0

    def frame(self, kind, sequence, payload):
        body = struct.pack("<BH", kind, sequence) + payload
        return stuffed(body + struct.pack("<H", crc16(body)))

    def take(self, data, send):
        self.line += data
        while b"\0" in self.line:
            piece, self.line = self.line.split(b"\0", 1)
            body = unstuffed(piece) if piece else None
            if not body or len(body) < 5 or crc16(body[:-2]) != struct.unpack("<H", body[-2:])[0]:
                continue
            kind, sequence = struct.unpack("<BH", body[:3])
            if kind == 0x81:
                self.greeted, self.silent, self.came, self.force = True, 0, None, (0, 0, 0)
            elif kind == 0x82 and self.greeted and len(body) == 23:
                self.came = (sequence, body[3], struct.unpack("<h", body[7:9])[0])

    def hello(self):
        b, p = self.axis.believed, self.axis.params
        return struct.pack("<BBHI12f", 1, 4, 0, 0, 0, 0, 0, 0, 0.025, 0.08, 1.0, p["encoder_cpr"], b["supply_V"],
                           b["resistance_ohm"], b["flux_Vs"], 0.1)

    def idle(self, send):
        now_s = self.axis.now_s()
        while self.periods * PERIOD_S <= now_s:
            self.period(self.periods * PERIOD_S, send)
            self.periods += 1

    def period(self, at_s, send):
        self.axis.advance(at_s)
        if not self.greeted:
            if at_s >= self.next_hello_s:
                self.next_hello_s = at_s + 0.2
                send(self.frame(0x01, 0, self.hello()))
            return
        if self.came:
            self.force, self.came, self.silent = self.came, None, 0
        else:
            self.silent += 1
            if self.silent >= self.TIMEOUT:
                self.greeted, self.force = False, (0, 0, 0)
        number, mode, duty = self.force
        self.axis.drive(plant.LiveAxis.DUTY if mode == 1 else plant.LiveAxis.OFF, duty / 32767)
        seen = self.axis.live.seen()
        bus = self.words.sag_to if self.words.sag_to and mode == 1 else seen["bus"]
        self.number = self.number % 65535 + 1
        if self.words.mute_after and self.number > self.words.mute_after:
            return
        counts = [int(seen["counts"]) & 0xFFFFFFFF, 0, 0, 0]
        send(self.frame(0x02, self.number, struct.pack(
            "<I4I4hH3hBH", int(at_s * 1e6) & 0xFFFFFFFF, *counts, round(1e3 * self.axis.mean_current(seen)), 0, 0, 0, round(1e3 * bus),
            0, 0, 0, 0, number)))


class Pty:
    def __init__(self, name):
        self.name = name
        self.master, self.slave = pty.openpty()
        tty.setraw(self.slave)
        os.set_blocking(self.master, False)
        if os.path.lexists(name):
            os.unlink(name)
        os.symlink(os.ttyname(self.slave), name)

    def fileno(self):
        return self.master

    def read(self):
        try:
            return os.read(self.master, 4096)
        except BlockingIOError:
            return b""

    def send(self, data):
        try:
            os.write(self.master, data)
        except BlockingIOError:
            pass  # nobody reads

    def close(self):
        os.unlink(self.name)


class Udp:
    def __init__(self, port):
        self.to = ("127.0.0.1", port)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.setblocking(False)

    def fileno(self):
        return self.socket.fileno()

    def read(self):
        try:
            return self.socket.recv(4096)
        except (BlockingIOError, ConnectionRefusedError):
            return b""

    def send(self, data):
        try:
            self.socket.sendto(data, self.to)
        except ConnectionRefusedError:
            pass

    def close(self):
        self.socket.close()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--speaks", choices=("moteus", "odrive", "shim"), required=True)
    parser.add_argument("--device", default="./can")
    parser.add_argument("--udp", type=int, default=0)
    parser.add_argument("--hide", default="{}")
    parser.add_argument("--model", default="")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--mute-after", type=int, default=0)
    parser.add_argument("--fault-after", type=int, default=0)
    parser.add_argument("--sag-to", type=float, default=0.0)
    words = parser.parse_args()
    axis = Axis(words)
    device = {"moteus": Moteus, "odrive": Odrive, "shim": Shim}[words.speaks](axis, words)
    wire = Udp(words.udp) if words.udp else Pty(words.device)
    alive = [True]
    signal.signal(signal.SIGTERM, lambda *_: alive.clear())
    print("ready", flush=True)
    while alive:
        select.select([wire], [], [], 0.0005)
        if data := wire.read():
            device.take(data, wire.send)
        device.idle(wire.send)
    wire.close()
    seen = axis.live.seen()
    print(json.dumps({"how": axis.how, "speed_rad_s": axis.live.raw[plant.RAW.index("speed")], "counts": seen["counts"]}), flush=True)


if __name__ == "__main__":
    main()
