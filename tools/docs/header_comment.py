"""The comment at a header's head: its paragraphs, and which of them are C++.

    for paragraph in paragraphs(text):
        paragraph.kind            # "prose", "code" or "table"
        paragraph.lines           # [(number of the line in the file, text without the comment's marks)]

A paragraph all of whose lines are indented by three columns or more stands by itself. It is C++ where one of its lines ends, but for
a comment, in ; { } or `) …`, unless it begins as TOML does ([section]), as a shell's line does ($ command) or as JSON does ({"key"). Whatever
else is indented so (a table, the bytes of a packet) is a table and kept as written.
"""
import re
from dataclasses import dataclass

INDENT = "   "
STATEMENT_ENDS = (";", "{", "}", ") …")
NOT_CPP = re.compile(r"\s*(\[[\w.]+\]$|\$ |\{\")")  # a TOML section, a shell's line, JSON


@dataclass
class Paragraph:
    kind: str
    lines: list


def without_comment(line):
    """A line of C++ without its trailing // comment; strings are left alone."""
    in_string = False
    for at, c in enumerate(line):
        if c == '"' and (at == 0 or line[at - 1] != "\\"):
            in_string = not in_string
        if not in_string and line.startswith("//", at):
            return line[:at].rstrip()
    return line.rstrip()


def head_lines(text):
    """The lines of the first comment, without its marks: [(number, text)]; of // lines, or of one /* */."""
    lines = text.split("\n")
    block = lines[0].startswith("/*")
    head = []
    for number, line in enumerate(lines, 1):
        if block:
            ends = "*/" in line
            body = re.sub(r"^\s?(/\*+|\*+(?!/))", "", line)
            body = re.sub(r"\s*\*+/.*", "", body)
            head.append((number, body))
            if ends:
                break
        elif line.startswith("//"):
            head.append((number, line[2:]))
        else:
            break
    return head


def kind_of(lines):
    if not all(line.startswith(INDENT) for _, line in lines):
        return "prose"
    if NOT_CPP.match(lines[0][1]):
        return "table"
    return "code" if any(without_comment(line).endswith(STATEMENT_ENDS) for _, line in lines) else "table"


def paragraphs(text):
    found, lines = [], []
    for number, line in head_lines(text) + [(0, "")]:
        if line.strip():
            lines.append((number, line.rstrip()))
        elif lines:
            found.append(Paragraph(kind_of(lines), lines))
            lines = []
    return found
