"""Hosts of every temper at the virtual dongle, speaking ulaval-hermes through python3-serial and socat."""
import os
import random
import signal
import struct
import subprocess
import sys
import termios
import time

import serial

import bench as rig
import hermes
import rem_client
from bench import Bench, DEADLINE_S

ONE = ["--robots", "0", "--radio", "ulaval-hermes"]


def open_port(path, **more):
    return serial.Serial(path, 115200, timeout=DEADLINE_S, write_timeout=DEADLINE_S, **more)


def drives_a_robot_through_the_serial_port():
    with Bench([*ONE, "--record", "{folder}/run.omnirec"]) as bench, open_port(bench.device) as port:
        hermes.ping(port)
        port.write(hermes.packet(0, hermes.GET_BATTERIE))
        robot, kind, payload = hermes.read_packet(port)
        assert (robot, kind) == (0, hermes.BATTERIE_RESPONSE) and 100 < payload[0] < 255, payload
        # A request with an answer after each command paces this client by the robot's own answers.
        for _ in range(200):
            port.write(hermes.speed_move(0, 0.5, 0.0, 0.0))
            hermes.ping(port)
        report = bench.stop()
        assert report.code == 0, report.text
        assert report.good == 2 + 2 * 200 and report.refused == 0, report.text
        rows = rig.recorded(bench.path("run.omnirec"), ["true_x_m", "true_y_m"])
        start, end = rows[0][2], rows[-1][2]
        assert (start["true_x_m"], start["true_y_m"]) == (0.0, 0.0), start
        assert end["true_x_m"] > 0.02 and abs(end["true_y_m"]) < 0.1 * end["true_x_m"], end


def serves_a_socket_as_it_does_a_serial_port():
    with Bench(ONE, device="tcp:0") as bench:
        for _ in range(2):
            with serial.serial_for_url(bench.device.replace("tcp:", "socket://"), timeout=DEADLINE_S) as port:
                for _ in range(20):
                    hermes.ping(port)
        report = bench.stop()
        assert report.code == 0 and report.good == 2 * 20 and report.refused == 0, report.text


def works_through_a_socat_relay():
    with Bench(ONE) as bench:
        relay = bench.path("relay")
        socat = subprocess.Popen(["socat", "-d", "-d", f"PTY,link={relay},rawer,echo=0",
                                  f"OPEN:{bench.device},rawer,echo=0"], stderr=subprocess.PIPE)
        try:
            said = b""
            while b"starting data transfer loop" not in said:
                line = socat.stderr.readline()
                assert line, f"socat ended: {said.decode()}"
                said += line
            with open_port(relay) as port:
                for _ in range(20):
                    hermes.ping(port)
        finally:
            socat.terminate()
            socat.communicate()
        report = bench.stop()
        assert report.good == 20 and report.refused == 0, report.text


def can_be_closed_and_opened_again():
    with Bench(ONE) as bench:
        for _ in range(20):
            with open_port(bench.device) as port:
                hermes.ping(port)
        report = bench.stop()
        assert report.good == 20 and report.refused == 0, report.text
        assert report.number(r"opened (\d+) times") == 20, report.text


def serves_two_clients_one_after_the_other():
    with Bench(ONE) as bench:
        client = [sys.executable, __file__, "one-ping", bench.device]
        subprocess.run(client, check=True, timeout=DEADLINE_S)
        subprocess.run(client, check=True, timeout=DEADLINE_S)
        report = bench.stop()
        assert report.good == 2, report.text
        assert report.number(r"opened (\d+) times") == 2, report.text


def survives_a_flood_of_a_megabyte():
    # Random bytes hold frames of all lengths; none passes as a packet with more than 2^-8 by its checksum,
    # 2^-8 by its version and 2^-8 by its source, so none is expected in a megabyte of this seed.
    noise = random.Random(20).randbytes(1_000_000)
    with Bench(ONE) as bench:
        with open_port(bench.device) as port:
            hermes.ping(port)
            port.write(noise + b"\0")
            port.reset_input_buffer()
            hermes.ping(port)
        report = bench.stop()
        assert report.code == 0, report.text
        assert report.good == 2, report.text
        assert report.refused > 1000 and sum(report.causes.values()) == report.refused, report.text
        assert report.number(r"(\d+) bytes in") == len(noise) + 1 + 2 * len(hermes.packet(0, 0)), report.text


def goes_on_when_the_client_stops_reading():
    # Six robots answer with 28 + 99 bytes at 60 Hz, 45 kB/s, against 64 kB of queue and about 20 kB in the
    # kernel: both are full after 2 s.
    arguments = ["--robots", "0-5", "--robot", "roboteam_2024", "--radio", "roboteam-rem-v8"]
    with Bench([*arguments, "--physics", "planar", "--duration", "3.5"]) as bench:
        fd = os.open(bench.device, os.O_RDWR | os.O_NOCTTY)
        commands = [rem_client.robot_command(robot, 0, 0.1, 0.0, 0.0) for robot in range(6)]
        keep_writing(bench, fd, b"".join(commands))
        report = bench.finish()
        # A flooding client that is descheduled in the middle of a packet for longer than the dongle waits for the
        # rest loses that packet, so refused ones may occur; none of them is acted on.
        assert report.code == 0 and report.steps == 3500 and report.good > 1000, report.text
        assert report.number(r"host not reading (\d+) answers") > 100, report.text


