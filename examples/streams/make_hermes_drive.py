#!/usr/bin/env python3
"""Makes hermes-drive.txt: what an AI host with six robots writes to its dongle in eight seconds.

    ./dev exec encode --help                                     # the encoder it uses
    python3 examples/streams/make_hermes_drive.py PATH_TO_OMNIHIL > examples/streams/hermes-drive.txt

The six robots do the same, side by side: stand, forward, left, turn, a square, stand. Velocities are in the
robot's own frame and change by at most 2 m/s^2 and 12 rad/s^2, as a host with a trajectory planner does it.
Frames come as a real host of this format writes them: a burst of one per robot at 30 Hz. Twice a second one
robot is asked for its battery, in turn, so that the dongle has something to answer.
"""
import json
import subprocess
import sys

RATE_HZ = 30
ROBOTS = range(6)
ACCELERATION = (2.0, 2.0, 12.0)  # m/s^2, m/s^2, rad/s^2
# until (s), forward (m/s), left (m/s), turn (rad/s)
LEGS = [
    (0.5, 0.0, 0.0, 0.0),
    (1.7, 0.8, 0.0, 0.0),   # forward
    (2.9, 0.0, 0.8, 0.0),   # left
    (3.9, 0.0, 0.0, 3.0),   # turn
    (4.7, 0.6, 0.0, 0.0),   # a square: forward, left, back, right
    (5.5, 0.0, 0.6, 0.0),
    (6.3, -0.6, 0.0, 0.0),
    (7.1, 0.0, -0.6, 0.0),
    (8.0, 0.0, 0.0, 0.0),
]


def towards(value, target, most):
    return value + max(-most, min(most, target - value))


def commands():
    """(time_s, (forward, left, turn)) at 30 Hz."""
    velocity = [0.0, 0.0, 0.0]
    for n in range(int(LEGS[-1][0] * RATE_HZ) + 1):
        time_s = n / RATE_HZ
        target = next((leg[1:] for leg in LEGS if time_s < leg[0]), (0.0, 0.0, 0.0))
        velocity = [towards(v, t, a / RATE_HZ) for v, t, a in zip(velocity, target, ACCELERATION)]
        yield n, time_s, velocity


def encode(program, packet, rows):
    """One hex line per row, by the program's own encoder."""
    text = "".join(json.dumps(row) + "\n" for row in rows)
    done = subprocess.run([program, "encode", "ulaval-hermes", packet], input=text, capture_output=True, text=True,
                          check=True)
    return done.stdout.split()


def main():
    program = sys.argv[1]
    drive, asked = [], []
    for n, time_s, (forward, left, turn) in commands():
        for robot in ROBOTS:
            drive.append((time_s, {"robot": robot, "vx": round(forward, 4), "vy": round(left, 4),
                                   "vtheta": round(turn, 4), "dribbler": 0, "charge": 0, "kick_force": 0}))
        if n % (RATE_HZ // 2) == 0:
            asked.append((time_s + 0.02, {"robot": (n // (RATE_HZ // 2)) % len(ROBOTS)}))
    frames = [(t, h) for (t, _), h in zip(drive, encode(program, "SPEED_MOVE_ADVANCE", [r for _, r in drive]))]
    frames += [(t, h) for (t, _), h in zip(asked, encode(program, "GET_BATTERIE", [r for _, r in asked]))]
    print("# Six robots, eight seconds: stand, forward, left, turn, a square, stand. Format ulaval-hermes.")
    print("# Made by make_hermes_drive.py beside this file. TIME_S HEX: what the host writes, and when.")
    for time_s, text in sorted(frames, key=lambda frame: frame[0]):
        print(f"{time_s:.4f} {text}")


if __name__ == "__main__":
    main()
