#!/usr/bin/env python3
"""./dev new KIND NAME: a new part with its test and its place in the documentation, from tools/templates/.

    ./dev new effect grease_film        ./dev new bus my_drives        ./dev new robot my_robot_2027

KIND: see KINDS below. NAME in lower_case: it names files, and the id that users type (a verb's, a bus's and a format's with
- for _). What is written builds and passes its own test at once; what is only an example in it says so. All or nothing: a
kind that is not there, a name that is taken or no name, and a page whose place for it is gone, are refused before
anything is written. Exit: 0, or 2 and what is wrong.
"""
import difflib
import os
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
TEMPLATES = ROOT / "tools/templates"
NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
LONGEST = 40  # a choice: ids stand in tables


class Refused(Exception):
    pass


def before(mark):
    """Inserts the text in front of the line that starts with `mark`."""
    def insert(page, text, _name):
        at = re.search("^" + re.escape(mark), page, re.M)
        if at is None:
            raise Refused(f'has no line that starts with "{mark}"')
        return page[:at.start()] + text + page[at.start():]
    return insert


def end_of_table(heading):
    """Appends rows to the table below `heading`."""
    def insert(page, text, _name):
        at = re.search(re.escape(heading) + r"\n+(\|.*\n)+", page)
        if at is None:
            raise Refused(f'has no table under "{heading}"')
        return page[:at.end()] + text + page[at.end():]
    return insert


def at_end(page, text, _name):
    return page + text


def in_chips(page, text, name):
    """In alphabetical order among the chips' paragraphs."""
    at = page.index("## Devices") if "## Devices" in page else None
    if at is None:
        raise Refused('has no "## Devices"')
    for found in re.finditer(r"^\*\*(\w+)\*\*.*\n\n", page, re.M):
        if found[1] > name:
            at = min(at, found.start())
    return page[:at] + text + page[at:]


# Kind: files by template, insertions (page, template, where), and what is left to do.
KINDS = {
    "effect": {
        "files": {"effect.cc.in": "sim/effects/@name@.cc", "effect_test.cc.in": "tests/sim/effects/@name@_test.cc"},
        "into": [("tests/sim/law/effect_ids_test.cc", '"@name@",\n', before('                                     "expression"'))],
        "then": ["its page and picture: ./dev build && ./dev exec effects --docs docs/effects",
                 "test_sim_effects, test_sim_law and test_sim_pages hold it to docs/effects/README.md"],
    },
    "format": {
        "files": {"format.cc.in": "protocols/teams/@name@.cc", "format_test.cc.in": "tests/protocols/dongles/@name@_test.cc"},
        "into": [("docs/radio/README.md", "format.md.in", end_of_table("# Radio formats")),
                 ("tests/protocols/golden/packets.jsonl", "format_golden.jsonl.in", at_end)],
        "then": ["its page and dissector: ./dev build, then ./dev exec formats @id@ > docs/radio/@id@.md and "
                 "./dev exec formats @id@ --wireshark > docs/radio/@id@.lua",
                 "test_protocols holds its packets to the bytes of tests/protocols/golden/packets.jsonl,"
                 " test_protocols_dongles runs the test of its dongle"],
    },
    "robot": {
        "files": {"robot.toml.in": "models/robots/@name@.toml", "robot_test.cc.in": "tests/sim/model/@name@_robot_test.cc"},
        "into": [("docs/model-files.md", "robot.md.in", end_of_table("## The models that come with the program"))],
        "then": ["./dev exec models @name@ prints what follows from its numbers"],
    },
    "motor": {
        "files": {"motor.toml.in": "models/motors/@name@.toml", "motor_test.cc.in": "tests/sim/model/@name@_motor_test.cc"},
        "into": [("docs/model-files.md", "motor.md.in", end_of_table("## The models that come with the program"))],
        "then": ["./dev exec models @name@ prints what follows from its numbers"],
    },
    "verb": {
        "files": {"verb.cc.in": "tools/verbs/@name@.cc", "verb_test.cc.in": "tests/tools/@name@_verb_test.cc",
                  "verb.md.in": "docs/@id@.md"},
        "into": [],
        "then": ["a line of README.md that leads to docs/@id@.md"],
    },
    "bus": {
        "files": {"bus.cc.in": "firmware_iface/motor_bus/buses/@name@.cc",
                  "bus_test.cc.in": "tests/firmware_iface/motor_bus/@name@_test.cc"},
        "into": [("docs/motor-buses.md", "bus.md.in", before("## What is tested"))],
        "then": ["test_firmware_iface_motor_bus sends it frames at random, too"],
    },
    "rig": {
        "files": {"rig.cc.in": "identify/rigs/@name@.cc", "rig_test.cc.in": "tests/identify/rigs/@name@_test.cc"},
        "into": [("docs/rigs.md", "rig.md.in", end_of_table("## The rigs that come with the program"))],
        "then": ["docs/rigs.md says what the table's words mean"],
    },
    "chip": {
        "files": {"chip.cc.in": "firmware_iface/mcu/stm32/chips/@name@.cc",
                  "chip_test.cc.in": "tests/firmware_iface/mcu/@name@_test.cc"},
        "into": [("docs/mcu-peripherals.md", "chip.md.in", in_chips)],
        "then": ["test_firmware_iface_mcu prints docs/mcu-peripherals.md as it should be when the chip's blocks change"],
    },
}


