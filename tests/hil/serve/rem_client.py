"""A host of RoboTeam Twente's REM v8 written from the packet table alone: its own bit packing, MSB first.

Drives one robot forward at 1 m/s through the virtual dongle and compares what comes back, and what the
recording holds as the truth, with the command, the encoder and eq. (5) of the robot's geometry."""
import math
import statistics
import struct
import sys
import time

import serial

import bench as rig
from bench import Bench, DEADLINE_S

PI = math.pi
VERSION = 8
# type code, size in bytes
ROBOT_COMMAND, ROBOT_FEEDBACK, STATE_INFO = (0x22, 28), (0x27, 28), (0x28, 99)
SIZES = dict((ROBOT_FEEDBACK, STATE_INFO))
LOG = 0x2D  # free text of the base station follows its header

# The robot: wheel angles from body x towards y, order right front, left front, left back, right back.
WHEEL_ANGLE_RAD = [math.radians(angle) for angle in (300, 60, 135, 225)]
WHEEL_RADIUS_M, CENTRE_RADIUS_M = 0.0274, 0.0804
COUNTS_PER_TURN = 4 * 2048


def float32(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


def scale(low, high, bits):
    return float32(float(f"{(high - low) / (2**bits - 1):.16f}"))


def to_raw(value, low, high, bits):
    """REM's rule: divide and truncate in float32."""
    return int(float32(float32(float32(value) - float32(low)) / scale(low, high, bits)))


def to_value(raw, low, high, bits):
    return float32(float32(raw * scale(low, high, bits)) + float32(low))


class Bits:
    """Fields at byte.bit offsets, most significant bit first."""

    def __init__(self, data):
        self.number, self.size = int.from_bytes(data, "big"), 8 * len(data)

    def put(self, byte, bit, bits, raw):
        self.number |= raw << (self.size - (8 * byte + bit) - bits)

    def get(self, byte, bit, bits):
        return self.number >> (self.size - (8 * byte + bit) - bits) & (2**bits - 1)

    def bytes(self):
        return self.number.to_bytes(self.size // 8, "big")


def robot_command(robot, message_id, rho_m_s, theta_rad, omega_rad_s):
    code, size = ROBOT_COMMAND
    packet = Bits(bytes(size))
    packet.put(0, 0, 8, code)
    packet.put(1, 0, 4, robot)
    packet.put(1, 4, 1, 1)  # toColor: blue
    packet.put(2, 7, 1, 1)  # fromPC
    packet.put(3, 0, 4, VERSION)
    packet.put(3, 4, 4, message_id % 16)
    packet.put(4, 0, 48, 0)  # timestamp: this host has no clock
    packet.put(10, 0, 8, size)
    packet.put(11, 0, 16, to_raw(rho_m_s, 0, 30, 16))
    packet.put(13, 0, 16, to_raw(theta_rad, -PI, PI, 16))
    packet.put(15, 0, 16, to_raw(0, -PI, PI, 16))  # yaw, not used
    packet.put(17, 0, 16, to_raw(omega_rad_s, -10 * PI, 10 * PI, 16))
    packet.put(19, 0, 16, to_raw(0, -PI, PI, 16))  # cameraYaw, not used
    packet.put(21, 0, 16, to_raw(0, -15, 15, 16))
    packet.put(23, 0, 16, to_raw(0, -PI, PI, 16))
    packet.put(27, 5, 1, 1)  # sendStateInfo
    return packet.bytes()


def read_packet(port):
    """A robot's next packet: its type code and its bits. Packets follow each other without any framing."""
    end_s = time.monotonic() + DEADLINE_S
    head = port.read(11)
    while len(head) == 11 and head[0] == LOG:
        assert time.monotonic() < end_s, "the base station talks, the robot does not"
        port.read(head[10] - 11)
        head = port.read(11)
    assert len(head) == 11, f"no packet within {port.timeout} s (got {head.hex()})"
    header = Bits(head)
    code, size = head[0], head[10]
    assert SIZES.get(code) == size, f"type {code:#x} with {size} bytes"
    assert header.get(3, 0, 4) == VERSION and header.get(1, 7, 1) == 1, head.hex()  # toPC
    body = port.read(size - 11)
    assert len(body) == size - 11, "a packet was cut"
    return code, Bits(head + body)


def eq5(v_forward_m_s, v_left_m_s, omega_rad_s):
    """Wheel speeds of a body velocity, rolling without slip."""
    return [(-math.sin(a) * v_forward_m_s + math.cos(a) * v_left_m_s + CENTRE_RADIUS_M * omega_rad_s) /
            WHEEL_RADIUS_M for a in WHEEL_ANGLE_RAD]


# A robot whose command is younger than this goes on as commanded: its firmware lets go 0.25 s after the last.
KEPT_MS = 100
DRIVEN_MS, STEADY_MS, STEADY_STATES = 3000, 1000, 40
MOST_ROUNDS = 20_000  # five minutes of a computer that never has the time: a fault, or no computer for this


def time_ms(packet):
    """When the robot said it, by its own clock."""
    return packet.get(4, 0, 48)


def drive(port):
    """One command per RobotFeedback, so the robot's own answers are the clock: until it has been driven for 3 s of its time
    without a pause that its firmware would have noticed, with enough answers in the last of them. A computer that is
    busy elsewhere makes such pauses; the 3 s begin again behind each. Returns the rounds and what came back in those 3 s."""
    feedback, states = [], []
    for rounds in range(MOST_ROUNDS):
        port.write(robot_command(0, rounds, 1.0, 0.0, 0.0))
        have = len(feedback)
        while len(feedback) == have:
            code, packet = read_packet(port)
            assert packet.get(2, 0, 4) == 0 and packet.get(2, 4, 1) == 1  # from robot 0, blue
            (feedback if code == ROBOT_FEEDBACK[0] else states).append(packet)
        now_ms = time_ms(feedback[-1])
        if have > 0 and now_ms - time_ms(feedback[-2]) > KEPT_MS:
            feedback, states = feedback[-1:], []
        last = [state for state in states if time_ms(state) > now_ms - STEADY_MS]
        if now_ms - time_ms(feedback[0]) >= DRIVEN_MS and len(last) > STEADY_STATES:
            return rounds + 1, feedback, states
    raise AssertionError(f"no {DRIVEN_MS} ms without a pause in {MOST_ROUNDS} commands")


def mean(rows, column):
    return statistics.fmean(values[column] for _, _, values in rows)


def one_metre_per_second_forward():
    columns = [f"true_theta_rotor_rad_{i}" for i in range(1, 5)] + [f"encoder_counts_{i}" for i in range(1, 5)]
    columns += ["true_v_forward_m_s", "true_v_left_m_s", "true_omega_body_rad_s"]
    arguments = ["--robot", "roboteam_2024", "--radio", "roboteam-rem-v8", "--robots", "0", "--record",
                 "{folder}/run.omnirec", "--epoch-ms", "1700000000000"]
    with Bench(arguments) as bench:
        with serial.Serial(bench.device, 115200, timeout=DEADLINE_S) as port:
            rounds, feedback, states = drive(port)
        report = bench.stop()
        assert report.code == 0, report.text
        assert report.good == rounds and report.refused == 0, report.text
        rows = rig.recorded(bench.path("run.omnirec"), columns)

    # Encoder: the count is the true rotor angle, within one count, at every recorded instant.
    for _, _, values in rows:
        for i in range(1, 5):
            exact = values[f"true_theta_rotor_rad_{i}"] * COUNTS_PER_TURN / (2 * PI)
            assert abs(values[f"encoder_counts_{i}"] - exact) <= 1.0, (i, values)

    # Steady state: the last second in which commands came, by the robot's clock and the recording's; StateInfo has its time.
    end_ms = time_ms(states[-1])
    steady = [state for state in states if time_ms(state) > end_ms - STEADY_MS]
    true = [row for row in rows if end_ms - STEADY_MS < 1_700_000_000_000 + 1000 * row[0] <= end_ms]
    assert len(steady) >= STEADY_STATES and len(true) >= 10, (len(steady), len(true))
    forward, left, turn = (mean(true, name) for name in columns[8:])
    print(f"true velocity {forward:.4f} m/s forward, {left:.4f} left, {turn:.4f} rad/s")
    for _, _, values in true:
        assert abs(values["true_v_forward_m_s"] - 1.0) <= 0.02, values
        assert abs(values["true_v_left_m_s"]) <= 0.02, values

    # StateInfo wheelSpeed1..4 at 21, 23, 25, 27, -1000..1000 rad/s, against eq. (5) of the true velocity.
    for i, expected in enumerate(eq5(forward, left, turn)):
        told = statistics.fmean(to_value(s.get(21 + 2 * i, 0, 16), -1000, 1000, 16) for s in steady)
        print(f"wheel {i + 1}: told {told:.3f} rad/s, eq. (5) {expected:.3f} rad/s")
        assert abs(told - expected) <= 0.01 * abs(expected), (i, told, expected)

    # RobotFeedback: rho at 11, theta at 13, battery at 17.
    rho = statistics.fmean(to_value(f.get(11, 0, 16), 0, 30, 16) for f in feedback[-40:])
    theta = statistics.fmean(to_value(f.get(13, 0, 16), -PI, PI, 16) for f in feedback[-40:])
    battery = to_value(feedback[-1].get(17, 0, 16), 15, 30, 16)
    print(f"feedback rho {rho:.4f} m/s, theta {theta:.4f} rad, battery {battery:.2f} V")
    assert abs(rho - forward) <= 0.02 and abs(theta) <= 0.02 and 20 < battery < 26, (rho, theta, battery)


if __name__ == "__main__":
    sys.exit(rig.main({"one_metre_per_second_forward": one_metre_per_second_forward}))
