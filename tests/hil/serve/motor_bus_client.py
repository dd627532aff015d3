"""Main boards' own clients at the motor controllers of `omnihil serve --motor-bus`: python-can (slcan), and the
serial lines of UART buses. Run by script_test.cc."""
import glob
import os
import pty
import select
import shutil
import subprocess
import struct
import sys
import tempfile
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


def odrive_on_vcan0():
    """Within the other kernel: see under_a_kernel_with_can()."""
    with served("odrive", "can:vcan0", "--bus-watchdog", "200") as bench:
        drive_an_odrive(can.interface.Bus("vcan0", interface="socketcan"), bench)


def moteus_on_vcan0():
    """Likewise, CAN FD: position mode, position as it is, velocity 3 Hz; asks for mode and velocity."""
    with served("moteus", "can:vcan0") as bench:
        bus = can.interface.Bus("vcan0", interface="socketcan", fd=True)
        command = bytes.fromhex("01000a" "0e200000c07f00004040" "1100" "1d02")
        command += b"\x50" * (20 - len(command))
        settled = 0
        end_s = time.monotonic() + DEADLINE_S
        while settled < 20 and time.monotonic() < end_s:
            for device in range(1, 5):
                bus.send(can.Message(arbitration_id=0x8000 | device, data=command, is_extended_id=True, is_fd=True,
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


def board_on_vcan0():
    """Likewise: a board with the shim on CAN drives the plant through a scenario."""
    program = os.environ["OMNIHIL_PROGRAM"]
    build = os.path.dirname(os.path.dirname(program))
    source = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../.."))
    board = subprocess.Popen([os.path.join(build, "tests/hil/firmware/board/emulated_board"), "--can", "vcan0"])
    run = subprocess.run([program, "scenario", "run", os.path.join(source, "examples/scenarios/wheel/speed_step.toml"),
                          "--firmware", "can:vcan0"], capture_output=True, text=True, check=False)
    board.kill()
    board.wait()
    assert run.returncode == 0 and "emulated board" in run.stdout, run.stdout + run.stderr


INIT = """#!/bin/sh
mount -t proc proc /proc; mount -t sysfs sys /sys; mount -t tmpfs dev /dev || exit 1
mknod /dev/null c 1 3; mknod /dev/zero c 1 5; mknod /dev/urandom c 1 9
mkdir -p /dev/pts /dev/shm; mount -t devpts -o ptmxmode=666 devpts /dev/pts; mount -t tmpfs tmpfs /dev/shm
ln -s pts/ptmx /dev/ptmx
modules=/usr/lib/uml/modules/$(uname -r)/kernel
insmod $modules/net/can/can.ko; insmod $modules/net/can/can-raw.ko; insmod $modules/drivers/net/can/dev/can-dev.ko
insmod $modules/drivers/net/can/vcan.ko
ip link add dev vcan0 type vcan; ip link set vcan0 mtu 72 up; ip link set lo up
for name in {names}; do
  env OMNIHIL_PROGRAM='{program}' PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 '{script}' $name > '{folder}/'$name.out 2>&1
  echo $? > '{folder}/'$name.code
done
echo 1 > /proc/sys/kernel/sysrq; echo o > /proc/sysrq-trigger; sleep 60
"""


def under_a_kernel_with_can(*names):
    """SocketCAN where this kernel has none: the tests named run in a user-mode Linux on this file system."""
    modules = glob.glob("/usr/lib/uml/modules/*/kernel/drivers/net/can/vcan.ko")
    if can is None or not shutil.which("linux.uml") or not modules:
        raise Skip("python3-can, user-mode-linux or its vcan module is not installed")
    if os.geteuid() != 0:
        raise Skip("the file system of the user-mode kernel wants root")
    folder = tempfile.mkdtemp(prefix="omnihil-uml-")
    try:
        init = os.path.join(folder, "init")
        with open(init, "w", encoding="utf-8") as out:
            out.write(INIT.format(names=" ".join(names), program=os.environ["OMNIHIL_PROGRAM"],
                                  script=os.path.abspath(__file__), folder=folder))
        os.chmod(init, 0o755)
        kernel = subprocess.run(["linux.uml", "mem=512M", "root=/dev/root", "rootfstype=hostfs", "rootflags=/", "rw",
                                 f"init={init}", "con=null", "con0=fd:0,fd:1", "quiet", f"uml_dir={folder}"],
                                stdin=subprocess.DEVNULL, capture_output=True, timeout=4 * DEADLINE_S, check=False)
        begun = any(os.path.exists(os.path.join(folder, name + ".out")) for name in names)
        if not begun and b"ptrace set fp regs failed" in kernel.stdout:
            raise Skip("this host's ptrace refuses the registers of user-mode Linux: it panics before its first program")
        for name in names:
            assert os.path.exists(os.path.join(folder, name + ".code")), kernel.stdout.decode(errors="replace")
            with open(os.path.join(folder, name + ".code"), encoding="utf-8") as code, \
                    open(os.path.join(folder, name + ".out"), encoding="utf-8") as out:
                assert code.read().strip() == "0", out.read()
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def odrive_moteus_and_a_board_run_over_socketcan():
    under_a_kernel_with_can("odrive_on_vcan0", "moteus_on_vcan0", "board_on_vcan0")


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
