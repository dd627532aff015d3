"""Programs that other people wrote, at a running `omnihil serve`: each function is a test, each drives one of them.

    clients.py NAME     environment: OMNIHIL_PROGRAM, OMNIHIL_CLIENTS_BUILD (our programs that use their libraries),
                        OMNIHIL_CLIENTS_NPM, OMNIHIL_PRELOAD
"""
import json
import math
import os
import pty
import re
import select
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import tty

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, os.path.join(SOURCE, "tests/hil/serve"))
import hermes  # noqa: E402
from bench import Bench, DEADLINE_S, Skip, main  # noqa: E402

ONE = ["--robots", "0", "--radio", "ulaval-hermes"]
PING = hermes.packet(0, hermes.PING_REQUEST)
TIMES = 20


def installed(program):
    found = shutil.which(program)
    if not found:
        raise Skip(f"{program} is not installed (./dev test installs it)")
    return found


def built(name):
    path = os.path.join(os.environ["OMNIHIL_CLIENTS_BUILD"], name)
    if not os.path.exists(path):
        raise Skip(f"{name} was not built: its library is not installed (./dev test installs it)")
    return path


def is_answer(frame):
    data = hermes.uncobs(frame[:-1])
    return frame[-1:] == b"\0" and data[1] == 0 and data[3] == hermes.PING_RESPONSE and data[4] == (sum(data) - data[4]) % 256


def asks(command, **environment):
    """The client asks TIMES for a sign of life; each answer is one, and the bench counts no damaged byte."""
    with Bench(ONE) as bench:
        words = [*command, os.path.realpath(bench.device), PING.hex(), str(TIMES)]
        run = subprocess.run(words, capture_output=True, text=True, check=False, timeout=DEADLINE_S,
                             env={**os.environ, **environment})
        if run.returncode == 77:
            raise Skip(run.stdout.strip())
        assert run.returncode == 0, (run.stdout, run.stderr)
        answers = [bytes.fromhex(line) for line in run.stdout.split()]
        assert len(answers) == TIMES and all(map(is_answer, answers)), run.stdout
        report = bench.stop()
    assert report.code == 0 and report.good == TIMES and report.refused == 0, report.text


def qt_serial_port():
    asks([built("qt_client")])


def node_serialport():
    asks([installed("node"), os.path.join(HERE, "serialport.mjs")])


def libserialport():
    asks([built("libserialport_client")], LD_PRELOAD=os.environ["OMNIHIL_PRELOAD"])


def shell_with_stty():
    """What a person types: stty, printf, head."""
    script = """stty -F "$1" 115200 raw -echo && exec 3<> "$1" || exit 1
    for n in $(seq "$3"); do printf "$(echo "$2" | sed 's/../\\\\x&/g')" >&3; head -c SIZE <&3 | od -An -v -tx1 | tr -d ' \\n'; echo; done"""
    size = len(hermes.packet(0, hermes.PING_RESPONSE))
    asks([installed("bash"), "-c", script.replace("SIZE", str(size)), "bash"])


def terminal_program(command):
    """A terminal program between us and the bench: what we type goes to the robot, what it answers is on the screen."""
    with Bench(ONE) as bench:
        keyboard, screen = pty.openpty()
        tty.setraw(screen)
        # a session of its own: picocom ends its process group with itself
        program = subprocess.Popen([*command, os.path.realpath(bench.device)], stdin=screen, stdout=screen, stderr=screen,
                                   start_new_session=True, env={**os.environ, "TERM": "dumb", "HOME": bench.folder})
        os.close(screen)
        try:
            seen, answers, asked_s = b"", 0, 0.0
            end_s = time.monotonic() + DEADLINE_S
            while answers < TIMES:
                now_s = time.monotonic()
                assert now_s < end_s and program.poll() is None, (answers, seen)
                if now_s - asked_s > 1.0:  # what is typed before it listens is lost
                    os.write(keyboard, PING)
                    asked_s = now_s
                if not select.select([keyboard], [], [], 0.2)[0]:
                    continue
                seen += os.read(keyboard, 4096)
                while b"\0" in seen:
                    frame, seen = seen.split(b"\0", 1)
                    words = frame[-len(hermes.packet(0, hermes.PING_RESPONSE)) + 1:]  # behind what it prints at its start
                    assert is_answer(words + b"\0"), frame
                    answers, asked_s = answers + 1, 0.0
        finally:
            program.terminate()
            program.wait()
            os.close(keyboard)
        report = bench.stop()
    assert report.code == 0 and report.good >= TIMES and report.refused == 0, report.text


def encoded(format_id, packet, *rows):
    lines = "".join(json.dumps(row) + "\n" for row in rows)
    return subprocess.run([os.environ["OMNIHIL_PROGRAM"], "encode", format_id, packet], input=lines, capture_output=True,
                          text=True, check=True).stdout.replace("\n", "")


