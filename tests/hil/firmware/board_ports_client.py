"""Clients that are not ours at the ports of emulated boards: pyserial, socket and python-can at `omnihil serve`."""
import os
import socket
import struct
import subprocess
import sys
import tempfile

from board_bench import benches, board_text, on_board

IMAGE = os.path.join(os.environ["OMNIHIL_BUILD"], "images", "ports.elf")


def served(ports, *arguments, typed=None):
    """A bench whose robots' boards have these ports; {folder} stands for the bench's own folder."""
    if not os.path.exists(IMAGE):
        raise benches.Skip("no arm-none-eabi-gcc: the image was not built")
    if "semihosting" not in ports:  # the image says something by it; without a console that is a fault
        ports += '\n[[port]]\nof = "semihosting"\nconsole = true\n'
    return on_board(IMAGE, board_text("four_wheels_f405.toml") + ports, *arguments, typed=typed)


class Line:
    """A socket as the serial port that it stands for."""

    def __init__(self, line):
        self.line, self.write = line, line.sendall

    def read(self, most):
        self.line.settimeout(self.timeout)
        try:
            return self.line.recv(most)
        except TimeoutError:
            return b""


def wake_serial(port):
    """The bench is there before the board has booted: asks until it answers."""
    port.timeout = 0.2
    for _ in range(int(benches.DEADLINE_S / port.timeout)):
        port.write(b"?")
        if b"?" in port.read(64):
            break
    while port.read(64):
        pass
    port.timeout = benches.DEADLINE_S


def wake_can(bus):
    for _ in range(int(benches.DEADLINE_S / 0.2)):
        bus.send(can_message(0x7F0, b""))
        if bus.recv(0.2) is not None:
            return


def can_message(number, data):
    import can
    return can.Message(arbitration_id=number, data=data, is_extended_id=False)


def answer_of(bus):
    """The next frame that does not answer wake_can()."""
    for _ in range(1000):
        answer = bus.recv(benches.DEADLINE_S)
        if answer is None or answer.arbitration_id != 0x7F1:
            return answer
    return None


def a_serial_port_is_a_terminal_both_ways():
    import serial
    with served('\n[[port]]\nof = "USART2"\nas = "pty:{folder}/console{id}"\n', "--robots", "0-1") as bench:
        for robot in (0, 1):
            with serial.Serial(bench.path(f"console{robot}"), 115200, timeout=benches.DEADLINE_S) as port:
                wake_serial(port)
                port.write(b"hello, board")
                answer = b""
                while not answer.endswith(b"HELLO, BOARD"):
                    more = port.read(1)
                    assert more, answer
                    answer += more
        report = bench.stop()
    assert report.code == 0 and "USART2 at pty:" in report.text, report.text


def a_socket_carries_a_flood_at_the_line_rate():
    """More bytes than the line carries at once wait in the socket; none is lost."""
    sent = bytes(range(97, 123)) * 400
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with served(f'\n[[port]]\nof = "USART2"\nas = "tcp:127.0.0.1:{port}"\n', "--robots", "0", "--clock", "free",
                "--duration", "1000") as bench:
        with socket.create_connection(("127.0.0.1", port), timeout=benches.DEADLINE_S) as plain:
            line = Line(plain)
            wake_serial(line)
            line.write(sent)
            answer = b""
            while len(answer) < len(sent):
                more = line.read(4096)
                assert more, len(answer)
                answer += more
        bench.stop()
    assert answer == sent.upper()


def can_frames_come_and_go():
    import can
    with served('\n[[port]]\nof = "CAN1"\nas = "slcan:{folder}/can"\n', "--robots", "0") as bench:
        with can.interface.Bus(bench.path("can"), interface="slcan", bitrate=1000000, ttyBaudrate=115200,
                               sleep_after_open=0) as bus:
            wake_can(bus)
            for n in range(20):
                bus.send(can_message(0x200 + n, bytes(range(n % 9))))
            for n in range(20):
                answer = answer_of(bus)
                assert answer is not None and answer.arbitration_id == 0x201 + n, (n, answer)
                assert bytes(answer.data) == bytes(b + 1 for b in range(n % 9)), (n, answer)
        report = bench.stop()
    assert "CAN1 at slcan:" in report.text and "nobody took" not in report.text, report.text