def keep_writing(bench, fd, data):
    """Writes until the bench has ended and its port with it."""
    try:
        while bench.process.poll() is None:
            os.write(fd, data)
    except OSError:
        pass
    os.close(fd)


def resynchronises_after_half_packets_garbage_and_reopening():
    whole = hermes.speed_move(0, 0.3, 0.0, 0.0)
    with Bench(ONE) as bench:
        for cut in range(1, len(whole)):
            with open_port(bench.device) as port:
                # The answer to the ping says that the half frame behind it has arrived too.
                port.write(hermes.packet(0, hermes.PING_REQUEST) + whole[:cut])
                hermes.read_packet(port)
            with open_port(bench.device) as port:
                hermes.ping(port)  # the half frame does not swallow the next host's first packet
                port.write(b"\xff\xfe\x13garbage\0")
                hermes.ping(port)
        report = bench.stop()
        rounds = len(whole) - 1
        assert report.good == 3 * rounds, report.text
        assert report.refused == 2 * rounds, report.text


def survives_an_unplug_in_the_middle_of_a_frame():
    with Bench(ONE) as bench:
        client = subprocess.Popen([sys.executable, __file__, "half-frame", bench.device],
                                  stdout=subprocess.PIPE)
        assert client.stdout.readline() == b"written\n"
        client.kill()
        client.communicate()
        with open_port(bench.device) as port:
            hermes.ping(port)
        report = bench.stop()
        assert report.code == 0 and report.good == 2 and report.refused == 1, report.text


def line_modes_of_one_client_do_not_reach_the_next():
    with Bench(ONE) as bench:
        fd = os.open(bench.device, os.O_RDWR | os.O_NOCTTY)
        modes = termios.tcgetattr(fd)
        modes[0] |= termios.ICRNL | termios.IXON
        modes[1] |= termios.OPOST | termios.ONLCR
        modes[3] |= termios.ECHO | termios.ICANON | termios.ISIG
        modes[4] = modes[5] = termios.B1200
        termios.tcsetattr(fd, termios.TCSANOW, modes)
        os.close(fd)
        with open_port(bench.device) as port:
            hermes.ping(port)
        # A client that never touches the modes, as `cat` would.
        fd = os.open(bench.device, os.O_RDWR | os.O_NOCTTY)
        os.write(fd, hermes.packet(0, hermes.PING_REQUEST))
        answer = b""
        while not answer.endswith(b"\0"):
            answer += os.read(fd, 1)
        assert hermes.uncobs(answer[:-1])[3] == hermes.PING_RESPONSE, answer
        os.close(fd)
        report = bench.stop()
        assert report.good == 2 and report.refused == 0, report.text


def counts_bad_packets_by_their_cause():
    bad = [(hermes.packet(0, 2, struct.pack("<fff", 1, 0, 0), add_to_sum=1), "checksum", 3),
           (hermes.packet(0, 0, version=2), "version", 2),
           (hermes.packet(0, 0x77), "unknown type", 4),
           (hermes.packet(9, 0), "address", 5),
           (hermes.packet(0, hermes.SPEED_MOVE, struct.pack("<fff", float("nan"), 0, 0)), "not finite", 1)]
    with Bench(ONE) as bench, open_port(bench.device) as port:
        for frame, _, times in bad:
            port.write(frame * times)
        hermes.ping(port)
        report = bench.stop()
        assert report.good == 1, report.text
        assert report.causes == {cause: times for _, cause, times in bad}, report.text


def simulated_time_does_not_stall_while_a_client_floods():
    with Bench([*ONE, "--duration", "0.5"]) as bench:
        fd = os.open(bench.device, os.O_WRONLY | os.O_NOCTTY)
        keep_writing(bench, fd, b"\x55" * 1000)
        report = bench.finish()
        assert report.code == 0 and report.steps == 500, report.text


def paces_bytes_at_the_rate_that_is_asked_for():
    # 24 PING_REQUESTs of 7 bytes at 1200 baud 8N1 need 24 * 7 * 10 / 1200 = 1.4 s of simulated time to come
    # in; a bench that ends after 0.7 s has seen the half of them: 0.7 * 120 / 7 = 12.
    with Bench([*ONE, "--baud", "1200", "--duration", "0.7"]) as bench, open_port(bench.device) as port:
        port.write(hermes.packet(0, hermes.PING_REQUEST) * 24)
        report = bench.finish()
        assert report.code == 0 and 0 < report.good <= 12, report.text


