#!/usr/bin/env python3
"""Writes one simulated drive in the formats of other tools, from their public documents alone: what `omnihil import` has to read.

    make_logs.py FOLDER [SECONDS]          truth.csv, model.toml and one log per format; formats whose Python module is missing are left out

A DC motor with friction, stepped duty, 12 V, 7 pole pairs; the same numbers in each format's own units.
"""
import math
import pathlib
import random
import sqlite3
import struct
import sys

R, K, J, B, C, U, PAIRS = 0.5, 0.03, 6e-5, 2e-6, 0.002, 12.0, 7
RATE, SECONDS = 500, 4.0
TURN = 2 * math.pi


def drive(seconds):
    """Rows of (t, duty, bus_V, current_A, velocity_rad_s, position_rad), from an exact step of 0.1 ms."""
    rng, rows, w, angle, duty = random.Random(1), [], 0.0, 0.0, 0.0
    for n in range(round(RATE * seconds)):
        if n % 125 == 0:
            duty = rng.uniform(-0.8, 0.8)
        rows.append((n / RATE, duty, U, mean if n else 0.0, w, angle))  # current: the mean since the row before
        mean = 0.0
        for _ in range(20):
            mean += (duty * U - K * w) / R / 20
            torque = K * (duty * U - K * w) / R - B * w
            if w == 0.0 and abs(torque) <= C:
                continue
            dw = (torque - C * (math.copysign(1, w) if w else math.copysign(1, torque))) / J / (20 * RATE)
            w = 0.0 if w and w * (w + dw) < 0 else w + dw
            angle += w / (20 * RATE)
    return rows


def table(path, names, rows, separator=",", end="", header=True):
    with open(path, "w", encoding="utf-8") as out:
        if header:
            out.write(separator.join(names) + end + "\n")
        for row in rows:
            out.write(separator.join(repr(v) for v in row) + end + "\n")


def csv_family(folder, rows):
    table(folder / "truth.csv", ["time_s", "duty", "bus_V", "current", "velocity", "position"], rows)
    table(folder / "plain.csv", ["t [ms]", "PWM (%)", "bus_voltage", "motor current [mA]", "speed_rpm"],
          [(1e3 * t, 100 * d, u, 1e3 * i, w * 60 / TURN) for t, d, u, i, w, _ in rows])
    with open(folder / "comma.csv", "w", encoding="utf-8") as out:  # a German spreadsheet
        out.write("Zeit [s];duty;velocity [rad/s]\r\n")
        for t, d, _, _, w, _ in rows:
            out.write(f"{t};{d};{w}".replace(".", ",") + "\r\n")
    table(folder / "odrive.csv", ["time", "axis0.controller.input_torque", "axis0.motor.foc.Iq_measured", "axis0.vel_estimate", "axis0.pos_estimate", "vbus_voltage"],
          [(t, K * i, i, w / TURN, a / TURN, u) for t, _, u, i, w, a in rows])
    table(folder / "moteus.csv", ["timestamp", "servo_stats.position", "servo_stats.velocity", "servo_stats.q_A", "servo_stats.d_A",
                                  "servo_stats.filt_bus_V", "servo_control.q_V"],
          [(1e9 + t, a / TURN, w / TURN, i, 0.0, u, d * u) for t, d, u, i, w, a in rows])
    table(folder / "vesc.csv", ["ms_today", "input_voltage", "temp_motor", "current_motor", "d_axis_current", "q_axis_current", "erpm", "duty_cycle", "fault_code"],
          [(80000000 + 1e3 * t, u, 25.0, i, 0.0, i, w * 60 / TURN * PAIRS, d, 0) for t, d, u, i, w, _ in rows], ";", ";")
    with open(folder / "simplefoc.txt", "w", encoding="utf-8") as out:
        out.write("MOT: Monitor enabled!\nMOT: Ready.\n")
        for _, d, u, i, w, a in rows:
            out.write("\t".join(f"{v:.4f}" for v in (d * u, d * u, 0.0, 1e3 * i, 0.0, w, a)) + "\n")


def mat(folder, rows):
    try:
        import numpy
        import scipy.io
    except ImportError:
        return
    t, d, u, i, w, _ = (numpy.array(c) for c in zip(*rows))
    scipy.io.savemat(folder / "run.mat", {"time_s": t, "duty": d, "note": "bench 3", "meas": {"bus_V": u, "current_A": i, "speed_rpm": w * 60 / TURN},
                                          "gain": 3.0, "picture": numpy.zeros((4, 4))}, do_compression=True)
    scipy.io.savemat(folder / "run4.mat", {"time_s": t, "duty": d, "velocity_rad_s": w}, format="4")


def mat_73(folder, rows):
    """Version 7.3: HDF5 behind a head of 512 bytes; each dataset says its MATLAB class, columns lie as rows."""
    try:
        import h5py
        import numpy
    except ImportError:
        return
    path = folder / "run73.mat"
    with h5py.File(path, "w", userblock_size=512, libver="earliest") as out:
        for name, column in (("time_s", 0), ("duty", 1), ("velocity_rad_s", 4)):
            data = out.create_dataset(name, data=numpy.array([[row[column] for row in rows]]))
            word = h5py.h5t.C_S1.copy()
            word.set_size(6)
            h5py.h5a.create(data.id, b"MATLAB_class", word, h5py.h5s.create(h5py.h5s.SCALAR)).write(numpy.array(b"double"), word)
    with open(path, "r+b") as out:
        out.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created by a test".ljust(116) + bytes(8) + b"\x00\x02IM")


