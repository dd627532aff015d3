"""The dissectors in docs/radio against the program: every golden packet, field by field, through tshark.

    wireshark_test.py OMNIHIL SOURCE_DIR [FORMAT…]
"""
import json
import math
import re
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

USER_0 = 147


def capture(frames):
    """A pcap file of link type USER 0, one frame per packet."""
    out = struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, 65535, USER_0)
    for number, frame in enumerate(frames):
        out += struct.pack("<IIII", number, 0, len(frame), len(frame)) + frame
    return out


def leaves(value, path=""):
    """Path and value of everything in a JSON tree, paths as the tables write them."""
    if isinstance(value, dict):
        for key, each in value.items():
            yield from leaves(each, f"{path}.{key}" if path else key)
    elif isinstance(value, list):
        for place, each in enumerate(value):
            yield from leaves(each, f"{path}[{place}]")
    else:
        yield path, value


def decoded(omnihil, format_id, frames):
    lines = subprocess.run([omnihil, "decode", format_id], input="\n".join(f.hex() for f in frames) + "\n",
                           capture_output=True, text=True, check=True).stdout.splitlines()
    return [json.loads(line) for line in lines]


def dissected(dissector, frames):
    """Per frame what the dissector shows: {filter name: text}."""
    with tempfile.NamedTemporaryFile(suffix=".pcap") as file:
        file.write(capture(frames))
        file.flush()
        done = subprocess.run(["tshark", "-r", file.name, "-X", f"lua_script:{dissector}", "-T", "pdml"],
                              capture_output=True, text=True, check=True)
    if "Lua" in done.stderr:
        raise SystemExit(f"{dissector}: {done.stderr}")
    packets = []
    for packet in ElementTree.fromstring(done.stdout).iter("packet"):
        packets.append({field.get("name"): field.get("show") for field in packet.iter("field")})
    return packets


def spans(dissector):
    """Per packet and field the span of its scaled integers, by the dissector's own rows."""
    found, packet = {}, ""
    with open(dissector) as lines:
        for line in lines:
            if name := re.match(r'  \{ name = "([^"]+)"', line):
                packet = name[1]
            elif row := re.match(r'    \{ "([^"]+)", \d+, (\d+), "scaled", "[^"]*", "\w*", ([^,]+),', line):
                found[packet, row[1]] = 2 ** int(row[2]) * float(row[3])
    return found


def is_same(shown, value, span):
    if shown is None or value is None:
        return shown is None and value is None
    if isinstance(value, bool):
        return int(shown, 0) == int(value)
    if isinstance(value, int):
        return int(shown, 0) == value
    # tshark prints floats with six digits or more; teams compute in float32 what the dissector does in double.
    return math.isclose(float(shown), value, rel_tol=1e-5, abs_tol=2 ** -23 * span)


def check(omnihil, source, format_id, frames):
    protocol = format_id.replace("-", "_")
    faults, fields = [], 0
    dissector = f"{source}/docs/radio/{format_id}.lua"
    span = spans(dissector)
    shown = dissected(dissector, frames)
    for frame, packet, seen in zip(frames, decoded(omnihil, format_id, frames), shown, strict=True):
        for path, value in leaves(packet["fields"]):
            if path == "text":
                continue
            name = f"{protocol}.{packet['packet']}." + re.sub(r"[^A-Za-z0-9_]+", "_", path)
            fields += 1
            if not is_same(seen.get(name), value, span.get((packet["packet"], path), 0.0)):
                faults.append(f"{format_id} {frame.hex()}: {name} is {value}, tshark shows {seen.get(name)}")
    print(f"{format_id}: {len(frames)} packets, {fields} fields")
    return faults, fields


def main():
    omnihil, source, *wanted = sys.argv[1:]
    frames = {}
    with open(f"{source}/tests/protocols/golden/packets.jsonl") as golden:
        for line in golden:
            row = json.loads(line)
            frames.setdefault(row["format"], []).append(bytes.fromhex(row["hex"]))
    faults, fields = [], 0
    for format_id in wanted or sorted(frames):
        more, count = check(omnihil, source, format_id, frames[format_id])
        faults += more
        fields += count
    print("\n".join(faults))
    sys.exit(1 if faults or fields == 0 else 0)


if __name__ == "__main__":
    main()