def usb_host(words, devices):
    """Runs the client with the preload, and without it: (its exit code without, its transfers with)."""
    command = [built("libusb_client"), *words]
    alone = subprocess.run(command, capture_output=True, text=True, timeout=DEADLINE_S)
    run = subprocess.run(command, capture_output=True, text=True, timeout=DEADLINE_S,
                         env=dict(os.environ, LD_PRELOAD=os.environ["OMNIHIL_USB_PRELOAD"], OMNIHIL_USB=devices))
    assert run.returncode == 0, (run.returncode, run.stdout, run.stderr)
    return alone.returncode, [bytes.fromhex(line) for line in run.stdout.split()]


def libusb_host_of_the_usb_transceiver():
    """ER-Force's host side: records out and back in bulk transfers; INIT, PING and a command to robot 3."""
    time_sent = bytes(range(8))
    with Bench(["--radio", "erforce-usb-pasta-2014", "--robots", "3", "--physics", "planar"]) as bench:
        request = "00020500" + "0108" + time_sent.hex() + encoded(
            "erforce-usb-pasta-2014", "gen2014_command",
            {"address_id": 3, "id": 3, "expected_response_size": 11, "counter": 77, "v_f": 0.5})
        for way in ("sync", "async"):
            alone, transfers = usb_host([way, "03eb", "6127", "0", "02", "81", request, "30"], f"03eb:6127={bench.device}")
            assert alone == 3, "without the preload there is no such device"
            records, kinds = b"".join(transfers), []
            while len(records) >= 2:
                record, records = records[2:2 + records[0]], records[2 + records[0]:] if len(records) >= 2 + records[0] else b""
                kinds.append(record)
            assert bytes.fromhex("0500") in kinds and time_sent in kinds, kinds
            answers = [record for record in kinds if len(record) == 11]
            assert len(answers) >= 5 and all(record[:2] == bytes([2, 77]) and record[2] & 15 == 3 for record in answers), kinds
        report = bench.stop()
    assert report.code == 0 and report.refused == 0 and report.good >= 30, report.text


def libusb_transfers_are_packets_where_the_dongle_sends_packets():
    """RoboTeam's host takes a transfer for one packet: four robots' feedback and state, each in a transfer of its own."""
    with Bench(["--radio", "roboteam-rem-v8", "--robots", "0-3", "--team", "blue", "--physics", "planar"]) as bench:
        request = encoded("roboteam-rem-v8", "REM_RobotCommand",
                          *({"toRobotId": robot, "toColor": 1, "fromPC": 1, "sendStateInfo": 1} for robot in range(4)))
        for way in ("sync", "async"):
            alone, transfers = usb_host([way, "0483", "5740", "1", "01", "81", request, "40"],
                                        f"0483:5740={bench.device},length_at=10")
            assert alone == 3
            assert len(transfers) == 40 and all(len(packet) == packet[10] for packet in transfers), transfers
            assert {packet[0] for packet in transfers} >= {0x27, 0x28}, "RobotFeedback and RobotStateInfo"
            assert {packet[2] >> 4 for packet in transfers if packet[0] == 0x27} == {0, 1, 2, 3}
        report = bench.stop()
    assert report.code == 0 and report.refused == 0, report.text


def usb_devices_that_are_not_understood_are_said():
    run = subprocess.run([built("libusb_client"), "sync", "03eb", "6127", "0", "02", "81", "00", "1"], capture_output=True, text=True,
                         timeout=DEADLINE_S, env=dict(os.environ, LD_PRELOAD=os.environ["OMNIHIL_USB_PRELOAD"],
                                                      OMNIHIL_USB="03eb=./x;03eb:6127=/nowhere/dongle"))
    assert run.returncode == 3 and "03eb=./x" in run.stderr and "/nowhere" not in run.stderr, run


def picocom():
    terminal_program([installed("picocom"), "--quiet", "--no-escape", "--noreset", "--baud", "115200"])


def tio():
    terminal_program([installed("tio"), "--no-autoconnect", "--baudrate", "115200"])


def node_with_a_dbc_file():
    with Bench(["--motor-bus", "odrive", "--bus-port", "slcan:{folder}/can", "--robots", "0", "--physics", "planar"]) as bench:
        run = subprocess.run([installed("node"), os.path.join(HERE, "dbc.mjs"), os.path.realpath(bench.path("can")),
                              os.path.join(SOURCE, "examples/can/odrive.dbc")], capture_output=True, text=True, check=False,
                             timeout=DEADLINE_S)
        if run.returncode == 77:
            raise Skip(run.stdout.strip())
        assert run.returncode == 0, (run.stdout, run.stderr)
        seen = json.loads(run.stdout)
        report = bench.stop()
    assert abs(seen["speed_rev_s"] - 4.0) <= 0.08 and seen["states"][-1] == "CLOSED_LOOP_CONTROL", seen
    assert seen["unknown"] == 0 and seen["frames"] > 20, seen
    assert report.code == 0 and ", 0 for others, 0 refused" in report.text, report.text