def a_motor_turns_as_its_can_is_told():
    import can
    with served('\n[[port]]\nof = "CAN1"\nas = "slcan:{folder}/can"\n', "--robots", "0") as bench:
        with can.interface.Bus(bench.path("can"), interface="slcan", bitrate=1000000, ttyBaudrate=115200,
                               sleep_after_open=0) as bus:
            def count(duty):
                bus.send(can_message(0x100, struct.pack("<h", duty)))
                answer = answer_of(bus)
                assert answer is not None and answer.arbitration_id == 0x101, answer
                return struct.unpack("<i", bytes(answer.data))[0]

            wake_can(bus)
            assert count(0) == 0
            first, turned = count(2000), 0
            while turned < 4096:  # a turn of the rotor; ends by recv's deadline if it stands
                turned = abs(count(2000) - first)
        bench.stop()


def what_it_says_is_in_the_report_and_on_the_terminal():
    ports = ''.join(f'\n[[port]]\nof = "{of}"\nconsole = true\n' for of in ("USART2", "semihosting", "ITM", "RTT"))
    with served(ports, "--robots", "2", "--console", "2", "--clock", "free", "--duration", "0.1") as bench:
        report = bench.finish()
    assert report.code == 0, report.text
    for of, line in (("USART2", "boot"), ("semihosting", "by semihosting"), ("ITM", "by trace"),
                     ("RTT", "by rtt, and it is longer than the buffer")):
        assert f"robot 2 {of} | {line}" in report.text, report.text
        assert f"{of} said 1 lines:" in report.text, report.text


def what_is_typed_is_heard_by_the_robots_named():
    ports = '\n[[port]]\nof = "RTT"\nconsole = true\n'
    with served(ports, "--robots", "1-2", "--console", "2", "--clock", "free", "--duration", "0.3",
                typed=b"typed by hand\n") as bench:
        report = bench.finish()
    assert report.code == 0, report.text
    assert "robot 2 RTT | TYPED BY HAND" in report.text, report.text
    assert report.text.count("TYPED BY HAND") == 2, report.text  # as it is said, and in the report


def what_it_says_is_in_the_recording():
    ports = '\n[[port]]\nof = "USART2"\nconsole = true\n[[port]]\nof = "RTT"\n'
    with tempfile.TemporaryDirectory() as folder:
        recording = os.path.join(folder, "said.omnirec")
        with served(ports, "--robots", "2", "--clock", "free", "--duration", "0.1", "--record", recording) as bench:
            report = bench.finish()
        assert report.code == 0, report.text
        with open(recording, encoding="utf-8") as lines:
            said = [line.split(" ", 5) for line in lines if line.startswith("t ") and "semihosting" not in line]
        assert [(words[2], words[3], words[4], words[5].strip()) for words in said] == [
            ("2", "0", "USART2", "boot"), ("2", "0", "RTT", "by rtt, and it is longer than the buffer")], said
        # "boot" and its line end: six frames of ten bits at 115200
        assert 0.0005 <= int(said[0][1]) * 1e-9 <= 0.002, said
        program = os.environ["OMNIHIL_PROGRAM"]
        dumped = subprocess.run([program, "dump", recording], capture_output=True, text=True, check=True).stdout
        assert "| robot 2 USART2: boot" in dumped, dumped
        assert "| robot 2 RTT: by rtt" in dumped, dumped
        # What a program that does not know these lines reads is the rest.
        plain = os.path.join(folder, "plain.omnirec")
        with open(recording, encoding="utf-8") as lines, open(plain, "w", encoding="utf-8") as rest:
            rest.writelines(line for line in lines if not line.startswith("t "))
        assert subprocess.run([program, "dump", plain], capture_output=True, text=True, check=True).stdout == "".join(
            line + "\n" for line in dumped.splitlines() if " | robot" not in line)


if __name__ == "__main__":
    sys.exit(benches.main({name: thing for name, thing in globals().items() if callable(thing)}))
