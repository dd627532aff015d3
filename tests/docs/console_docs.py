#!/usr/bin/env python3
"""Runs the commands of a page and compares what they print with what the page shows.

    console_docs.py --check PROGRAM PAGE [FILE…]     exit 1 and a list when the page is not what the program says today
    console_docs.py --write PROGRAM PAGE [FILE…]     puts today's output into the page

A block fenced with ```console holds lines `$ omnihil …` and below each what it prints. All blocks of a page run in order in
one folder that holds nothing but the FILEs. Words have to be the same; numbers may differ by 3 %, or by two units of the last digit that is shown; below 1e-9 all are 0.
"""
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?!\w)")
FENCE = re.compile(r"(```console\n)(.*?)(```)", re.S)


def run(command, program, folder):
    line = re.sub(r"^omnihil\b", shlex.quote(program), command)
    done = subprocess.run(line, shell=True, cwd=folder, capture_output=True, text=True, check=False)
    return "".join(line.rstrip() + "\n" for line in (done.stdout + done.stderr).replace(program, "omnihil").splitlines())


def commands_of(block):
    """(command, shown output) of each `$` line."""
    parts = re.split(r"^\$ (.*)\n", block, flags=re.M)
    return list(zip(parts[1::2], parts[2::2]))


def alike(shown, said):
    if NUMBER.sub("#", shown).split() != NUMBER.sub("#", said).split():
        return False
    for a, b in zip(NUMBER.findall(shown), NUMBER.findall(said)):
        mantissa, _, exponent = a.partition("e")
        last = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
        if abs(float(a) - float(b)) > max(0.03 * abs(float(a)), 2.001 * last, 1e-9):
            return False
    return True


def differences(shown, said):
    a, b = shown.splitlines(), said.splitlines()
    for i in range(max(len(a), len(b))):
        x, y = a[i] if i < len(a) else "(nothing)", b[i] if i < len(b) else "(nothing)"
        if not alike(x, y):
            yield f"  page:    {x}\n  program: {y}"


def main():
    if len(sys.argv) < 4 or sys.argv[1] not in ("--check", "--write"):
        print(__doc__)
        return 2
    program, page = str(pathlib.Path(sys.argv[2]).resolve()), pathlib.Path(sys.argv[3])
    text, bad, count = page.read_text(encoding="utf-8"), [], 0
    with tempfile.TemporaryDirectory() as folder:
        for file in map(pathlib.Path, sys.argv[4:]):
            (pathlib.Path(folder) / file.name).symlink_to(file.resolve())
        def block(match):
            nonlocal count
            out = ""
            for command, shown in commands_of(match[2]):
                said = run(command, program, folder)
                found = list(differences(shown.rstrip("\n"), said.rstrip("\n")))
                bad.extend([f"$ {command}", *found] if found else [])
                out += f"$ {command}\n{said}"
                count += 1
            return match[1] + out + match[3]
        today = FENCE.sub(block, text)
    if sys.argv[1] == "--write":
        page.write_text(today, encoding="utf-8")
        return 0
    if count == 0:
        bad.append(f"{page} has no command")
    if bad:
        print("\n".join(bad), f"\nAfter reading what changed: {sys.argv[0]} --write {sys.argv[2]} {page}", sep="")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
