"""A game log of the league by python3-protobuf and Python's gzip, which share no code with the program.

game_log_writer.py PROTO_FOLDER WORK_FOLDER FILE: frames of two cameras among the other kinds of record; prints the rows that
a table of it has, without its header.
"""
import gzip
import importlib
import struct
import subprocess
import sys

proto, work, name = sys.argv[1:]
subprocess.run(["protoc", "--python_out", work, "-I", proto, "hil/league/messages/ssl_vision.proto"], cwd=proto, check=True)
sys.path.insert(0, work)
vision = importlib.import_module("hil.league.messages.ssl_vision_pb2")

START_NS = 1_700_000_000_000_000_000
log = b"SSL_LOG_FILE" + struct.pack(">i", 1)


def record(at_ns, kind, data):
    return struct.pack(">qii", at_ns, kind, len(data)) + data


for n in range(40):
    packet = vision.SSL_WrapperPacket()
    frame = packet.detection
    frame.frame_number, frame.camera_id = n, n % 2
    frame.t_capture = START_NS * 1e-9 + n / 64  # exact in binary
    frame.t_sent = frame.t_capture + 0.01
    at_ns = START_NS + n * 15_625_000 + 20_000_001
    rows = []
    for team, robots in (("yellow", frame.robots_yellow), ("blue", frame.robots_blue)):
        for k in range(n % 3):
            robot = robots.add(confidence=0.75, robot_id=k + 5, x=1000.5 + n, y=-250.25 * k, orientation=0.5 * k - 1, pixel_x=1, pixel_y=2)
            rows.append(f"{team},{k + 5},{robot.x / 1000:.6f},{robot.y / 1000:.6f},{robot.orientation:.6f},0.7500")
    robot = frame.robots_blue.add(confidence=0.75, x=1, y=2, pixel_x=1, pixel_y=2)  # neither id nor orientation
    rows.append("blue,,0.001000,0.002000,,0.7500")
    ball = frame.balls.add(confidence=0.5, area=30, x=-4500, y=3000 - n, pixel_x=1, pixel_y=2)
    rows.append(f"ball,,-4.500000,{ball.y / 1000:.6f},,0.5000")
    for row in rows:
        print(f"{frame.t_capture:.6f},{at_ns // 10**9}.{at_ns % 10**9:09d},{frame.camera_id},{n},{row}")
    log += record(at_ns, (4, 4, 4, 1)[n % 4], packet.SerializeToString())
    log += record(at_ns, 3, b"\x08\x01") + record(at_ns, 0, b"") + record(at_ns, 5, b"tracker") + record(at_ns, 1, b"\xff\xff\xff")

# As of 2010: geometry whose sizes lack what is required now, and whose fields have other types.
old = vision.SSL_WrapperPacket()
old.detection.CopyFrom(packet.detection)
old.detection.ClearField("robots_blue")
geometry = b"\x0a\x07\x08\x0a\x10\x80\x30\x30\x05"  # field: 1, 2 and 6 as varints
log += record(at_ns, 2, old.SerializeToString() + b"\x12" + bytes([len(geometry)]) + geometry)
for row in rows:
    if not row.startswith("blue"):
        print(f"{frame.t_capture:.6f},{at_ns // 10**9}.{at_ns % 10**9:09d},{frame.camera_id},{n},{row}")
index = struct.pack(">qqq", 16, 100, 24) + b"INDEXED"
log += record(0, 6, index)
with (gzip.open if name.endswith(".gz") else open)(name, "wb") as out:
    out.write(log)
