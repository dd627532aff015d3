"""GDB itself at the emulated boards of `omnihil scenario run` and `omnihil serve`: each test is a function."""
import os
import re
import select
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "serve"))
import bench as benches  # noqa: E402

BUILD, SOURCE = os.environ["OMNIHIL_BUILD"], os.path.join(os.path.dirname(__file__), "..", "..", "..")
IMAGE = os.path.join(BUILD, "images", "omni_reference_f405.elf")
BOARD = os.path.join(SOURCE, "boards", "omni_reference_f405.toml")
FIRMWARE = ["--firmware", IMAGE, "--board", BOARD]
GDB = shutil.which("gdb-multiarch")
PORT = re.compile(r"wait at tcp:127\.0\.0\.1:(\d+)")


class Scenario:
    """`omnihil scenario run`, halted at its first instruction."""

    def __init__(self, name, *arguments):
        self.folder = tempfile.mkdtemp(prefix="omnihil-gdb-")
        self.process = subprocess.Popen(
            [os.environ["OMNIHIL_PROGRAM"], "scenario", "run", name, "--no-plots", "--all", *FIRMWARE, "--gdb",
             "tcp:127.0.0.1:0", *arguments],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.text, end_s = "", time.monotonic() + benches.DEADLINE_S
        while not PORT.search(self.text):
            ready, _, _ = select.select([self.process.stdout], [], [], end_s - time.monotonic())
            chunk = os.read(self.process.stdout.fileno(), 65536).decode() if ready else ""
            assert chunk, f"no port was said:\n{self.text}"
            self.text += chunk
        self.port = PORT.search(self.text).group(1)

    def finish(self):
        rest, _ = self.process.communicate(timeout=benches.DEADLINE_S)
        self.text += rest
        return self.process.returncode

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


def gdb(port, commands):
    """What GDB prints for these commands, in batch mode."""
    if GDB is None:
        raise benches.Skip("no gdb-multiarch")
    if not os.path.exists(IMAGE):
        raise benches.Skip("no arm-none-eabi-gcc: the image was not built")
    words = [GDB, "-q", "-nx", "-batch"]
    for command in ["set confirm off", "set pagination off", f"target remote 127.0.0.1:{port}", *commands]:
        words += ["-ex", command]
    done = subprocess.run([*words, IMAGE], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=3 * benches.DEADLINE_S, check=False)
    return done.stdout + done.stderr


def need():
    gdb_there = GDB is not None and os.path.exists(IMAGE)
    if not gdb_there:
        raise benches.Skip("needs gdb-multiarch and the image that arm-none-eabi-gcc builds")


def numbers(text, name):
    return [float(value) for value in re.findall(rf"{name} = (-?[\d.e+-]+)", text)]


def a_wheel_follows_its_integral_that_gdb_changes():
    """The session of docs/debugger.md: the loop stands in a breakpoint, one wheel's integral is set, the wheel follows."""
    need()
    with Scenario("wheel/speed_step") as run:
        said = gdb(run.port, [
            "break wheel_loop_update", "continue",
            "print loop->integral_V", "set $wheel = loop", "set var loop->integral_V = 8.0", "print loop->integral_V",
            "delete", "break wheel_loop_update if loop == $wheel", "ignore 2 40", "continue",
            'printf "changed = %f\\n", input->omega_rad_s',
            "delete", "break wheel_loop_update if loop == $wheel + 1", "continue",
            'printf "other = %f\\n", input->omega_rad_s',
            "info registers pc s0 fpscr", "backtrace", "delete", "detach"])
        code = run.finish()
    assert "wheel_loop_update (" in said and "reference_tick" in said, said
    before, after = numbers(said, r"\$1")[0], numbers(said, r"\$2")[0]
    assert after == 8.0 and abs(before) < 1.0, said
    changed, other = numbers(said, "changed")[0], numbers(said, "other")[0]
    assert changed > other + 20.0, said
    assert code in (0, 1), run.text


def a_session_with_halts_passes_the_same_checks():
    """Halting, stepping and watching change no result: every line of the report is that of a run without GDB."""
    need()
    plain = subprocess.run([os.environ["OMNIHIL_PROGRAM"], "scenario", "run", "wheel/speed_step", "--no-plots", "--all",
                            *FIRMWARE], capture_output=True, text=True, timeout=benches.DEADLINE_S, check=False)
    with Scenario("wheel/speed_step") as run:
        said = gdb(run.port, [
            "break wheel_loop_update", "continue", "watch -location loop->integral_V", "continue", "continue",
            "delete", "stepi", "stepi", "next", "finish", "step", "tbreak board_tick", "continue",
            "monitor registers TIM1", "x/4xw 0x40010000", "detach"])
        code = run.finish()
    assert "Hardware watchpoint" in said and "Old value" in said, said
    report = [line for line in run.text.splitlines() if not line.startswith("gdb: ")]
    assert report == plain.stdout.splitlines(), said + "\n".join(report)
    assert code == plain.returncode


def registers_and_memory_are_read_and_written():
    need()
    with Scenario("wheel/direction") as run:
        said = gdb(run.port, [
            "info registers sp pc xpsr msp control", "print/x *(unsigned *)0x08000004",
            "tbreak main", "continue", "set var $r7 = 0x1234", "print/x $r7",
            "set var $d7 = 2.5", "print $d7", "set var $s3 = 0.25", "print $s3",
            "set var {unsigned}0x20000400 = 0xCAFEBABE", "x/2xh 0x20000400", "x/xb 0x20000403",
            "print/x *(unsigned *)0x60000000", "print/x *(unsigned *)0x40023800", "detach"])
        run.finish()
    pc = int(re.search(r"pc +(0x[0-9a-f]+)", said).group(1), 16)
    assert int(re.search(r"\$1 = (0x[0-9a-f]+)", said).group(1), 16) == pc | 1, said  # the reset vector
    assert "$2 = 0x1234" in said and "$3 = 2.5" in said and "$4 = 0.25" in said, said
    assert "0xbabe\t0xcafe" in said and "0xca\n" in said, said
    assert "Cannot access memory at address 0x60000000" in said, said
    assert "$5 = 0x" in said, said  # RCC_CR


def reset_begins_anew():
    need()
    with Scenario("wheel/direction") as run:
        said = gdb(run.port, ["break board_tick", "continue", "continue", "monitor where", "monitor reset",
                              "maintenance flush register-cache", "info symbol $pc", "continue", "monitor where",
                              "monitor nonsense", "monitor help", "delete", "detach"])
        run.finish()
    assert said.count("Breakpoint 1, board_tick") == 3, said
    assert re.search(r"in section", said), said
    assert "allowed: reset" in said and "monitor registers" in said, said
    times = [float(t) for t in re.findall(r"board 0: ([\d.]+) s", said)]
    assert times[0] < times[1], said


def every_board_is_a_thread_and_all_stand():
    """Three robots: breakpoints halt each, their times stay within one coupling period; a step is of one alone."""
    need()
    arguments = ["--robots", "0-2", "--clock", "free", "--duration", "0.3", "--physics", "planar", *FIRMWARE, "--gdb",
                 "tcp:127.0.0.1:0"]
    with benches.Bench(arguments) as served:
        served.wait_for("wait at tcp:")
        said = gdb(PORT.search(served.text).group(1), [
            "info threads", "break board_tick", "continue", "continue", "continue", "continue",
            "monitor where", "thread 2", "monitor where", "thread 3", "monitor where", "info threads",
            "thread 2", "stepi", "detach"])
        report = served.finish()
    assert report.code == 0, report.text
    for robot in range(3):
        assert f'"robot {robot}"' in said, said
    times = [float(t) for t in re.findall(r"board 0: ([\d.]+) s", said)]
    assert len(times) == 3 and max(times) - min(times) <= 0.5e-3 + 1e-6, said


def time_stands_while_the_host_asks():
    """Real time, a host at the dongle: while GDB holds the board no simulated time goes by, afterwards it is answered."""
    need()
    import serial
    arguments = ["--robots", "5", "--duration", "1.5", "--physics", "planar", *FIRMWARE, "--gdb", "tcp:127.0.0.1:0"]
    with benches.Bench(arguments) as served:
        served.wait_for("wait at tcp:")
        with serial.Serial(served.device, 115200, timeout=benches.DEADLINE_S) as port:
            port.write(bytes([4, 1, 0xFE, 5, 2, 4, 0]))  # COBS of 01 FE 05 00 04: a ping to robot 5
            said = gdb(PORT.search(served.text).group(1), [
                "tbreak board_tick", "continue", "monitor where", "info registers", "x/8i $pc", "monitor where", "detach"])
            answer = port.read(7)
        report = served.finish()
    times = re.findall(r"board 0: ([\d.]+) s", said)
    assert len(times) == 2 and times[0] == times[1], said
    assert answer == bytes([3, 1, 5, 3, 1, 7, 0]), (answer, said)  # of 01 05 00 01 07
    assert report.code == 0, report.text


def a_fault_halts_where_it_happens():
    need()
    image = os.path.join(BUILD, "images", "faults.elf")
    board = os.path.join(SOURCE, "boards", "four_wheels_f405.toml")
    arguments = ["--robots", "0", "--clock", "free", "--duration", "0.1", "--physics", "planar", "--firmware", image,
                 "--board", board, "--gdb", "tcp:127.0.0.1:0"]
    with benches.Bench(arguments) as served:
        served.wait_for("wait at tcp:")
        said = gdb(PORT.search(served.text).group(1), [f"file {image}", "continue", "info symbol $pc", "kill"])
        report = served.finish()
    assert "SIGSEGV" in said and "read_nowhere" in said, said
    assert report.code == 6, report.text


def what_cannot_be_debugged_is_said():
    program = os.environ["OMNIHIL_PROGRAM"]
    folder = tempfile.mkdtemp(prefix="omnihil-gdb-")
    try:
        for words, answer in [
                (["serve", "--gdb", "0"], "needs --firmware IMAGE --board FILE"),
                (["serve", "--gdb", "nonsense:1"], "--gdb: "),
                (["serve", "--gdb-robot", "x", "--gdb", "0"], "--gdb-robot: found \"x\""),
                (["serve", "--gdb-run"], "need --gdb PORT"),
                (["scenario", "run", "wheel", "--gdb", "0"], "allowed: one at a time"),
                (["scenario", "run", "wheel/direction", "--gdb", "0"], "needs --firmware IMAGE --board FILE")]:
            done = subprocess.run([program, *words], cwd=folder, capture_output=True, text=True,
                                  timeout=benches.DEADLINE_S, check=False)
            assert done.returncode == 2 and answer in done.stderr, (words, done.returncode, done.stderr)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(benches.main({name: thing for name, thing in globals().items() if callable(thing)}))
