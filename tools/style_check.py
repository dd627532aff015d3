#!/usr/bin/env python3
"""The rules of STYLE.md that a program can hold: file length, line length, a word at each header's head, marks of unfinished
work.

Prints file:line: rule for each breach; exit 1 when there is one.
"""
import re
import subprocess
import sys

MAX_LINES = {"tests/": 600, "": 500}
MAX_COLUMNS = 135  # the formatter holds code to 110; a table in a comment may be wider
C_LIKE = (".cc", ".h", ".c", ".inc")
CODE = (".cc", ".h", ".c", ".inc", ".py")
FORBIDDEN = [
    (re.compile(r"\b(TODO|FIXME|XXX)\b"), "unfinished mark"),
    (re.compile(r"\b(EXPECT|ASSERT)_TRUE\(true\)|\bSUCCEED\(\)|DISABLED_|GTEST_SKIP\(\);"), "test that cannot fail"),
    (re.compile(r"#\s*include\s*<(Sim(body|TKcommon)|SimTK)"), "Simbody header outside sim/robot/chassis and sim/full_wheel/full_wheel_robot"),
    (re.compile(r"-ffast-math"), "fast-math changes results between machines"),
]
PURE = ("sim/", "identify/", "protocols/", "firmware_iface/")
IMPURE = re.compile(r"#\s*include\s*<(chrono|fstream|random|ctime|filesystem|sys/socket\.h|unistd\.h|termios\.h)>")


def limit_of(path):
    return next(n for prefix, n in MAX_LINES.items() if path.startswith(prefix))


def breaches(path, lines):
    if len(lines) > limit_of(path):
        yield len(lines), f"{len(lines)} lines, at most {limit_of(path)}: one idea per file"
    if path.endswith((".h", ".inc")) and not lines[0].startswith(("// ", "/* ")):
        yield 1, "a header opens with what it is"
    for number, line in enumerate(lines, 1):
        if path.endswith(C_LIKE) and len(line) > MAX_COLUMNS:
            yield number, f"{len(line)} columns, at most {MAX_COLUMNS}"
        for pattern, rule in FORBIDDEN:
            if pattern.search(line) and not path.endswith("style_check.py"):
                if rule.startswith("Simbody") and path.startswith(("sim/robot/chassis", "sim/full_wheel/full_wheel_robot.cc")):
                    continue
                yield number, rule
        if path.startswith(PURE) and not path.endswith("_main.cc") and IMPURE.search(line):
            yield number, "pure code: no clock, file, socket or randomness of its own"


def main():
    files = subprocess.run(["git", "ls-files"], capture_output=True, text=True, check=True).stdout.split("\n")
    count = 0
    for path in (f for f in files if f.endswith(CODE)):
        with open(path, encoding="utf-8") as file:
            for number, rule in breaches(path, file.read().split("\n")[:-1]):
                print(f"{path}:{number}: {rule}")
                count += 1
    print(f"{count} breaches of style")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
