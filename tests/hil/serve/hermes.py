"""HERMES packets from the table alone: COBS(version, source, destination, type, sum, payload) then 00."""
import struct

PING_REQUEST, PING_RESPONSE, SPEED_MOVE, GET_BATTERIE, BATTERIE_RESPONSE = 0, 1, 2, 5, 6
HOST = 0xFE


def cobs(data):
    out, block = bytearray(), bytearray()
    for byte in data:
        if byte:
            block.append(byte)
            if len(block) == 254:
                out += bytes([255]) + block
                block = bytearray()
        else:
            out += bytes([len(block) + 1]) + block
            block = bytearray()
    return bytes(out + bytes([len(block) + 1]) + block)


def uncobs(data):
    out, at = bytearray(), 0
    while at < len(data):
        code = data[at]
        out += data[at + 1:at + code]
        at += code
        if code < 255 and at < len(data):
            out.append(0)
    return bytes(out)


def packet(robot, kind, payload=b"", version=1, source=HOST, add_to_sum=0):
    head = bytes([version, source, robot, kind])
    total = (sum(head) + sum(payload) + add_to_sum) % 256
    return cobs(head + bytes([total]) + payload) + b"\0"


def speed_move(robot, vx, vy, vtheta):
    return packet(robot, SPEED_MOVE, struct.pack("<fff", vx, vy, vtheta))


def read_packet(port):
    """Next answer of a robot as (robot, type, payload); fails when the port's own timeout passes."""
    frame = port.read_until(b"\0")
    assert frame.endswith(b"\0"), f"no answer within {port.timeout} s (got {frame.hex()})"
    data = uncobs(frame[:-1])
    assert data[4] == (sum(data) - data[4]) % 256, f"checksum of {data.hex()}"
    assert data[0] == 1 and data[2] == 0, f"header of {data.hex()}"
    return data[1], data[3], data[5:]


def ping(port, robot=0):
    port.write(packet(robot, PING_REQUEST))
    answer = read_packet(port)
    assert answer == (robot, PING_RESPONSE, b""), answer
