"""CAN logs by python-can, which shares no code with the program.

can_peer.py write FILE      writes frames() as .asc or .log, by the file's name
can_peer.py read FILE       prints a line per frame: TIME_US ID STANDARD|EXTENDED CLASSIC|FD|FDBRS RX|TX HEX
"""
import sys

import can
from can.io.asc import ASCReader, ASCWriter
from can.io.canutils import CanutilsLogReader, CanutilsLogWriter

START_S = 1700000000.25


def frames():
    """Classic and FD, 11 and 29 bit, no data and the most, received and sent, and two that are no data frames."""
    rows = [(0.0, 0x7E0, False, False, False, bytes(range(8)), True), (0.0005, 0x7E8, False, False, False, b"\x01", False),
            (0.25, 0x12345678, True, False, False, b"\xff\x00", True), (0.25, 0x001, False, False, False, b"", False),
            (1.000001, 0x7E0, False, True, True, bytes(range(64)), True), (1.5, 0x1FFFFFFF, True, True, False, bytes(12), False),
            (86400.0, 0x7FF, False, True, False, bytes(range(100, 148)), True)]
    out = [can.Message(timestamp=START_S + at, arbitration_id=i, is_extended_id=ext, is_fd=fd, bitrate_switch=brs, data=data, is_rx=rx)
           for at, i, ext, fd, brs, data, rx in rows]
    out.insert(3, can.Message(timestamp=START_S + 0.25, arbitration_id=0x7E0, is_extended_id=False, is_remote_frame=True, dlc=4))
    out.insert(5, can.Message(timestamp=START_S + 0.5, is_error_frame=True))
    return out


def main(what, name):
    asc = name.endswith(".asc")
    if what == "write":
        writer = (ASCWriter if asc else CanutilsLogWriter)(name)
        for each in frames():
            writer.on_message_received(each)
        writer.stop()
        return
    for m in ASCReader(name, relative_timestamp=False) if asc else CanutilsLogReader(name):
        kind = "FDBRS" if m.is_fd and m.bitrate_switch else "FD" if m.is_fd else "CLASSIC"
        print(round(m.timestamp * 1e6), f"{m.arbitration_id:X}", "EXTENDED" if m.is_extended_id else "STANDARD", kind,
              "RX" if m.is_rx else "TX", m.data.hex() or "-")


if __name__ == "__main__":
    main(*sys.argv[1:])