def ends_cleanly_on_every_stop_signal():
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
        with Bench([*ONE, "--record", "{folder}/run.omnirec"]) as bench:
            with open_port(bench.device) as port:
                hermes.ping(port)
            report = bench.stop(number)
            assert report.code == 0, report.text
            assert not os.path.lexists(bench.device), "the device's name is still there"
            assert "lateness" in report.text and "slip" in report.text, report.text
            with open(bench.path("run.omnirec"), encoding="utf-8") as file:
                last = file.read().splitlines()[-1]
            assert last.startswith('# {"end"'), last


def stalled(arguments):
    """A bench that is frozen for 200 ms, ten times the backlog that it would make up for."""
    with Bench([*ONE, *arguments]) as bench:
        with open_port(bench.device) as port:
            hermes.ping(port)
            bench.process.send_signal(signal.SIGSTOP)
            time.sleep(0.2)  # the stall itself
            bench.process.send_signal(signal.SIGCONT)
            if "--strict" in arguments:
                return bench.finish()
            hermes.ping(port)
            return bench.stop()


def a_computer_that_cannot_keep_up_is_said():
    report = stalled([])
    assert report.code == 0, report.text
    assert report.number(r"OVERLOADED .* simulated time slipped ([0-9.]+) ms") >= 150, report.text
    report = stalled(["--strict"])
    assert report.code == 5 and "could not keep up" in report.text, report.text


def the_status_line_fits_the_terminal():
    with Bench(ONE, columns=60) as bench:
        bench.wait_for("\r", times=4)  # written over itself
        with open_port(bench.device) as port:
            hermes.ping(port)
            bench.wait_for("host here")
        report = bench.stop(signal.SIGINT)
        lines = next(part for part in report.text.split("\r\n") if "\r" in part).split("\r")
        assert all(len(line.replace("\033[K", "")) < 60 for line in lines), lines
        assert len(lines) > 3 and "lateness" in report.text, report.text


def refuses_a_name_that_a_file_has():
    with Bench(ONE) as other:
        precious = other.path("precious")
        with open(precious, "w", encoding="utf-8") as file:
            file.write("keep me")
        done = subprocess.run([other.program, "serve", "--device", precious, *ONE], capture_output=True,
                              text=True, timeout=DEADLINE_S, check=False)
        assert done.returncode == 3, done
        assert precious in done.stderr and "in the way" in done.stderr, done.stderr
        with open(precious, encoding="utf-8") as file:
            assert file.read() == "keep me"
        # and a device that another bench serves
        done = subprocess.run([other.program, "serve", "--device", other.device, *ONE], capture_output=True,
                              text=True, timeout=DEADLINE_S, check=False)
        assert done.returncode == 3 and "exists" in done.stderr, done
        with open_port(other.device) as port:
            hermes.ping(port)


def names_every_bad_argument():
    with Bench(ONE) as other:
        done = subprocess.run([other.program, "serve", "--robots", "0-3,x,2", "--radio", "ulaval-herms"],
                              capture_output=True, text=True, timeout=DEADLINE_S, check=False, cwd=other.folder)
        assert done.returncode == 2, done
        for words in ('"x"', "id 2 stands twice", "did you mean ulaval-hermes?", "roboteam-rem-v8"):
            assert words in done.stderr, (words, done.stderr)
        for option, wire, words in (("--device", "ptty:./x", "did you mean pty?"),
                                    ("--device", "can:can0", "carries frames; needed: pty:"),
                                    ("--firmware", "serail:/dev/ttyACM0", "did you mean serial?")):
            done = subprocess.run([other.program, "serve", option, wire], capture_output=True, text=True,
                                  timeout=DEADLINE_S, check=False, cwd=other.folder)
            assert done.returncode == 2 and words in done.stderr, (wire, done)
        done = subprocess.run([other.program, "serve", "--robot", "omni_defalt"], capture_output=True, text=True,
                              timeout=DEADLINE_S, check=False, cwd=other.folder)
        assert done.returncode == 2 and "omni_default" in done.stderr, done


def helper_one_ping():
    with open_port(sys.argv[2]) as port:
        hermes.ping(port)


def helper_half_frame():
    with open_port(sys.argv[2]) as port:
        port.write(hermes.packet(0, hermes.PING_REQUEST) + hermes.speed_move(0, 1.0, 0.0, 0.0)[:9])
        hermes.read_packet(port)  # so the half frame behind the ping is in the bench, too
        print("written", flush=True)
        signal.pause()


TESTS = {name: function for name, function in list(globals().items())
         if callable(function) and getattr(function, "__module__", "") == "__main__"}
TESTS["one-ping"] = helper_one_ping
TESTS["half-frame"] = helper_half_frame

if __name__ == "__main__":
    sys.exit(rig.main(TESTS))