def dbc_files_say_what_the_tables_say():
    """candied reads what `formats ID --dbc` writes: packets of another encoder have the values there that they were made of."""
    with open(os.path.join(SOURCE, "tests/protocols/golden/packets.jsonl"), encoding="utf-8") as file:
        golden = [json.loads(line) for line in file]
    for format_id, device in (("odrive-can", "ODrive"), ("ibis-orion-can", "ibis_ssl")):
        rows = [row for row in golden if row["format"] == format_id and row["in"].get("node", 0) < 4]
        frames = [bytes.fromhex(row["hex"]) for row in rows]
        lines = "".join(json.dumps({"id": int.from_bytes(frame[:4], "little"), "data": list(frame[8:8 + frame[4]])}) + "\n"
                        for frame in frames)
        with tempfile.NamedTemporaryFile(suffix=".dbc") as dbc:
            subprocess.run([os.environ["OMNIHIL_PROGRAM"], "formats", format_id, "--dbc"], stdout=dbc, check=True)
            run = subprocess.run([installed("node"), os.path.join(HERE, "dbc_values.mjs"), dbc.name], input=lines,
                                 capture_output=True, text=True, check=False, timeout=DEADLINE_S)
        if run.returncode == 77:
            raise Skip(run.stdout.strip())
        assert run.returncode == 0, (run.stdout, run.stderr)
        read = [json.loads(line) for line in run.stdout.splitlines()]
        assert len(read) == len(rows) >= 12, run.stdout
        for row, seen in zip(rows, read):
            given = dict(row["in"])
            number = given.pop("node", given.pop("motor", ""))
            assert seen["name"] == f"{device}{number}_{row['packet']}", (row, seen)
            assert set(seen["values"]) == set(given), (row, seen)
            for name, value in given.items():
                assert math.isclose(seen["values"][name], value, rel_tol=1e-6, abs_tol=1e-9), (row, seen)


def every_message_of_the_dbc_file_is_the_bus_s():
    """pyserial at the USB-CAN stick: what the file says the main board sends is known, at its length; what it says the
    controllers send comes when asked for, at its length."""
    import serial
    with open(os.path.join(SOURCE, "examples/can/odrive.dbc"), encoding="utf-8") as file:
        rows = re.findall(r"^BO_ (\d+) (\w+): (\d) (\w+)$", file.read(), re.M)
    ours = [(int(frame_id), int(size)) for frame_id, _, size, sender in rows if sender == "ODrive"]
    theirs = [(int(frame_id), int(size)) for frame_id, _, size, sender in rows if sender == "MainBoard"]
    assert len(ours) == 4 * 8 and len(theirs) == 4 * 12, rows
    with Bench(["--motor-bus", "odrive", "--bus-port", "slcan:{folder}/can", "--robots", "0", "--physics", "planar"]) as bench:
        with serial.Serial(bench.path("can"), 115200, timeout=DEADLINE_S) as stick:
            stick.write(b"O\r")
            for frame_id, size in theirs:
                stick.write(f"t{frame_id:03X}{size}{bytes(size).hex()}\r".encode())
            for frame_id, size in ours:
                stick.write(f"r{frame_id:03X}{size}\r".encode())
                end_s = time.monotonic() + DEADLINE_S
                while f"t{frame_id:03X}".encode() not in (line := stick.read_until(b"\r")):
                    assert time.monotonic() < end_s, f"no answer to {frame_id:03X}"
                assert len(line[line.index(b"t"):]) == 1 + 3 + 1 + 2 * size + 1, line
        report = bench.stop()
    # Zeros are no state, mode or limit that it takes, so some are refused; none for being unknown or short.
    assert "unknown command" not in report.text and "wrong length" not in report.text, report.text
    assert "0 for others" in report.text, report.text


def free_udp_ports(count):
    free = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(count)]
    for one in free:
        one.bind(("127.0.0.1", 0))
    ports = [str(one.getsockname()[1]) for one in free]
    for one in free:
        one.close()
    return ports


def node_of_the_league():
    (robot, control, vision), group = free_udp_ports(3), "224.5.23.2"
    with Bench(["--robots", "0,3", "--physics", "planar", "--league", "--league-robot-port", robot, "--league-control-port", control,
                "--vision", f"{group}:{vision}"]) as bench:
        run = subprocess.run([installed("node"), os.path.join(HERE, "league.mjs"), SOURCE, robot, group, vision],
                             capture_output=True, text=True, check=False, timeout=DEADLINE_S)
        if run.returncode == 77:
            raise Skip(run.stdout.strip())
        assert run.returncode == 0, (run.stdout, run.stderr, bench.text)
        seen = json.loads(run.stdout)
        report = bench.stop()
    assert seen["moved_mm"] > 300 and seen["errors"] == 0, seen
    assert seen["feedback"] == [0, 3] and seen["field_mm"] == [9000, 6000], seen
    assert report.code == 0, report.text


TESTS = {name: function for name, function in list(globals().items())
         if callable(function) and getattr(function, "__module__", "") == "__main__"}

if __name__ == "__main__":
    sys.exit(main(TESTS))
