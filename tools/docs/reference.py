#!/usr/bin/env python3
"""Builds the API reference from the headers with Doxygen; any warning is an error.

    reference.py OUT        HTML into OUT/html; exit 1 with the warnings as file:line: text, 3 when Doxygen is not installed

Doxygen reads copies whose comments are marked (doxygen_filter.py); their lines are those of the headers.
"""
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

from doxygen_filter import for_doxygen, page_for_doxygen

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ["sim", "identify", "hil", "protocols", "firmware_iface", "tools"]
PAGES = ["README.md", "docs/architecture.md"]


def rooms_page(headers):
    """What tools/rooms.toml says of each room that has headers, as documentation of its folder."""
    rooms = tomllib.loads((ROOT / "tools/rooms.toml").read_text(encoding="utf-8"))
    return "".join(f"/// @dir {name}\n/// {row['says']}\n\n" for name, row in rooms.items()
                   if any(h.startswith(name + "/") for h in headers))


def write_copies(source):
    shutil.rmtree(source, ignore_errors=True)
    headers = [str(p.relative_to(ROOT)) for folder in FOLDERS for p in sorted((ROOT / folder).rglob("*.h"))]
    copies = {path: for_doxygen((ROOT / path).read_text(encoding="utf-8"), path) for path in headers}
    copies |= {path: page_for_doxygen((ROOT / path).read_text(encoding="utf-8"), PAGES) for path in PAGES}
    copies |= {str(p.relative_to(ROOT)): p.read_text(encoding="utf-8") for folder in FOLDERS for p in (ROOT / folder).rglob("*.inc")}
    copies["rooms.dox"] = rooms_page(headers)
    for path, text in copies.items():
        (source / path).parent.mkdir(parents=True, exist_ok=True)
        (source / path).write_text(text, encoding="utf-8")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    if shutil.which("doxygen") is None:
        print("doxygen is not installed (./dev docs installs it)")
        return 3
    out = Path(sys.argv[1]).resolve()
    source = out / "source"
    write_copies(source)
    shutil.rmtree(out / "html", ignore_errors=True)
    config = (ROOT / "tools/docs/Doxyfile").read_text(encoding="utf-8") + (
        f'INPUT = .\nOUTPUT_DIRECTORY = "{out}"\nIMAGE_PATH = "{ROOT}/docs/img"\n')
    result = subprocess.run(["doxygen", "-"], input=config, text=True, cwd=source, stderr=subprocess.PIPE)
    print(result.stderr.replace(f"{source}/", ""), end="")
    if result.returncode or result.stderr.strip():
        return 1
    print(f"{out}/html/index.html")
    return 0


if __name__ == "__main__":
    sys.exit(main())
