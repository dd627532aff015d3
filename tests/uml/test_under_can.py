#!/usr/bin/env python3
"""What under_can.py promises: the command's exit code, no silence, an end, and a file system that stays as it is.

    test_under_can.py UNDER_CAN_PY
"""
import os
import socket
import subprocess
import sys
import tempfile
import unittest

UNDER_CAN = ""
NOT_INSTALLED = 77
# under_can.py as it is where linux.uml is not installed
NO_OTHER_KERNEL = """
import runpy, shutil, sys
shutil.which = lambda *words, **more: None
sys.argv = [sys.argv[1], "ip", "-o", "link", "show", "type", "vcan"]
runpy.run_path(sys.argv[0], run_name="__main__")
"""


def under_can(*words):
    return subprocess.run([sys.executable, UNDER_CAN, *words], capture_output=True, text=True, check=False)


def processes_of(group_word):
    found = []
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/cmdline", "rb") as line:
                words = line.read().decode(errors="replace")
        except OSError:
            continue
        if group_word in words and int(name) != os.getpid():
            found.append(words)
    return found


class UnderCan(unittest.TestCase):
    def test_there_is_an_interface_that_takes_can_fd(self):
        run = under_can("ip", "-details", "link", "show", "vcan0")
        self.assertEqual(run.returncode, 0, run.stdout)
        self.assertIn("mtu 72", run.stdout)

    def test_the_exit_code_is_the_commands(self):
        self.assertEqual(under_can("sh", "-c", "echo said; exit 3").returncode, 3)

    def test_a_command_that_says_nothing_has_failed(self):
        run = under_can("true")
        self.assertEqual((run.returncode, run.stdout), (1, "the command said nothing\n"))

    def test_a_command_that_does_not_end_has_failed_and_nothing_of_it_is_left(self):
        word = f"86{os.getpid()}"  # seconds, and a word that no other process has
        run = under_can("--seconds", "8", "sh", "-c", f"echo begun; sleep {word}")
        self.assertEqual(run.returncode, 1, run.stdout)
        self.assertIn("no end within 8.0 s", run.stdout)
        self.assertEqual(processes_of(word), [])

    def test_files_of_this_computer_are_read_and_not_written(self):
        try:
            socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW).close()
            self.skipTest("this kernel has CAN: the command runs as any other does")
        except OSError:
            pass
        with tempfile.TemporaryDirectory() as folder:
            kept = os.path.join(folder, "kept")
            with open(kept, "w", encoding="utf-8") as file:
                file.write("as it was")
            under_can("sh", "-c", f"echo x > {kept}; rm -f {kept}; touch {folder}/new; echo y > $TMPDIR/mine && cat $TMPDIR/mine")
            self.assertEqual(os.listdir(folder), ["kept"])
            with open(kept, encoding="utf-8") as file:
                self.assertEqual(file.read(), "as it was")

    def test_a_kernel_that_has_can_is_used_as_it_is(self):
        # within: an interface of the outer one's name exists there already, so the inner one has a network of its own
        # and nothing of user-mode Linux is there to fall back on
        run = under_can("env", "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "/usr/bin/python3", "-c", NO_OTHER_KERNEL, UNDER_CAN)
        self.assertEqual(run.returncode, 0, run.stdout)
        self.assertEqual(run.stdout.count("vcan0"), 1, run.stdout)


if __name__ == "__main__":
    UNDER_CAN = os.path.abspath(sys.argv[1])
    if under_can("echo", "here").returncode == NOT_INSTALLED:
        sys.exit(NOT_INSTALLED)
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
