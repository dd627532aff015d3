"""Wireshark's own tshark captures a running bench through its extcap interface. Run by script_test.cc."""
import os
import select
import shutil
import subprocess
import time

import serial

import hermes
from bench import Bench, DEADLINE_S, Skip, main

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
SCRIPT = SOURCE + "/examples/wireshark/omnihil-extcap"


NOBODY = 65534


def wireshark(bench):
    """How to start one of Wireshark's programs: it finds the script where its folder is said to be, and the script the program.
    For root it takes no other folder, so it runs as somebody else then."""
    shutil.copy(SCRIPT, bench.folder)
    env = dict(os.environ, HOME=bench.folder, WIRESHARK_EXTCAP_DIR=bench.folder, OMNIHIL=os.environ["OMNIHIL_PROGRAM"])
    if os.getuid() != 0:
        return {"env": env}
    os.chmod(bench.folder, 0o777)
    os.chmod(bench.path("capture"), 0o666)
    return {"env": env, "user": NOBODY, "group": NOBODY, "extra_groups": []}


def asked(*words):
    done = subprocess.run([SCRIPT, *words], capture_output=True, text=True,
                          env=dict(os.environ, OMNIHIL=os.environ["OMNIHIL_PROGRAM"]))
    return done.returncode, done.stdout, done.stderr


def answers_what_wireshark_asks():
    code, out, _ = asked("--extcap-interfaces", "--extcap-version=4.0")
    assert code == 0 and "interface {value=omnihil}" in out, out
    code, out, _ = asked("--extcap-interface", "omnihil", "--extcap-dlts")
    assert code == 0 and "{number=147}" in out, out
    code, out, _ = asked("--extcap-interface", "omnihil", "--extcap-config")
    assert code == 0 and "{call=--socket}" in out, out
    code, _, err = asked("--extcap-interface", "eth0", "--extcap-dlts")
    assert code == 2 and "eth0" in err, err
    code, _, err = asked("--extcap-interface", "omnihil", "--capture")
    assert code == 2 and "--fifo" in err, err
    code, _, err = asked("--capture", "--fifo", "/nowhere/pipe", "--extcap-interface", "omnihil")
    assert code == 3 and "/nowhere/pipe" in err, err


def tshark_shows_the_values_that_pass_a_running_bench():
    if not shutil.which("tshark"):
        raise Skip("tshark is not installed")
    with Bench(["--robots", "2,3", "--capture", "{folder}/capture", "--physics", "planar"]) as bench:
        start = wireshark(bench)
        listed = subprocess.run(["tshark", "-D"], capture_output=True, text=True, **start).stdout
        assert "omnihil" in listed, listed
        # -c: ends by itself, so that nothing has to be stopped; the host goes on until then.
        fields = ["ulaval_hermes.SPEED_MOVE.robot", "ulaval_hermes.SPEED_MOVE.vx", "ulaval_hermes.SPEED_MOVE.vtheta",
                  "ulaval_hermes.BATTERIE_RESPONSE.robot", "ulaval_hermes.BATTERIE_RESPONSE.decivolts"]
        tshark = subprocess.Popen(
            ["tshark", "-i", "omnihil", "-o", f"extcap.omnihil.socket:{bench.path('capture')}", "-l", "-c", "60",
             "-X", f"lua_script:{SOURCE}/docs/radio/ulaval-hermes.lua", "-T", "fields", "-E", "separator=,",
             *sum((["-e", field] for field in fields), [])],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **start)
        try:
            port = serial.Serial(bench.device, 115200, timeout=0)
            end_s = time.monotonic() + DEADLINE_S
            move = hermes.speed_move(3, 0.5, 0.0, -1.25)
            ask = hermes.packet(2, hermes.GET_BATTERIE)
            while tshark.poll() is None:
                assert time.monotonic() < end_s, "tshark has seen no 60 packets"
                port.write(move + ask)
                port.read(4096)
                select.select([], [], [], 0.02)  # the rhythm of a host, not a wait for something
            out, err = tshark.communicate()
        finally:
            tshark.kill()
        assert tshark.returncode == 0, err
        rows = [line.split(",") for line in out.splitlines()]
        moves = [row for row in rows if row[0]]
        answers = [row for row in rows if row[3]]
        assert len(rows) == 60 and len(moves) >= 10 and len(answers) >= 10, out
        assert all(row[0] == "3" and float(row[1]) == 0.5 and float(row[2]) == -1.25 for row in moves), out
        assert all(row[3] == "2" and 100 < int(row[4]) < 300 for row in answers), out
        report = bench.stop()
        assert report.code == 0 and report.refused == 0, report.text
        assert not os.path.exists(bench.path("capture")), "the socket is removed"


if __name__ == "__main__":
    raise SystemExit(main({test.__name__: test for test in (answers_what_wireshark_asks,
                                                            tshark_shows_the_values_that_pass_a_running_bench)}))
