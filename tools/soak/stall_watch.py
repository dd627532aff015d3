"""When does a core of the computer stand still? A process on it with the highest real-time priority that does nothing but sleep a millisecond
at a time: what it oversleeps, every other process stood as well (a virtual machine whose host gave its cores to others, an
interrupt that took long). No program of ours can be the cause: none has a priority as high.

    watch = StallWatch(cpu)       # watch.refused: why no such priority could be had; then stalls_s() is empty
    ...
    watch.stalls_s()              # ends the process: every time it overslept by more than LEAST_S
"""
import os
import subprocess
import sys
import time

PERIOD_S = 0.001
LEAST_S = 0.010  # half of what a bench makes up for (docs/serve.md, "Time"): shorter ones cannot make it slip
PRIORITY = 99


def watch(cpu):
    os.sched_setaffinity(0, {cpu})
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
    except OSError as error:
        print(f"refused {error.strerror}", flush=True)
        return
    print("watching", flush=True)
    os.set_blocking(0, False)
    last_s = time.monotonic()
    while not ended():
        time.sleep(PERIOD_S)
        now_s = time.monotonic()
        if now_s - last_s - PERIOD_S > LEAST_S:
            print(f"{now_s - last_s - PERIOD_S:.6f}", flush=True)
        last_s = now_s


def ended():
    """Whoever started it has closed its end."""
    try:
        return os.read(0, 1) == b""
    except BlockingIOError:
        return False


class StallWatch:
    def __init__(self, cpu):
        self.process = subprocess.Popen([sys.executable, "-B", os.path.abspath(__file__), str(cpu)], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, text=True)
        first = self.process.stdout.readline().strip()
        self.refused = first.removeprefix("refused ") if first.startswith("refused") else ""

    def stalls_s(self):
        text, _ = self.process.communicate()
        return [float(line) for line in text.split()]


if __name__ == "__main__":
    watch(int(sys.argv[1]))
