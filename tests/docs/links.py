#!/usr/bin/env python3
"""Every link and picture of the Markdown pages leads to a file that is there, and every failure page is in its list."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
LINK = re.compile(r"\]\(([^)\s#]+)(?:#[^)]*)?\)")


def pages():
    yield from ROOT.glob("*.md")
    yield from (ROOT / "docs").rglob("*.md")


def main():
    bad = []
    for page in pages():
        text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.S)
        for target in LINK.findall(text):
            if "://" not in target and not (page.parent / target).exists():
                bad.append(f"{page.relative_to(ROOT)}: {target} is not there")
    listed = (ROOT / "docs/failures/README.md").read_text(encoding="utf-8")
    for page in (ROOT / "docs/failures").glob("*.md"):
        if page.name != "README.md" and f"({page.name})" not in listed:
            bad.append(f"docs/failures/{page.name} is not in the list")
    print("\n".join(bad))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
