#!/usr/bin/env python3
"""Holds the includes to the table of rooms (tools/rooms.toml) and draws the house from them.

    tools/rooms.py            every breach as file:line: rule; exit 1 when there is one
    tools/rooms.py --write    and writes docs/img/rooms.svg and the table of rooms in docs/architecture.md
    tools/rooms.py --check    and exits 1 when either is not of today
"""
import pathlib
import re
import subprocess
import sys
import tomllib
from collections import Counter, defaultdict
from html import escape

ROOT = pathlib.Path(__file__).resolve().parent.parent
PICTURE, PAGE = ROOT / "docs/img/rooms.svg", ROOT / "docs/architecture.md"
CODE = (".cc", ".h", ".c", ".inc")
INCLUDE = re.compile(r'\s*#\s*include\s*"([^"]+)"')
MOST_FILES = 50  # of one folder: what a reader still takes in as a list
# A file per effect, looked up by its name as in a dictionary: the next effect is no reason for a wall.
CATALOGUES = ("sim/effects", "tests/sim/effects", "docs/effects", "docs/effects/img")
BEGIN, END = "<!-- rooms: written by tools/rooms.py -->", "<!-- end of rooms -->"


def room_of(path, rooms):
    """The room of a file or an include: its longest listed folder; None where it is in none (a generated file)."""
    parts = path.split("/")
    return next((r for r in ("/".join(parts[:n]) for n in range(len(parts) - 1, 0, -1)) if r in rooms), None)


def includes(files, rooms):
    """(file, line, room, included room) of every include that leaves its room."""
    for file in files:
        here = room_of(file, rooms)
        if here is None or not file.endswith(CODE):
            continue
        for number, line in enumerate((ROOT / file).read_text(encoding="utf-8").split("\n"), 1):
            match = INCLUDE.match(line)
            there = room_of(match.group(1), rooms) if match else None
            if there not in (None, here):
                yield file, number, here, there


def floors(uses):
    """The length of the longest way down from each room; a circle is a ValueError that names it."""
    height, way = {}, []

    def climb(room):
        if room in way:
            raise ValueError("circle of rooms: " + " -> ".join(way[way.index(room):] + [room]))
        if room not in height:
            way.append(room)
            height[room] = 1 + max((climb(r) for r in uses[room]), default=-1)
            way.pop()
        return height[room]

    for room in uses:
        climb(room)
    return height


def breaches(files, rooms):
    uses = {name: set(room["uses"]) for name, room in rooms.items()}
    seen = defaultdict(set)
    for file, line, here, there in includes(files, rooms):
        seen[here].add(there)
        if there not in uses[here]:
            yield f"{file}:{line}: {here} may not include {there} (tools/rooms.toml)"
    for name in uses:
        for unused in sorted(uses[name] - seen[name]):
            yield f"tools/rooms.toml: {name} lists {unused} and does not include it"
    tops = {r.split("/")[0] for r in rooms}
    for file in files:
        if file.endswith(CODE) and file.split("/")[0] in tops and room_of(file, rooms) is None:
            yield f"{file}:1: stands in no room of tools/rooms.toml"
    for folder, count in Counter(f.rpartition("/")[0] for f in files if f.endswith((*CODE, ".py", ".md", ".svg"))).items():
        if count > MOST_FILES and folder not in CATALOGUES:
            yield f"{folder}: {count} files, at most {MOST_FILES}: a room without walls"
    try:
        floors(uses)
    except ValueError as circle:
        yield f"tools/rooms.toml: {circle}"


# --- the picture -----------------------------------------------------------------------------------------

BOX_WIDTH, BOX_HEIGHT, GAP_X, GAP_Y, MARGIN = 132, 32, 20, 46, 20
FILL = {"sim": "#dcebd5", "identify": "#d7e3f4", "hil": "#f6e3cd", "tools": "#eadcf0"}


def direct(uses):
    """The arrows that no way over another room replaces."""
    below = {}

    def all_below(room):
        if room not in below:
            below[room] = set(uses[room]).union(*(all_below(r) for r in uses[room])) if uses[room] else set()
        return below[room]

    for room in uses:
        for there in sorted(uses[room]):
            if not any(there in all_below(other) for other in uses[room] if other != there):
                yield room, there


def picture(rooms):
    uses = {name: room["uses"] for name, room in rooms.items()}
    height = floors(uses)
    rows = defaultdict(list)
    for name in rooms:
        rows[height[name]].append(name)
    widest = max(len(row) for row in rows.values())
    width = 2 * MARGIN + widest * BOX_WIDTH + (widest - 1) * GAP_X
    top = max(rows)
    place = {}
    for level, row in rows.items():
        row_width = len(row) * BOX_WIDTH + (len(row) - 1) * GAP_X
        for i, name in enumerate(row):
            place[name] = ((width - row_width) / 2 + i * (BOX_WIDTH + GAP_X), MARGIN + (top - level) * (BOX_HEIGHT + GAP_Y))
    total = 2 * MARGIN + (top + 1) * BOX_HEIGHT + top * GAP_Y
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {total:g}" font-family="sans-serif" font-size="12">',
           '<title>The rooms and what they include</title>',
           '<defs><marker id="head" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="7" markerHeight="7" orient="auto">'
           '<path d="M0,0 L8,4 L0,8 z" fill="#777"/></marker></defs>',
           f'<rect width="{width:g}" height="{total:g}" fill="#ffffff"/>']
    for here, there in direct(uses):
        x1, y1 = place[here][0] + BOX_WIDTH / 2, place[here][1] + BOX_HEIGHT
        x2, y2 = place[there][0] + BOX_WIDTH / 2, place[there][1]
        bend = (y2 - y1) / 2
        out.append(f'<path d="M{x1:g},{y1:g} C{x1:g},{y1 + bend:g} {x2:g},{y2 - bend:g} {x2:g},{y2:g}" fill="none" '
                   'stroke="#777" stroke-width="1.2" marker-end="url(#head)"/>')
    for name, (x, y) in place.items():
        fill = FILL.get(name.split("/")[0], "#eeeeee")
        out.append(f'<rect x="{x:g}" y="{y:g}" width="{BOX_WIDTH}" height="{BOX_HEIGHT}" rx="5" fill="{fill}" stroke="#555"/>'
                   f'<text x="{x + BOX_WIDTH / 2:g}" y="{y + 20:g}" text-anchor="middle" font-weight="bold">{escape(name)}</text>')
    return "\n".join(out) + "\n</svg>\n"


def table(rooms):
    rows = ["| room | what it is for |", "|---|---|"]
    rows += [f"| `{name}` | {room['says']} |" for name, room in rooms.items()]
    return "\n".join([BEGIN, *rows, END])


def with_table(page, rooms):
    return re.sub(re.escape(BEGIN) + ".*?" + re.escape(END), lambda _: table(rooms), page, flags=re.S)


def main(words):
    rooms = tomllib.loads((ROOT / "tools/rooms.toml").read_text(encoding="utf-8"))
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\n")
    files = [f for f in listed if f and (ROOT / f).is_file()]
    found = list(breaches(files, rooms))
    if not any("circle" in f for f in found) and words:
        wanted = {PICTURE: picture(rooms), PAGE: with_table(PAGE.read_text(encoding="utf-8"), rooms)}
        for path, text in wanted.items():
            if path.exists() and path.read_text(encoding="utf-8") == text:
                continue
            if "--write" in words:
                path.write_text(text, encoding="utf-8")
            else:
                found.append(f"{path.relative_to(ROOT)}: is not of today: tools/rooms.py --write")
    print("\n".join(found + [f"{len(found)} breaches of the rooms"]))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
