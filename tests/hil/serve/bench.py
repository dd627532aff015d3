"""Starts `omnihil serve` for a test, waits for what it says, and ends it. Nothing here sleeps to synchronise:
every wait ends with an event (a line, bytes, an exit) or fails at its deadline.

    with Bench(["--robots", "0", "--record", "{folder}/run.omnirec"]) as bench:
        port = serial.Serial(bench.device, 115200, timeout=5)
        ...
        report = bench.stop()          # SIGTERM, final report; .code, .text
"""
import fcntl
import json
import os
import pty
import re
import select
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time

DEADLINE_S = 60.0  # far beyond what a loaded computer needs; only a fault reaches it


class Report:
    def __init__(self, code, text):
        self.code, self.text = code, text

    def number(self, pattern):
        found = re.search(pattern, self.text)
        assert found, f"no '{pattern}' in the report:\n{self.text}"
        return float(found.group(1))

    @property
    def good(self):
        return int(self.number(r"from the host +(\d+) packets good"))

    @property
    def refused(self):
        return int(self.number(r"from the host +\d+ packets good, (\d+) refused"))

    @property
    def causes(self):
        found = re.search(r"from the host .* refused \((.*)\)", self.text)
        pairs = [part.rsplit(" ", 1) for part in found.group(1).split(", ")] if found else []
        return {cause: int(count) for cause, count in pairs}

    @property
    def steps(self):
        return int(self.number(r"\((\d+) steps\)"))


class Bench:
    def __init__(self, arguments=(), columns=None, device=None, files=None, typed=None):
        """columns: the bench sees a terminal that wide instead of a pipe. device: a wire instead of a path.
        files: texts by name, in its folder before it starts; {folder} in them is that. typed: its standard input."""
        self.folder = tempfile.mkdtemp(prefix="omnihil-serve-")
        for name, text in (files or {}).items():
            with open(self.path(name), "w", encoding="utf-8") as file:
                file.write(text.replace("{folder}", self.folder))
        self.device = device or self.path("dongle")
        self.program = os.environ["OMNIHIL_PROGRAM"]
        arguments = [argument.replace("{folder}", self.folder) for argument in arguments]
        if columns:
            self.output, end = pty.openpty()
            fcntl.ioctl(end, termios.TIOCSWINSZ, struct.pack("HHHH", 25, columns, 0, 0))
        else:
            self.output, end = os.pipe()
        self.process = subprocess.Popen([self.program, "serve", "--device", self.device, *arguments],
                                        stdin=subprocess.DEVNULL if typed is None else subprocess.PIPE, stdout=end,
                                        stderr=subprocess.STDOUT)
        os.close(end)
        if typed is not None:
            with self.process.stdin as keys:
                keys.write(typed)
        self.text = ""
        self.wait_for(" ready: ")
        self.device = re.search(r"device (\S+) ready: ", self.text).group(1)  # a wire's name may say more

    def path(self, name):
        return os.path.join(self.folder, name)

    def read_more(self, end_s):
        """Appends what the bench prints next; False when it has closed its output."""
        ready, _, _ = select.select([self.output], [], [], max(0.0, end_s - time.monotonic()))
        assert ready, f"nothing more came within {DEADLINE_S} s:\n{self.text}"
        try:
            chunk = os.read(self.output, 65536)
        except OSError:  # a terminal whose other end is closed
            chunk = b""
        self.text += chunk.decode()
        return bool(chunk)

    def wait_for(self, words, times=1):
        """Reads what the bench prints until `words` stand in it."""
        end_s = time.monotonic() + DEADLINE_S
        while self.text.count(words) < times:
            assert self.read_more(end_s), f"the bench ended without '{words}':\n{self.text}"

    def finish(self):
        """Waits for the end of its own accord."""
        end_s = time.monotonic() + DEADLINE_S
        while self.read_more(end_s):
            pass
        return Report(self.process.wait(timeout=DEADLINE_S), self.text)

    def stop(self, number=signal.SIGTERM):
        self.process.send_signal(number)
        return self.finish()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        os.close(self.output)
        shutil.rmtree(self.folder, ignore_errors=True)


class Skip(Exception):
    """A test that cannot run here, and why."""


def main(tests):
    """Runs the test named on the command line; exit code 77 means skipped, the reason is printed."""
    name = sys.argv[1]
    try:
        tests[name]()
    except Skip as reason:
        print(f"skipped: {reason}")
        return 77
    return 0


def recorded(path, columns):
    """The `s` lines of a recording: rows of (time in s, robot id, {column: value})."""
    rows = []
    with open(path, encoding="utf-8") as lines:
        names = json.loads(next(lines)[2:])["columns"]
        wanted = [(name, names.index(name)) for name in columns]
        for line in lines:
            if line.startswith("s "):
                parts = line.split()
                values = {name: float(parts[3 + at]) for name, at in wanted}
                rows.append((int(parts[1]) * 1e-9, int(parts[2]), values))
    return rows
