#!/usr/bin/env python3
"""Robots of the SSL A-Team (RNP, 2025) at 100 Hz both ways, in real time, for a long time: is a packet lost by us, does memory
or the number of descriptors grow, how late is the loop? Called by `./dev soak`.

    soak.py --program omnihil [SECONDS]      600 s of 16 robots; exit 1 when something was lost, grew or fell behind

A robot of this team is a computer of its own on the network, so each is a bench of its own (`serve --robots N`, UDP). The host
(rnp_host.py) is not ours in any line of code. Counted at both ends: commands sent = packets the bench took; numbers of telemetry
without a gap; packets the bench sent = packets that came. A bare timer of the highest priority on each core beside them
says whether the computer stood still (which no program on it can help); a bench that fell behind is a failure all the same.
"""
import argparse
import os
import re
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from rnp_host import Host  # noqa: E402
from stall_watch import StallWatch  # noqa: E402
from verdict import flat_faults, packet_faults  # noqa: E402

START_S = 60.0  # within it every robot has looked for its host; far beyond what a loaded computer needs


def number(pattern, text):
    found = re.search(pattern, text)
    if not found:
        sys.exit(f"no '{pattern}' in the bench's report:\n{text}")
    return found.group(1)


def microseconds(text):
    value, unit = text.split()
    return float(value) * {"us": 1.0, "ms": 1e3, "s": 1e6}[unit]


class Served:
    def __init__(self, arguments, robot, port):
        command = [arguments.program, "serve", "--radio", "ateam-rnp-stspin-2025", "--robot", arguments.robot, "--robots",
                   str(robot), "--physics", arguments.physics, "--device", f"udp:127.0.0.1:{port}?seek=1", *arguments.serve]
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                        text=True)
        self.samples, self.cpu_s = [], []

    def sample(self):
        folder = f"/proc/{self.process.pid}"
        with open(f"{folder}/status", encoding="ascii") as status:
            kilobytes = int(number(r"RssAnon:\s+(\d+) kB", status.read()))
        self.samples.append((kilobytes, len(os.listdir(f"{folder}/fd"))))
        with open(f"{folder}/stat", encoding="ascii") as stat:
            user, system = stat.read().rsplit(")", 1)[1].split()[11:13]
        self.cpu_s.append((int(user) + int(system)) / os.sysconf("SC_CLK_TCK"))

    def stop(self):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        self.text = self.process.communicate(timeout=60)[0]
        return self.process.returncode


