"""The frames of a real AI host, written into the virtual dongle at the times at which they came."""
import json
import os
import sys
import time

import serial

import bench as rig
import hermes
from bench import Bench, DEADLINE_S, Skip


def stream():
    shared = os.environ.get("OMNIHIL_SHARED")
    if not shared:
        raise Skip("OMNIHIL_SHARED is not set: the recorded host stream is not at hand")
    path = os.path.join(shared, "vectors", "ulaval-strategyai-host-stream.json")
    if not os.path.exists(path):
        raise Skip(f"{path} is not there")
    with open(path, encoding="utf-8") as file:
        return next(iter(json.load(file)["sessions"].values()))


def real_host_drives_six_robots_with_no_frame_refused():
    rows = stream()
    with Bench(["--robots", "0-5", "--radio", "ulaval-hermes", "--record", "{folder}/run.omnirec"]) as bench:
        with serial.Serial(bench.device, 115200, timeout=DEADLINE_S, write_timeout=DEADLINE_S) as port:
            start = time.monotonic()
            for at_s, frame in rows:
                # The stream's own times are the input here, not a way to wait for the bench.
                time.sleep(max(0.0, start + at_s - time.monotonic()))
                port.write(bytes.fromhex(frame))
            hermes.ping(port)  # its answer comes after all frames before it
        report = bench.stop()
        recorded = rig.recorded(bench.path("run.omnirec"), ["true_x_m", "true_y_m", "true_yaw_rad"])
    assert report.code == 0, report.text
    assert report.good == len(rows) + 1 and report.refused == 0, report.text
    for robot in range(6):
        own = [values for _, who, values in recorded if who == robot]
        moved = max(abs(v["true_x_m"] - own[0]["true_x_m"]) + abs(v["true_y_m"] - own[0]["true_y_m"]) for v in own)
        print(f"robot {robot}: moved up to {moved:.2f} m")
        assert moved > 0.1, (robot, moved)


if __name__ == "__main__":
    sys.exit(rig.main({"real_host_drives_six_robots_with_no_frame_refused":
                       real_host_drives_six_robots_with_no_frame_refused}))
