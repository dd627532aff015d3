#!/usr/bin/env python3
"""Runs a command where there is SocketCAN: an interface vcan0 of its own, CAN FD included.

    under_can.py [--seconds 120] COMMAND…

Where this kernel has AF_CAN: in a network namespace. Elsewhere: in user-mode Linux, a kernel that is a program, on this file
system. It may read all of it and writes nothing but $TMPDIR, which is memory. Environment: PATH and OMNIHIL_….
Exit code: the command's; 1 also when it said nothing or did not end in time; 77 when something is not installed.
"""
import argparse
import glob
import os
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import tempfile

NETWORK = "ip link add dev vcan0 type vcan && ip link set vcan0 mtu 72 up && ip link set lo up"
NOT_INSTALLED = 77
MODULES = ["net/can/can.ko", "net/can/can-raw.ko", "drivers/net/can/dev/can-dev.ko", "drivers/net/can/vcan.ko",
           "drivers/net/can/slcan/slcan.ko"]

# {folder}/out is a folder of the host; all else that can be written is memory.
INIT = """#!/bin/sh
{environment}
mount -t proc proc /proc; mount -t sysfs sys /sys; mount -t tmpfs dev /dev || exit 1
mknod /dev/null c 1 3; mknod /dev/zero c 1 5; mknod /dev/urandom c 1 9; mknod /dev/tty c 5 0
mkdir -p /dev/pts /dev/shm; mount -t devpts -o ptmxmode=666 devpts /dev/pts; mount -t tmpfs tmpfs /dev/shm
ln -s pts/ptmx /dev/ptmx
mount -t hostfs -o '{folder}/out' none '{folder}/out'
mount -t tmpfs tmpfs '{folder}/tmp'
export TMPDIR='{folder}/tmp' HOME='{folder}/tmp'; cd "$TMPDIR"
for module in {modules}; do insmod "$module"; done
{{ {network} && {command}; }} > '{folder}/out/said' 2>&1 < /dev/null
echo $? > '{folder}/out/code'
echo 1 > /proc/sys/kernel/sysrq; echo o > /proc/sysrq-trigger; sleep 60
"""


def in_this_kernel(command):
    """The command behind the words that give it a vcan0 of its own here; None where this kernel cannot."""
    try:
        socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW).close()
    except (AttributeError, OSError):
        return None
    apart = ["unshare", "-n"] if os.geteuid() == 0 else ["unshare", "-r", "-n"]
    def words(what):
        return [*apart, "sh", "-c", f'{NETWORK} && exec "$@"', "sh", *what]
    probe = subprocess.run(words(["true"]), capture_output=True, check=False)
    return words(command) if probe.returncode == 0 else None


def run_group(command, seconds, **more):
    """(exit code or None when time was up, output) of a command; nothing of it is left running."""
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               start_new_session=True, **more)
    try:
        said, _ = process.communicate(timeout=seconds)
        return process.returncode, said.decode(errors="replace")
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        said, _ = process.communicate()
        return None, said.decode(errors="replace")


def environment():
    kept = {name: value for name, value in os.environ.items() if name == "PATH" or name.startswith("OMNIHIL_")}
    kept["PYTHONDONTWRITEBYTECODE"] = "1"
    kept["PATH"] = kept.get("PATH", "") + ":/usr/sbin:/sbin:/usr/bin:/bin"
    return "\n".join(f"export {name}={shlex.quote(value)}" for name, value in kept.items())


def in_user_mode_linux(command, seconds):
    kernel = shutil.which("linux.uml")
    folders = glob.glob("/usr/lib/uml/modules/*/kernel")
    if not kernel or not folders or not shutil.which("ip", path="/usr/sbin:/sbin:/usr/bin:/bin"):
        print("needs a kernel with CAN, or user-mode-linux, kmod and iproute2 (./dev test installs them)")
        return NOT_INSTALLED
    folder = tempfile.mkdtemp(prefix="omnihil-uml-", dir="/tmp")
    try:
        for name in ("out", "tmp"):
            os.mkdir(os.path.join(folder, name))
        init = os.path.join(folder, "init")
        with open(init, "w", encoding="utf-8") as out:
            out.write(INIT.format(environment=environment(), folder=folder, network=NETWORK, command=shlex.join(command),
                                  modules=" ".join(os.path.join(folders[-1], module) for module in MODULES)))
        os.chmod(init, 0o755)
        host = dict(os.environ)
        if "OMNIHIL_UML_PRELOAD" in os.environ:
            host["LD_PRELOAD"] = os.environ["OMNIHIL_UML_PRELOAD"]
        ended, kernel_said = run_group(
            [kernel, "mem=512M", "root=/dev/root", "rootfstype=hostfs", "rootflags=/", "ro", f"init={init}", "con=null",
             "con0=fd:0,fd:1", "quiet", f"uml_dir={folder}"], seconds, env=host)
        said, code = (read(os.path.join(folder, "out", name)) for name in ("said", "code"))
        sys.stdout.write(said)
        if ended is None:
            print(f"no end within {seconds} s")
        if not code.strip():
            print(f"the command did not end; the kernel said:\n{kernel_said}")
            return 1
        return int(code) if said.strip() else silent()
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def read(path):
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            return file.read()
    except FileNotFoundError:
        return ""


def silent():
    print("the command said nothing")
    return 1


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--seconds", type=float, default=120)
    parser.add_argument("command", nargs=argparse.REMAINDER)
    given = parser.parse_args()
    here = in_this_kernel(given.command)
    if here is None:
        return in_user_mode_linux(given.command, given.seconds)
    code, said = run_group(here, given.seconds)
    sys.stdout.write(said)
    if code is None:
        print(f"no end within {given.seconds} s")
        return 1
    return code if said.strip() else silent()


if __name__ == "__main__":
    sys.exit(main())