def report(robots, served, host, seconds, stalls):
    """Prints what was seen; returns the faults, and those of time apart. `stalls`: by core, in s."""
    faults, late = [], []
    sent = received = 0
    p99, worst = [], []
    for key, bench in served.items():
        text = bench.text
        robot = robots[key]
        faults += packet_faults(key, robot, int(number(r"from the host +(\d+) packets good", text)),
                                int(number(r"from the host .* good, (\d+) refused", text)),
                                int(number(r"from the robots +(\d+) packets good", text)))
        faults += flat_faults(f"robot {key}", bench.samples)
        if "host not reading" in text:
            faults.append(f"robot {key}: the bench dropped answers")
        sent, received = sent + robot.sent, received + robot.received
        p99.append(microseconds(number(r"lateness +p50 .*?, p99 (\S+ u?m?s)", text)))
        worst.append(microseconds(number(r"lateness .*max (\S+ u?m?s)", text)))
        if robot.hellos > 1:  # it heard nothing for a second
            late.append(f"robot {key}: looked for its host {robot.hellos} times")
        if "OVERLOADED" in text:
            late.append(f"robot {key}: " + re.search(r"simulated time slipped.*", text).group(0))
    lost = sum(robots[key].missing for key in served)
    kilobytes = [bench.samples[len(bench.samples) // 4][0] for bench in served.values()]
    last = [bench.samples[-1][0] for bench in served.values()]
    print(f"{len(served)} robots, {seconds:.0f} s: {sent} packets to them, {received} from them "
          f"({sent / seconds / len(served):.1f} and {received / seconds / len(served):.1f} a second and robot)")
    print(f"  lost             {lost} of telemetry; {sum(b.damaged for b in robots.values())} damaged")
    print(f"  memory           {sum(kilobytes)} kB after the first quarter, {sum(last)} kB at the end (anonymous, all benches)")
    print(f"  descriptors      {sum(b.samples[0][1] for b in served.values())} at first, "
          f"{sum(b.samples[-1][1] for b in served.values())} at the end")
    cores = sum(bench.cpu_s[-1] - bench.cpu_s[0] for bench in served.values()) / seconds
    print(f"  processor        {cores:.2f} of a core, all benches")
    print(f"  lateness p99     {sorted(p99)[len(p99) // 2]:.0f} us the median bench, {max(p99):.0f} us the worst; "
          f"max {max(worst) / 1e3:.1f} ms; a command left the host at most {host.worst_send_s * 1e3:.1f} ms late")
    for cpu, stalls_s in stalls.items():
        if stalls_s:
            print(f"  stalls           core {cpu} stood still {len(stalls_s)} times, up to {max(stalls_s) * 1e3:.1f} ms (a bare timer "
                  "of the highest priority)")
    return faults, late


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("seconds", nargs="?", type=float, default=600.0)
    parser.add_argument("--program", required=True)
    parser.add_argument("--robots", type=int, default=16)
    parser.add_argument("--rate", type=float, default=100.0, help="commands per second and robot")
    parser.add_argument("--robot", default="omni_default", help="model")
    parser.add_argument("--physics", default="planar")
    parser.add_argument("--fifo", action="store_true", help="real-time scheduling of the benches; needs the rights for it")
    parser.add_argument("--counts-only", action="store_true", help="falling behind is said, but is no failure")
    parser.add_argument("--serve", default="", help="further arguments of every bench, in one string")
    arguments = parser.parse_args()
    arguments.serve = arguments.serve.split() + (["--fifo"] if arguments.fifo else [])

    host, served = Host(), {}
    watches = {cpu: StallWatch(cpu) for cpu in sorted(os.sched_getaffinity(0))}
    refused = {watch.refused for watch in watches.values() if watch.refused}
    if refused:
        print(f"stalls of the computer are not told: {', '.join(refused)}")
    status = 1
    try:
        for robot in range(arguments.robots):
            served[robot] = Served(arguments, robot, host.port)
        if not host.meet(arguments.robots, time.monotonic() + START_S):
            raise RuntimeError(f"only robots {sorted(host.robots)} looked for their host")
        start_s = time.monotonic()

        def watch():
            for bench in served.values():
                bench.sample()

        host.run(start_s + arguments.seconds, 1.0 / arguments.rate, arguments.seconds / 40, watch)
        if not host.settle(5, time.monotonic() + START_S):
            raise RuntimeError("a robot fell silent")
        codes = [bench.stop() for bench in served.values()]
        host.listen(0.0)
        stalls = {cpu: watch.stalls_s() for cpu, watch in watches.items()}
        faults, late = report(host.robots, served, host, arguments.seconds, stalls)
        faults += [f"robot {key}: ended with {code}" for key, code in enumerate(codes) if code != 0]
        for line in faults + late:
            print(f"  {'behind' if line in late else 'FAULT '}           {line}")
        status = 1 if faults or (late and not arguments.counts_only) else 0
        print("passed" if status == 0 else "failed")
    except RuntimeError as error:
        print(f"soak: {error}")
        for key, bench in served.items():
            bench.stop()
            print(f"-- robot {key}\n{bench.text}", end="")
    finally:
        for bench in served.values():
            if bench.process.poll() is None:
                bench.process.kill()
                bench.process.wait()
        for watch in watches.values():
            watch.stalls_s()
    return status


if __name__ == "__main__":
    sys.exit(main())
