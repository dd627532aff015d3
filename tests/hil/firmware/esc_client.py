"""Motor controllers that are not ours at `omnihil serve`, told by clients that are not ours: python-can and pyserial."""
import os
import struct
import sys
import time

from board_bench import benches, board_text, on_board

DAMPING = 0.05  # N m s/rad: what the rolling wheel asks for over this is missing of its speed


def served(image, board, ports, keep_ports=True):
    """A robot with this controller at one wheel; `ports` are added to its board, {folder} is the bench's own."""
    path = os.path.join(os.environ.get("OMNIHIL_IMAGES", ""), image)
    if "OMNIHIL_IMAGES" not in os.environ or not os.path.exists(path):
        raise benches.Skip(f"no {image} in OMNIHIL_IMAGES (docs/mcu-third-party.md)")
    text = board_text(board)
    if not keep_ports:  # its last lines: a pty of the caller's place instead
        text = text[:text.rindex("[[port]]")]
    return on_board(path, text + ports, "--robot", "omni_foc", "--robots", "0", "--clock", "free")


def mini_cheetah_command(speed_rad_s, damping):
    """Position 0, speed, stiffness 0, damping, torque 0 as its packet has them: 16, 12, 12, 12, 12 bits over its ranges."""
    position, torque = 32767, 2047
    speed = round((speed_rad_s + 65) / 130 * 4095)
    gain = round(damping / 5 * 4095)
    word = position << 48 | speed << 36 | 0 << 24 | gain << 12 | torque
    return word.to_bytes(8, "big")


def mini_cheetah_turns_as_python_can_says():
    import can
    with served("mini-cheetah-f446.elf", "mini_cheetah_f446.toml", '\n[[port]]\nof = "CAN1"\nas = "slcan:{folder}/can"\n') as bench:
        with can.interface.Bus(bench.path("can"), interface="slcan", bitrate=1000000, ttyBaudrate=115200,
                               sleep_after_open=0) as bus:
            def told(data):
                bus.send(can.Message(arbitration_id=1, data=data, is_extended_id=False))
                return bus.recv(0.05)

            end, answer = time.monotonic() + benches.DEADLINE_S, None
            while answer is None and time.monotonic() < end:  # it boots
                answer = told(b"\xff" * 7 + b"\xfc")
            assert answer is not None, "it never answered"
            for asked_rad_s in (20.0, -15.0):
                mean, end, speeds = 0.0, time.monotonic() + benches.DEADLINE_S, []
                while abs(mean - asked_rad_s) > 1.5 and time.monotonic() < end:  # of the last second of replies or so
                    answer = told(mini_cheetah_command(asked_rad_s, DAMPING))
                    if answer is None:
                        continue
                    word = answer.data[3] << 4 | answer.data[4] >> 4
                    speeds = [*speeds[-399:], word * 130 / 4095 - 65]
                    mean = sum(speeds) / len(speeds) if len(speeds) == 400 else 0.0
                assert abs(mean - asked_rad_s) <= 1.5, (asked_rad_s, speeds[-30:])
        report = bench.stop()
    assert report.code == 0 and "CAN1 at slcan:" in report.text, report.text


def an_odrive_says_by_pyserial_who_it_is():
    import serial
    with served("odrive-36-f405.elf", "odrive_36_f405.toml", '[[port]]\nof = "UART4"\nas = "pty:{folder}/odrive"\n',
                keep_ports=False) as bench:
        with serial.Serial(bench.path("odrive"), 115200, timeout=0.5) as port:
            def asked(line):
                end = time.monotonic() + benches.DEADLINE_S
                while time.monotonic() < end:  # it does not answer before it has booted
                    port.reset_input_buffer()
                    port.write(line + b"\n")
                    if answer := port.readline().strip():
                        return answer.decode()
                return ""

            assert asked(b"i") == "Hardware version: 3.6-56V"
            time.sleep(0.2)
            assert 20.0 < float(asked(b"r vbus_voltage")) < 26.0
        bench.stop()


def crc16(data):
    crc = 0
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xFFFF
    return crc


def a_vesc_says_by_pyserial_who_it_is():
    import serial
    asks = b"\x00"  # COMM_FW_VERSION
    packet = b"\x02" + bytes([len(asks)]) + asks + struct.pack(">H", crc16(asks)) + b"\x03"
    with served("vesc-410-f405.elf", "vesc_410_f405.toml", '[[port]]\nof = "USART6"\nas = "pty:{folder}/vesc"\n',
                keep_ports=False) as bench:
        with serial.Serial(bench.path("vesc"), 115200, timeout=0.5) as port:
            end, answer = time.monotonic() + benches.DEADLINE_S, b""
            while len(answer) < 5 and time.monotonic() < end:
                port.write(packet)
                answer = port.read(256)
        bench.stop()
    assert answer[:1] == b"\x02" and answer[2:3] == asks, answer
    body = answer[2:2 + answer[1]]
    assert struct.unpack(">H", answer[2 + answer[1]:4 + answer[1]])[0] == crc16(body), answer
    assert body[3:].split(b"\0")[0] in (b"410", b"410_no_limits"), body


if __name__ == "__main__":
    sys.exit(benches.main({name: thing for name, thing in globals().items() if callable(thing)}))