def wpilog(folder, rows):
    """WPILib data log 1.0: records of a bit field, entry id, size, timestamp in us, payload; entry 0 is control."""
    def number(value, size):
        return value.to_bytes(size, "little")

    def size_of(value):
        return max(1, (value.bit_length() + 7) // 8)

    def record(entry, t_us, payload):
        a, b, c = size_of(entry), size_of(len(payload)), size_of(t_us)
        return number((a - 1) | (b - 1) << 2 | (c - 1) << 4, 1) + number(entry, a) + number(len(payload), b) + number(t_us, c) + payload

    def text(word):
        return struct.pack("<I", len(word)) + word.encode()

    out = b"WPILOG" + struct.pack("<HI", 0x0100, 3) + b"abc"
    names = [("/drive/appliedVolts", "double"), ("/drive/velocity_rad_s", "float"), ("/drive/current_A", "double"), ("/drive/ok", "boolean"), ("/who", "string"),
             ("/drive/pair", "double[]"), ("/drive/n", "int64")]
    for n, (name, kind) in enumerate(names, 1):
        out += record(0, 0, b"\x00" + struct.pack("<I", n) + text(name) + text(kind) + text("{}"))
    last = None
    for t, d, u, i, w, _ in rows:
        us = 5_000_000 + round(1e6 * t)
        if d != last:  # only what changed is logged, as NetworkTables do
            out += record(1, us, struct.pack("<d", d * u))
        last = d
        out += record(2, us, struct.pack("<f", w)) + record(3, us, struct.pack("<d", i)) + record(4, us, b"\x01")
        out += record(6, us, struct.pack("<dd", 1.0, 2.0)) + record(7, us, struct.pack("<q", -3))
    out += record(5, 5_000_000, b"nobody") + record(0, 9_000_000, b"\x01" + struct.pack("<I", 1))
    (folder / "run.wpilog").write_bytes(out)


def ulog(folder, rows):
    """PX4 ULog version 1: header, formats, subscriptions, data; nested types and arrays."""
    def message(kind, payload):
        return struct.pack("<HB", len(payload), ord(kind)) + payload

    out = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 1000)
    out += message("B", bytes(40))
    out += message("F", b"pair:float[2] v;uint8_t[2] _padding0;")
    out += message("F", b"motor:uint64_t timestamp;float duty;float velocity_rad_s;pair p;int16_t n;bool ok;char[4] tag;uint8_t[3] _padding0;")
    out += message("F", b"battery:uint64_t timestamp;float voltage_V;")
    out += message("I", bytes([len(b"char[3] sys_name")]) + b"char[3] sys_name" + b"PX4")
    out += message("A", struct.pack("<BH", 0, 0) + b"motor") + message("A", struct.pack("<BH", 0, 1) + b"battery")
    for n, (t, d, u, i, w, _) in enumerate(rows):
        us = 7_000_000 + round(1e6 * t)
        # padding inside nested types is stored, padding at the end of a message is not
        out += message("D", struct.pack("<HQff", 0, us, d, w) + struct.pack("<ff", i, 2.0) + bytes(2) + struct.pack("<h?4s", -5, True, b"abcd"))
        if n % 25 == 0:
            out += message("D", struct.pack("<HQf", 1, us + 300, u))
    out += message("L", struct.pack("<BQ", 54, 8_000_000) + b"done") + message("O", struct.pack("<H", 12))
    (folder / "run.ulg").write_bytes(out)


class Cdr:
    """XCDR1, little-endian: each number at a multiple of its size behind the four bytes of the head."""

    def __init__(self):
        self.out = b""

    def put(self, kind, value):
        size = struct.calcsize(kind)
        self.out += bytes(-len(self.out) % size) + struct.pack("<" + kind, value)
        return self

    def text(self, word):
        self.put("I", len(word) + 1)
        self.out += word.encode() + b"\0"
        return self

    def numbers(self, kind, values):
        self.put("I", len(values))
        for v in values:
            self.put(kind, v)
        return self

    def bytes(self):
        return b"\x00\x01\x00\x00" + self.out


