"""Other people's CAN programs at `omnihil serve --motor-bus` and at a board, on vcan0: what under_can.py runs. Each function
is a test; it prints its name when it has passed."""
import os
import re
import struct
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(SOURCE, "tests/hil/serve"))
import motor_bus_client as client  # noqa: E402
from bench import DEADLINE_S, main  # noqa: E402

can = client.can
NODE_3_ENCODER = 3 << 5 | client.ENCODER
VELOCITY_CONTROL, PASS_THROUGH = 2, 1


def python_can_drives_an_odrive():
    with client.served("odrive", "can:vcan0", "--bus-watchdog", "200") as bench:
        client.drive_an_odrive(can.interface.Bus("vcan0", interface="socketcan"), bench)


# Position mode, position as it is, velocity 3 Hz; asks for mode and velocity; filled to a length that CAN FD has.
MOTEUS_VELOCITY = bytes.fromhex("01000a" "0e200000c07f00004040" "1100" "1d02").ljust(20, b"\x50")


def python_can_drives_a_moteus_by_can_fd():
    with client.served("moteus", "can:vcan0") as bench:
        bus = can.interface.Bus("vcan0", interface="socketcan", fd=True)
        settled = 0
        end_s = time.monotonic() + DEADLINE_S
        while settled < 20 and time.monotonic() < end_s:
            for device in range(1, 5):
                bus.send(can.Message(arbitration_id=0x8000 | device, data=MOTEUS_VELOCITY, is_extended_id=True, is_fd=True,
                                     bitrate_switch=True))
                answer = bus.recv(timeout=DEADLINE_S)
                assert answer is not None and answer.arbitration_id == device << 8 and answer.is_fd, answer
                assert bytes(answer.data[:2]) == bytes([0x21, 0x00]), answer
            if answer.data[2] == 11:  # late, on a busy computer: it has timed out and wants to be stopped
                for device in range(1, 5):
                    bus.send(can.Message(arbitration_id=device, data=bytes.fromhex("010000"), is_fd=True))
            speed = struct.unpack("<f", bytes(answer.data[5:9]))[0]
            settled = settled + 1 if abs(speed - 3.0) < 0.06 else 0
        assert settled == 20, "3 Hz was not reached"
        bus.shutdown()
        report = bench.stop()
    assert report.code == 0 and ", 0 refused" in report.text, report.text


def a_board_with_the_shim_drives_the_plant():
    program = os.environ["OMNIHIL_PROGRAM"]
    build = os.path.dirname(os.path.dirname(program))
    board = subprocess.Popen([os.path.join(build, "tests/hil/firmware/board/emulated_board"), "--can", "vcan0"])
    run = subprocess.run([program, "scenario", "run", os.path.join(SOURCE, "examples/scenarios/wheel/speed_step.toml"),
                          "--firmware", "can:vcan0"], capture_output=True, text=True, check=False)
    board.kill()
    board.wait()
    assert run.returncode == 0 and "emulated board" in run.stdout, run.stdout + run.stderr


