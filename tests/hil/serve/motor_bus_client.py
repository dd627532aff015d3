"""Main boards' own clients at the motor controllers of `omnihil serve --motor-bus`: python-can (slcan), and the
serial lines of UART buses. Run by script_test.cc."""
import os
import pty
import select
import subprocess
import struct
import sys
import time
import tty

from bench import Bench, DEADLINE_S, Skip, main

try:
    import can
except ImportError:
    can = None

IDLE, CLOSED_LOOP = 1, 8
HEARTBEAT, SET_STATE, ENCODER, SET_MODE, SET_VEL, CLEAR = 0x01, 0x07, 0x09, 0x0B, 0x0D, 0x18


def open_slcan(bench):
    if can is None:
        raise Skip("python3-can is not installed")
    return can.interface.Bus(bench.path("can"), interface="slcan", bitrate=250000, ttyBaudrate=115200, sleep_after_open=0)


def served(bus, port, *more):
    return Bench(["--motor-bus", bus, "--bus-port", port, "--robots", "0", "--physics", "planar", *more])


def send(bus, node, command, data=b"", remote=False):
    bus.send(can.Message(arbitration_id=node << 5 | command, data=data, is_extended_id=False, is_remote_frame=remote,
                         dlc=8 if remote else len(data)))


def frames(bus):
    """What comes from the bus, until nothing has come for long."""
    end_s = time.monotonic() + DEADLINE_S
    while time.monotonic() < end_s:
        message = bus.recv(timeout=DEADLINE_S)
        assert message is not None, "the bus fell silent"
        yield message
    raise AssertionError("what was waited for did not come")


def wait_for(bus, node, command, accept):
    for message in frames(bus):
        if message.arbitration_id == node << 5 | command and accept(bytes(message.data)):
            return bytes(message.data)


def state_of(data):
    return data[4]


def drive_an_odrive(bus, bench):
    """What a main board does: arm, set-points after each estimate until they are reached, then silence."""
    turns_s = 4.0
    for node in range(4):
        send(bus, node, SET_MODE, struct.pack("<II", 2, 1))
        send(bus, node, SET_STATE, struct.pack("<I", CLOSED_LOOP))
    wait_for(bus, 3, HEARTBEAT, lambda data: state_of(data) == CLOSED_LOOP)
    settled = 0
    for message in frames(bus):
        if message.arbitration_id == ENCODER:
            for node in range(4):
                send(bus, node, SET_VEL, struct.pack("<ff", turns_s, 0.0))
            speed = struct.unpack("<ff", bytes(message.data))[1]
            settled = settled + 1 if abs(speed - turns_s) < 0.02 * turns_s else 0
        if settled == 30:
            break
    # silence: the watchdog disarms, and the wheel runs down
    wait_for(bus, 0, HEARTBEAT, lambda data: state_of(data) == IDLE and data[:4] == bytes([0, 0, 0, 1]))
    wait_for(bus, 0, ENCODER, lambda data: abs(struct.unpack("<ff", data)[1]) < 0.1)
    # remote request: bus voltage
    send(bus, 2, 0x17, remote=True)
    voltage = struct.unpack("<ff", wait_for(bus, 2, 0x17, lambda data: True))[0]
    assert 10 < voltage < 30, voltage
    # what no ODrive knows is counted and has no effect
    send(bus, 1, 0x1E, bytes(8))
    send(bus, 1, SET_VEL, bytes(3))
    send(bus, 1, SET_VEL, struct.pack("<ff", float("nan"), 0.0))
    send(bus, 9, SET_VEL, bytes(8))
    send(bus, 1, CLEAR)
    wait_for(bus, 1, HEARTBEAT, lambda data: data[:4] == bytes(4))
    bus.shutdown()
    report = bench.stop()
    assert report.code == 0, report.text
    assert "3 refused (unknown command 1, wrong length 1, not a finite number 1)" in report.text, report.text
    assert "1 for others" in report.text, report.text
    assert "motors stopped by time-out 4" in report.text, report.text


def odrive_reaches_the_commanded_speed_and_stops_when_the_watchdog_expires():
    with served("odrive", "slcan:{folder}/can", "--bus-watchdog", "200") as bench:
        drive_an_odrive(open_slcan(bench), bench)


def drive_four_uarts(write, read):
    """A main board that knows the layout alone: 52 bytes out to each motor, 56 back, until all turn at 30 rad/s."""
    command = struct.pack("<B3xI I B3x f 32x", 0x21, 0, 2, 1, 30.0)
    assert len(command) == 52
    settled, speeds = 0, None
    end_s = time.monotonic() + DEADLINE_S
    while settled < 30 and time.monotonic() < end_s:
        for m in range(4):
            write(m, command)
        replies = [read(m, 56) for m in range(4)]
        assert all(len(reply) == 56 and reply[0] == 0x81 for reply in replies), replies
        speeds = [struct.unpack_from("<f", reply, 24)[0] for reply in replies]
        settled = settled + 1 if all(abs(speed - 30.0) < 0.6 for speed in speeds) else 0
    assert settled == 30, speeds


def ateam_main_board_drives_four_uarts():
    import serial
    with served("ateam-uart-2025", "uart:{folder}/motor") as bench:
        ports = [serial.Serial(bench.path(f"motor{m}"), 2000000, timeout=DEADLINE_S) for m in range(4)]
        drive_four_uarts(lambda m, data: ports[m].write(data), lambda m, size: ports[m].read(size))
        for port in ports:
            port.close()
        report = bench.stop()
    assert report.code == 0, report.text


def ateam_main_board_at_four_serial_ports():
    """The bench opens the ports; the main board has the other ends."""
    pairs = [pty.openpty() for _ in range(4)]
    for master, slave in pairs:
        tty.setraw(slave)

    def read(m, size):
        data = b""
        while len(data) < size:
            ready, _, _ = select.select([pairs[m][0]], [], [], DEADLINE_S)
            assert ready, "the motor fell silent"
            data += os.read(pairs[m][0], size - len(data))
        return data

    port = "serial:" + ",".join(os.ttyname(slave) for _, slave in pairs)
    with served("ateam-uart-2025", port) as bench:
        drive_four_uarts(lambda m, data: os.write(pairs[m][0], data), read)
        report = bench.stop()
    assert report.code == 0, report.text


def bad_words_are_all_named():
    run = subprocess.run([os.environ["OMNIHIL_PROGRAM"], "serve", "--motor-bus", "odrve", "--bus-port", "uart:x",
                          "--bus-order", "0,1,1,3", "--robots", "0-1"], capture_output=True, text=True)
    assert run.returncode == 2, run
    for words in ('"odrve" is none, did you mean odrive?', '"0,1,1,3"', "for 2 robots"):
        assert words in run.stderr, run.stderr


if __name__ == "__main__":
    sys.exit(main({name: test for name, test in globals().items() if callable(test)}))