JOINT_STATE = """# joints
std_msgs/Header header

string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
DRIVE = """uint8 MODE_DUTY=1   # a constant
bool ok
int16 step
float32 duty
float64[3] phases
float32 bus_voltage
string<=10 who
my_msgs/Small[] more
================================================================================
MSG: my_msgs/Small
uint8 a
float64 b
"""


def messages(rows):
    """(topic, t_ns, bytes) of a bag: joint states, and a message of one's own."""
    start = 1_700_000_000_000_000_000
    for t, d, u, i, w, a in rows:
        ns = start + round(1e9 * t)
        yield "/joint_states", ns, Cdr().put("i", ns // 10**9).put("I", ns % 10**9).text("base").put("I", 1).text("wheel").numbers("d", [a]).numbers("d", [w]).numbers("d", []).bytes()
        own = Cdr().put("?", True).put("h", -2).put("f", d)
        for p in (0.1, 0.2, i):
            own.put("d", p)
        yield "/drive", ns, own.put("f", u).text("me").put("I", 1).put("B", 7).put("d", 0.5).bytes()


def mcap(folder, rows):
    """MCAP version 0 (mcap.dev/spec): schemas, channels, messages, plain and in chunks."""
    def text(word):
        return struct.pack("<I", len(word)) + (word if isinstance(word, bytes) else word.encode())

    def record(op, payload):
        return struct.pack("<BQ", op, len(payload)) + payload

    head = record(1, text("ros2") + text("made by a test"))
    define = record(3, struct.pack("<H", 1) + text("sensor_msgs/msg/JointState") + text("ros2msg") + text(JOINT_STATE))
    define += record(3, struct.pack("<H", 2) + text("my_msgs/msg/Drive") + text("ros2msg") + text(DRIVE))
    define += record(4, struct.pack("<HH", 1, 1) + text("/joint_states") + text("cdr") + struct.pack("<I", 0))
    define += record(4, struct.pack("<HH", 2, 2) + text("/drive") + text("cdr") + struct.pack("<I", 0))
    define += record(4, struct.pack("<HH", 3, 0) + text("/json") + text("json") + struct.pack("<I", 0))
    define += record(4, struct.pack("<HH", 4, 0) + text("/other") + text("protobuf") + struct.pack("<I", 0))
    data = b""
    for n, (topic, ns, payload) in enumerate(messages(rows)):
        data += record(5, struct.pack("<HIQQ", 1 if topic == "/joint_states" else 2, n, ns, ns) + payload)
    data += record(5, struct.pack("<HIQQ", 3, 0, 1_700_000_000_000_000_000, 0) + b'{"temperature_C": 40.5, "more": {"x": [1, 2]}, "word": "a"}')
    data += record(5, struct.pack("<HIQQ", 4, 0, 1_700_000_000_000_000_000, 0) + b"\x08\x01")
    magic, end = b"\x89MCAP0\r\n", record(15, struct.pack("<I", 0)) + record(2, struct.pack("<QQI", 0, 0, 0))

    def chunk(kind, packed, plain):
        return record(6, struct.pack("<QQQI", 0, 0, len(plain), 0) + text(kind) + struct.pack("<Q", len(packed)) + packed)

    (folder / "plain.mcap").write_bytes(magic + head + define + data + end + magic)
    plain = define + data
    (folder / "chunk.mcap").write_bytes(magic + head + chunk("", plain, plain) + end + magic)
    try:
        import zstandard
        (folder / "zstd.mcap").write_bytes(magic + head + chunk("zstd", zstandard.compress(plain), plain) + end + magic)
    except ImportError:
        pass
    try:
        import lz4.frame
        (folder / "lz4.mcap").write_bytes(magic + head + chunk("lz4", lz4.frame.compress(plain), plain) + end + magic)
    except ImportError:
        pass


def rosbag(folder, rows):
    """rosbag2's SQLite storage: topics and messages; schemas are not in it, but for types that every ROS 2 has."""
    path = folder / "run.db3"
    path.unlink(missing_ok=True)
    bag = sqlite3.connect(path)
    bag.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
    bag.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
    bag.execute("INSERT INTO topics VALUES (1, '/joint_states', 'sensor_msgs/msg/JointState', 'cdr', '')")
    bag.execute("INSERT INTO topics VALUES (2, '/wheel/duty', 'std_msgs/msg/Float32', 'cdr', '')")
    bag.execute("INSERT INTO topics VALUES (3, '/own', 'my_msgs/msg/Drive', 'cdr', '')")
    for topic, ns, payload in messages(rows):
        bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", (1 if topic == "/joint_states" else 3, ns, payload))
    for t, d, *_ in rows:
        bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (2, ?, ?)", (1_700_000_000_000_000_000 + round(1e9 * t), Cdr().put("f", d).bytes()))
    bag.commit()


MODEL = f"""format = "omnihil-model/1"
rig = "axis"

[motor]
resistance_ohm = {{ value = {R}, tolerance = 0.1 }}
torque_constant_Nm_per_A = {{ value = {K}, tolerance = 0.05 }}
rotor_inertia_kg_m2 = {{ value = {J}, tolerance = 0.1 }}
viscous_friction_Nm_s_per_rad = {{ value = {B}, tolerance = 1.0 }}
pole_pairs = {PAIRS}

[supply]
voltage_V = {U}

[effects.coulomb_friction]
torque_Nm = {{ value = {C}, tolerance = 0.5 }}
"""


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "model.toml").write_text(MODEL)
    rows = drive(float(sys.argv[2]) if len(sys.argv) > 2 else SECONDS)
    for write in (csv_family, mat, mat_73, wpilog, ulog, mcap, rosbag):
        write(folder, rows)


if __name__ == "__main__":
    main()
