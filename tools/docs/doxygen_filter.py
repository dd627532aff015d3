"""A header as Doxygen wants it: the plain comments that stand before a declaration or behind a member become documentation.

    for_doxygen(text, "sim/drive/encoder.h")      the same lines, marked
    page_for_doxygen(text, pages)                 a page in Markdown, without links to what the reference does not have

The comment at the head documents the file, with its example as code; indented lines keep their form. Comments within functions are
left alone.
"""
import re

from header_comment import head_lines, paragraphs

INDENT = re.compile(r"^ {2,}")
COMMANDS = re.compile(r"([\\@<>&#$%])")
ENTITIES = {"<": "&lt;", ">": "&gt;", "&": "&amp;"}
FULL_LINE = re.compile(r"^(\s*)//(?!/)(.*)$")


def escaped(text):
    """Words of a comment, none of which is a command, a tag or a link; `this` is code."""
    text = COMMANDS.sub(r"\\\1", text)
    text = re.sub(r"`([^`]+)`", lambda m: "<code>" + m.group(1) + "</code>", text)
    return text.replace("`", "'")


def documented(lines):
    """Lines of one comment without marks -> their text as documentation; runs of indented lines as they stand."""
    out = []
    for i, line in enumerate(lines):
        kept = bool(INDENT.match(line))
        before = i > 0 and bool(INDENT.match(lines[i - 1]))
        after = i + 1 < len(lines) and bool(INDENT.match(lines[i + 1]))
        if not kept:
            out.append(" " + escaped(line.strip()) if line.strip() else "")
            continue
        text = "" if before else "<pre>"
        text += re.sub(r"^( *)- ", r"\1&ndash; ", COMMANDS.sub(lambda m: ENTITIES.get(m[1], "\\" + m[1]), line.rstrip()))
        out.append(" " + text + ("" if after else "</pre>"))
    return out


def head(text, shown):
    """The head comment's lines as documentation of the file, by number."""
    numbered = head_lines(text)
    out = dict(zip([n for n, _ in numbered], documented([line for _, line in numbered])))
    for p in paragraphs(text):
        if p.kind != "code":
            continue
        first, last = p.lines[0][0], p.lines[-1][0]
        for n, line in p.lines:
            out[n] = line
        out[first - 1] = " @code{.cpp}"
        out[last] += " @endcode"
    first = numbered[0][0]
    out[first] = f" @file {shown}" + out[first]
    return {n: "///" + line for n, line in out.items()}


class Scopes:
    """Which kind of braces a place stands within: names, members and enumerators, or the inside of functions."""

    def __init__(self):
        self.stack, self.text, self.round = [], "", 0

    def within_function(self):
        return any(kind in ("body", "value") for kind in self.stack) or self.round > 0

    def feed(self, code):
        for c in code:
            if c == "{":
                self.stack.append(self.kind())
                self.text = ""
            elif c == "}":
                if self.stack:
                    self.stack.pop()
                self.text = ""
            elif c == ";":
                self.text = "" if self.round == 0 else self.text
            else:
                self.round += {"(": 1, ")": -1}.get(c, 0)
                self.text += c
        self.text += " "

    def kind(self):
        text = re.sub(r"template\s*<[^{;]*?>\s*(?=\b(?:class|struct|union|enum|requires|[\w:\[]))", " ", self.text)
        if re.search(r'\bnamespace\b|extern\s+"S"', text):
            return "names"
        if self.round > 0:
            return "value"
        if re.search(r"\b(class|struct|union|enum)\b", text) and "(" not in re.sub(r"\[\[.*?\]\]|alignas\([^)]*\)", "", text):
            return "members"
        return "body" if ")" in text or "(" in text else "value"


def code_and_comment(line):
    """(code with strings and inner comments blanked, column of // or /* or None, the mark)"""
    blank = re.sub(r'"(?:[^"\\]|\\.)*"', lambda m: '"' + "S" * (len(m[0]) - 2) + '"', line)
    blank = re.sub(r"'(?:[^'\\]|\\.)'", lambda m: "'" + " " * (len(m[0]) - 2) + "'", blank)
    blank = re.sub(r"/\*.*?\*/(?=\s*[^\s/])", lambda m: " " * len(m[0]), blank)  # within the code
    found = re.search(r"//|/\*", blank)
    if not found:
        return blank, None, ""
    return blank[:found.start()], found.start(), found.group()


def declares(line):
    """Does a comment above this line document what begins there?"""
    text = line.strip()
    return bool(text) and not text.startswith(("#", "}", "//", "/*", "public:", "private:", "protected:", "using namespace", "namespace ",
                                               "extern \"C\"", "static_assert", "friend "))


def for_doxygen(text, shown):
    lines = text.split("\n")
    out = list(lines)
    of_head = head(text, shown)
    for n, line in of_head.items():
        out[n - 1] = line
    scopes, at, in_block, aligned = Scopes(), len(of_head), False, None
    while at < len(lines):
        line = lines[at]
        if in_block:  # a /* */ of several lines: as it is, its first line was marked
            in_block = "*/" not in line
            at += 1
            continue
        run = at
        while run < len(lines) and FULL_LINE.match(lines[run]):
            run += 1
        if run > at:
            column = len(FULL_LINE.match(line).group(1))
            if aligned is not None and column == aligned:  # goes on behind the member above
                for i in range(at, run):
                    out[i] = lines[i][:column] + "///<" + "".join(documented([lines[i][column + 2:].strip()]))
            elif run < len(lines) and declares(lines[run]) and not scopes.within_function():
                for i, words in zip(range(at, run), documented([FULL_LINE.match(l).group(2) for l in lines[at:run]])):
                    out[i] = lines[i][:column] + "///" + words
            at, aligned = run, None
            continue
        code, column, mark = code_and_comment(line)
        outside = not scopes.within_function()
        scopes.feed(code if not code.lstrip().startswith("#") else "")
        if mark == "/*":
            in_block = "*/" not in line[column:]
        member = outside and not scopes.within_function() and re.search(r"[;,)\w}]\s*$", code) and code.strip() not in ("}", "};")
        if column is not None and not code.lstrip().startswith("#"):
            if code.strip() and member and mark == "//" and not re.search(r"(^|\s)(public|private|protected):\s*$", code):
                out[at] = line[:column] + "///<" + "".join(documented([line[column + 2:].strip()]))
                aligned = column
            elif code.strip() and member and mark == "/*":
                out[at] = line[:column] + "/**<" + block_text(line[column + 2:])
            elif not code.strip() and mark == "/*" and outside:
                end = next((i for i in range(at, len(lines)) if "*/" in lines[i]), at)
                if end + 1 < len(lines) and declares(lines[end + 1]):
                    out[at] = line[:column] + "/**" + block_text(line[column + 2:])
                    for i in range(at + 1, end + 1):
                        out[i] = block_text(lines[i])
        if column is None or not code.strip():
            aligned = None
        at += 1
    return "\n".join(out)


def block_text(text):
    words, end = (text.split("*/", 1) + [None])[:2]
    return escaped(words) + ("" if end is None else "*/" + end)


def page_for_doxygen(text, pages):
    def link(match):
        words, target = match.groups()
        inside = target.split("#")[0]
        return match.group() if target.startswith("http") or inside in pages else words

    return re.sub(r"(?<!!)\[([^\]]+)\]\(([^)]+)\)", link, text)
