"""GDB goes back in time at the emulated boards of `omnihil scenario run`: each test is a function."""
import os
import re
import subprocess
import sys

sys.path.insert(0, os.path.dirname(__file__))
from gdb_client import FIRMWARE, Scenario, benches, gdb, need  # noqa: E402

# All that a step may change: core registers, an FPU register, flags, a word of the stack.
PLACE = ('printf "at' + " %08x" * 18 + '\\n", ' + ", ".join(f"$r{i}" for i in range(13))
         + ", $sp, $lr, $pc, $xpsr, *(unsigned *)$sp")
STEPS = 40


def places(said):
    return re.findall(r"^at ([0-9a-f ]+)$", said, re.MULTILINE)


def steps_back_show_the_same_states_and_forward_too():
    """So many steps forward, back and forward again, through floating point, stores and calls: the same registers at each."""
    need()
    with Scenario("wheel/speed_step") as run:
        commands = ["break wheel_loop_update", "ignore 1 30", "continue", PLACE]
        commands += ["stepi", PLACE] * STEPS + ["reverse-stepi", PLACE] * STEPS + ["stepi", PLACE] * STEPS
        said = gdb(run.port, [*commands, "stepi", "monitor where", "delete", "detach"])
        run.finish()
    seen = places(said)
    assert len(seen) == 3 * STEPS + 1, said
    forward, back, again = seen[:STEPS + 1], seen[STEPS + 1:2 * STEPS + 1], seen[2 * STEPS + 1:]
    assert len(set(forward)) == STEPS + 1, said
    assert back == forward[-2::-1], said
    assert again == forward[1:], said


def what_was_looked_at_in_the_past_changes_nothing():
    """Every line of the report is that of a run without GDB."""
    need()
    plain = subprocess.run([os.environ["OMNIHIL_PROGRAM"], "scenario", "run", "wheel/speed_step", "--no-plots", "--all",
                            *FIRMWARE], capture_output=True, text=True, timeout=benches.DEADLINE_S, check=False)
    with Scenario("wheel/speed_step") as run:
        said = gdb(run.port, [
            "break wheel_loop_update", "ignore 1 30", "continue", "reverse-continue", "reverse-stepi", "reverse-stepi",
            "set var $r0 = 1", "set var *(int *)$sp = 1", "stepi", "continue", "continue", "continue",
            "delete", "detach"])
        code = run.finish()
    report = [line for line in run.text.splitlines() if not line.startswith("gdb: ")]
    assert report == plain.stdout.splitlines(), said + "\n".join(report)
    assert code == plain.returncode
    assert said.count("Could not write register") == 1 and "Cannot access memory" in said, said


def reverse_continue_finds_the_breakpoints_before():
    """Four wheels are updated in each period: back from the third of one period to the fourth of the one before, and forward."""
    need()
    where = 'printf "wheel %u\\n", (unsigned)loop'
    with Scenario("wheel/speed_step") as run:
        said = gdb(run.port, ["break wheel_loop_update", "ignore 1 30", "continue", where]
                   + ["continue", where] * 5 + ["reverse-continue", where] * 5 + ["continue", where] * 5
                   + ["reverse-continue"] * 40 + ["monitor where", "delete", "continue", "monitor where", "detach"])
        run.finish()
    wheels = [int(text) for text in re.findall(r"^wheel (\d+)$", said, re.MULTILINE)]
    assert len(wheels) == 16 and len(set(wheels)) == 4, said
    assert wheels[6:11] == wheels[4::-1], said
    assert wheels[11:] == wheels[1:6], said
    assert said.count("No more reverse-execution history.") >= 2, said  # at the oldest state, and back in the present
    then, now = [float(text) for text in re.findall(r"board 0: ([\d.]+) s", said)]
    assert then < now, said


def a_watchpoint_is_gone_back_to_before_its_write():
    need()
    value = 'printf "integral %.9g\\n", $wheel->integral_V'
    with Scenario("wheel/speed_step") as run:
        said = gdb(run.port, [
            "break wheel_loop_update", "ignore 1 300", "continue", "set $wheel = loop", value, "finish", value,
            "watch -location $wheel->integral_V", "reverse-continue", value, "stepi", value, "delete", "detach"])
        run.finish()
    before, after, back, again = re.findall(r"^integral (\S+)$", said, re.MULTILINE)
    assert before == back and after == again and before != after, said


def without_a_past_it_is_said():
    need()
    with Scenario("wheel/direction") as run:
        said = gdb(run.port, ["reverse-stepi", "monitor reverse off", "break wheel_loop_update", "ignore 1 30",
                              "continue", "reverse-stepi", "delete", "detach"])
        run.finish()
    assert said.count("No more reverse-execution history.") == 2, said


if __name__ == "__main__":
    sys.exit(benches.main({name: thing for name, thing in globals().items() if callable(thing)}))