class Candump:
    """What candump prints, as (interface, id, data): (1691500000.000000) vcan0 009#000000000000A040, FD ids with ##."""
    LINE = re.compile(r"\(\d+\.\d+\) (\S+) ([0-9A-F]+)(##?)([0-9A-F]*)")

    def __init__(self, interface):
        self.process = subprocess.Popen(["candump", "-L", interface], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()

    def frames(self):
        end_s = time.monotonic() + DEADLINE_S
        for line in self.process.stdout:
            found = self.LINE.match(line)
            assert found, line
            fd = found[3] == "##"
            yield int(found[2], 16), bytes.fromhex(found[4][1:] if fd else found[4]), fd  # FD: its flags stand first
            assert time.monotonic() < end_s, "what was waited for did not come"

    def wait_for(self, wanted_id, accept):
        return next(data for frame_id, data, _ in self.frames() if frame_id == wanted_id and accept(data))


def cansend(interface, frame):
    run = subprocess.run(["cansend", interface, frame], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr


def listening(dump):
    """candump has bound its socket: /proc/net/can/rcvlist_all names the interface then."""
    def bound():
        with open("/proc/net/can/rcvlist_all", encoding="utf-8") as lists:
            return re.search(r"^ +vcan0 ", lists.read(), re.M) and dump.process.poll() is None
    wait_until(bound)


def speed_of(data):
    return struct.unpack("<ff", data)[1]


def odrive_by_can_utils(interface):
    """Node 3 to 4 turns/s and to idle again, each frame typed."""
    def command(code, data):
        cansend(interface, f"{3 << 5 | code:03X}#{data.hex()}")
    with Candump(interface) as dump:
        dump.wait_for(3 << 5 | client.HEARTBEAT, lambda data: client.state_of(data) == client.IDLE)
        command(client.SET_MODE, struct.pack("<II", VELOCITY_CONTROL, PASS_THROUGH))
        command(client.SET_VEL, struct.pack("<ff", 4.0, 0.0))
        command(client.SET_STATE, struct.pack("<I", client.CLOSED_LOOP))
        command(client.SET_VEL, struct.pack("<ff", 4.0, 0.0))
        dump.wait_for(3 << 5 | client.HEARTBEAT, lambda data: client.state_of(data) == client.CLOSED_LOOP)
        dump.wait_for(NODE_3_ENCODER, lambda data: abs(speed_of(data) - 4.0) < 0.08)
        cansend(interface, f"{3 << 5 | 0x17:03X}#R8")  # asked: bus voltage, between 10 V and 30 V
        dump.wait_for(3 << 5 | 0x17, lambda data: len(data) == 8 and 10.0 < struct.unpack("<ff", data)[0] < 30.0)
        command(client.SET_STATE, struct.pack("<I", client.IDLE))
        dump.wait_for(NODE_3_ENCODER, lambda data: abs(speed_of(data)) < 0.1)


def cansend_and_candump_drive_an_odrive():
    with client.served("odrive", "can:vcan0") as bench:
        odrive_by_can_utils("vcan0")
        report = bench.stop()
    assert report.code == 0 and "6 frames taken, 0 for others, 0 refused" in report.text, report.text


def cansend_and_candump_ask_a_moteus_by_can_fd():
    with client.served("moteus", "can:vcan0") as bench, Candump("vcan0") as dump:
        listening(dump)
        cansend("vcan0", "00008002##1" + "1100")  # device 2: one int8 register from 0 on, the mode; with bit rate switch
        data, fd = next((data, fd) for frame_id, data, fd in dump.frames() if frame_id == 2 << 8)
        assert fd and data[:3] == bytes([0x21, 0x00, 0x00]), data  # it is stopped
        report = bench.stop()
    assert report.code == 0 and ", 0 refused" in report.text, report.text


def slcand_makes_an_interface_of_the_stick():
    """The kernel's own line discipline at our pty: what a USB-CAN stick is to Linux."""
    with client.served("odrive", "slcan:{folder}/can") as bench:
        daemon = subprocess.Popen(["slcand", "-F", "-o", "-s", "8", os.path.realpath(bench.path("can")), "stick0"])
        try:
            wait_until(lambda: os.path.exists("/sys/class/net/stick0"))
            subprocess.run(["ip", "link", "set", "stick0", "up"], check=True)
            odrive_by_can_utils("stick0")
        finally:
            daemon.terminate()
            daemon.wait()
        report = bench.stop()
    assert report.code == 0, report.text


def wait_until(holds):
    end_s = time.monotonic() + DEADLINE_S
    while not holds():
        assert time.monotonic() < end_s, "it did not come to be"
        time.sleep(0.01)


def a_flood_by_cangen_is_counted_and_survived():
    with client.served("odrive", "can:vcan0") as bench:
        subprocess.run(["cangen", "vcan0", "-g", "0", "-p", "10", "-n", "5000", "-I", "i", "-e"], check=True)  # extended ids
        odrive_by_can_utils("vcan0")
        report = bench.stop()
    # A socket that is full loses frames before we see them (a slow computer), so not all 5000 are there to be counted.
    found = re.search(r"6 frames taken, 0 for others, (\d+) refused \(wrong kind of frame (\d+)\)", report.text)
    assert report.code == 0 and found and found[1] == found[2] and 0 < int(found[1]) <= 5000, report.text


def an_interface_that_goes_down_is_named_and_the_wheels_coast():
    with client.served("odrive", "can:vcan0") as bench:
        subprocess.run(["ip", "link", "set", "vcan0", "down"], check=True)
        bench.wait_for("can:vcan0: Network is down")
        report = bench.stop()
    assert report.code == 6, (report.code, report.text)


def the_doctor_sees_the_interface():
    run = subprocess.run([os.environ["OMNIHIL_PROGRAM"], "doctor"], capture_output=True, text=True, check=False)
    assert re.search(r"can.*\bvcan0\b", run.stdout, re.IGNORECASE), run.stdout + run.stderr


TESTS = {name: function for name, function in list(globals().items())
         if callable(function) and getattr(function, "__module__", "") == "__main__"}

if __name__ == "__main__":
    ended = main(TESTS)
    print(f"passed: {sys.argv[1]}" if ended == 0 else f"ended with {ended}")
    sys.exit(ended)
