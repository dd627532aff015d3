#!/usr/bin/env python3
"""Compiles the examples of the headers: a header's example is the body of a function, after all headers of its room.

    header_examples.py --flags FILE --out DIR ROOM...        (ROOM: sim, identify, ...; run from anywhere)

What an example takes as given (its `model`, its `t`) is named in given.toml: words of a whole room, parameters of one example.
In an example … stands for what is left out: `{.bits = 14, …}`, `.axis = …`, `if (late) …`. An error names the header and the line.
"""
import argparse
import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/docs"))
from header_comment import paragraphs, without_comment  # noqa: E402

GIVEN = Path(__file__).with_name("given.toml")
# An indented paragraph that is no C++ by form but calls something: an example whose statements do not end.
LOOKS_LIKE_CODE = re.compile(r"\b\w+(\.|->)\w+\(|\b\w+::\w|^\s*(for|if|while) \(|^\s*\w+\(.*\)\s*$")


def code_of(line):
    """A line of an example as a compiler takes it: without its comment, … left out."""
    parts = re.split(r'("(?:[^"\\]|\\.)*")', without_comment(line))
    for i in range(0, len(parts), 2):
        parts[i] = re.sub(r"=\s*…", "= {}", parts[i])
        parts[i] = re.sub(r",\s*…", "", parts[i])
        parts[i] = re.sub(r"([({])\s*…\s*([)}])", r"\1\2", parts[i])
        parts[i] = parts[i].replace("…", ";")
    return "".join(parts)


def namespace_of(text):
    found = re.search(r"^namespace ([\w:]+) \{", text, re.MULTILINE)
    return found.group(1) if found else "omnihil"


def example_of(path, text, given, number, at_namespace_scope=False):
    """One function, or what stands at namespace scope, or none where the header has no example."""
    code = [line for p in paragraphs(text) if p.kind == "code" for line in p.lines]
    if not code:
        return None
    out = [f"namespace {namespace_of(text)} {{"]
    if given and not at_namespace_scope:
        out.append(f'#line {given["line"]} "{given["file"]}"')
    if not at_namespace_scope:
        out.append(f"[[maybe_unused]] inline void header_example_{number}({given['text'] if given else ''}) {{")
    at = None
    for line_number, line in code:
        if at is None or line_number != at + 1:
            out.append(f'#line {line_number} "{path}"')
        out.append(code_of(line))
        at = line_number
    return "\n".join(out + ["}"] * (1 if at_namespace_scope else 2)) + "\n"


def looks_unfinished(path, text):
    for p in paragraphs(text):
        for number, line in p.lines if p.kind == "table" else []:
            if LOOKS_LIKE_CODE.search(without_comment(line)):
                yield f"{path}:{number}: error: indented like an example, but no statement ends: write it as C++"


def read_given(file=GIVEN):
    table = tomllib.loads(file.read_text(encoding="utf-8"))
    lines = file.read_text(encoding="utf-8").split("\n")
    given = {}
    for path, text in table.get("given", {}).items():
        line = next(n for n, l in enumerate(lines, 1) if l.startswith(f'"{path}"'))
        given[path] = {"text": text, "line": line, "file": file.relative_to(ROOT) if file.is_relative_to(ROOT) else file}
    return table, given


def names_of(table, room):
    """The words of a room, declared where every name of the code itself hides them."""
    names = [item for of in ("all", room) for item in table.get("names", {}).get(of, {}).items()]
    declared = [f"extern {kind} {name};\n" for kind, words in names for name in words.split()]
    return "using namespace omnihil;\nnamespace header_example_names {\n" + "".join(declared) + (
        "}\nusing namespace header_example_names;\n\n")


def unit_of(room, headers, table, given):
    """The text of the translation unit of a room, and what is wrong before any compiler is asked."""
    faults, functions = [], []
    not_compiled, not_included = tuple(table.get("not_compiled", {})), tuple(table.get("not_included", {}))
    texts = {path: (ROOT / path).read_text(encoding="utf-8") for path in headers if not path.startswith(not_included)}
    for number, (path, text) in enumerate(texts.items()):
        if path.startswith(not_compiled):
            continue
        faults += looks_unfinished(path, text)
        function = example_of(path, text, given.get(path), number, path in table.get("namespace_scope", []))
        if function:
            functions.append(function)
        elif path in given:
            faults.append(f"{given[path]['file']}:{given[path]['line']}: error: {path} has no example")
    includes = table.get("also_include", {}).get(room, []) + list(texts)
    unit = "".join(f'#include "{path}"\n' for path in includes) + names_of(table, room) + "\n".join(functions)
    return unit, faults, len(functions)


def headers_of(room):
    return sorted(str(p.relative_to(ROOT)) for p in (ROOT / room).rglob("*.h"))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--flags", required=True, help="file with the compiler and its flags, as a shell would read them")
    parser.add_argument("--out", required=True, type=Path)
    parser.add_argument("rooms", nargs="+")
    args = parser.parse_args()
    table, given = read_given()
    bad = False
    for path in [*given, *table.get("not_compiled", {}), *table.get("not_included", {})]:
        if not any((ROOT / path).parent.glob(Path(path).name + "*")):
            print(f"{GIVEN.relative_to(ROOT)}: error: there is no {path}")
            bad = True
    args.out.mkdir(parents=True, exist_ok=True)
    for room in args.rooms:
        text, faults, count = unit_of(room, headers_of(room), table, given)
        unit = args.out / f"{room.replace('/', '_')}_examples.cc"
        unit.write_text(text, encoding="utf-8")
        command = shlex.split(Path(args.flags).read_text(encoding="utf-8"))
        result = subprocess.run([*command, "-c", str(unit), "-o", str(unit.with_suffix(".o"))], cwd=ROOT)
        for fault in faults:
            print(fault)
        bad = bad or result.returncode != 0 or bool(faults) or count == 0
        print(f"{room}: {count} examples")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