def filled(text, name):
    words = name.replace("_", " ")
    for mark, value in {"@name@": name, "@id@": name.replace("_", "-"), "@NAME@": name.upper(),
                        "@Name@": "".join(w.capitalize() for w in name.split("_")),
                        "@Words@": words[0].upper() + words[1:]}.items():
        text = text.replace(mark, value)
    return text


def template(name):
    return (TEMPLATES / name).read_text(encoding="utf-8")


def planned(kind, name, root):
    """{path: text} of all that is to be written."""
    plan = {}
    for source, target in KINDS[kind]["files"].items():
        path = root / filled(target, name)
        if path.exists():
            raise Refused(f"{path.relative_to(root)} is there already: choose another name")
        plan[path] = filled(template(source), name)
    for page, what, place in KINDS[kind]["into"]:
        path = root / page
        indent = 37 * " " if page.endswith("effect_ids_test.cc") else ""
        text = indent + filled(template(what) if what.endswith(".in") else what, name)
        try:
            plan[path] = place(path.read_text(encoding="utf-8"), text, name)
        except Refused as why:
            raise Refused(f"{page} {why}") from why
    return plan


def write(plan):
    """All beside their places first, then into them: a full disk leaves nothing half-written."""
    beside = {path: path.with_name(path.name + ".new") for path in plan}
    try:
        for path, text in plan.items():
            path.parent.mkdir(parents=True, exist_ok=True)
            beside[path].write_text(text, encoding="utf-8")
    except OSError:
        for new in beside.values():
            new.unlink(missing_ok=True)
        raise
    for path, new in beside.items():
        os.replace(new, path)


def checked(arguments):
    if len(arguments) != 2:
        raise Refused(f"write ./dev new KIND NAME; kinds: {', '.join(KINDS)}")
    kind, name = arguments
    if kind not in KINDS:
        near = difflib.get_close_matches(kind, KINDS, n=1)
        hint = f'did you mean "{near[0]}"? ' if near else ""
        raise Refused(f'there is no kind "{kind}"; {hint}kinds: {", ".join(KINDS)}')
    if not NAME.fullmatch(name) or len(name) > LONGEST:
        raise Refused(f'"{name}" is no name; allowed: small letters, digits and single _ between them, a letter first, '
                      f"up to {LONGEST}")
    return kind, name


def main(arguments):
    root = ROOT
    if arguments[:1] == ["--root"]:  # another tree, for the tests
        root, arguments = pathlib.Path(arguments[1]), arguments[2:]
    try:
        kind, name = checked(arguments)
        plan = planned(kind, name, root)
        write(plan)
    except (Refused, OSError) as why:
        print(f"new: {why}", file=sys.stderr)
        return 2
    for path in plan:
        print(path.relative_to(root))
    for line in KINDS[kind]["then"] + ["CHANGELOG.md, in one sentence"]:
        print("then:", filled(line, name))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
