#!/usr/bin/env python3
"""A part of each kind, made by ./dev new in a scratch tree, for the build to compile and to test.

    scratch_tree.py TREE

TREE then holds fresh_effect, fresh_format, … and the pages and models that their tests read. Files that would be the same are
not written again, so that nothing is compiled again for them.
"""
import filecmp
import pathlib
import shutil
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(SOURCE / "tools"))
import new  # noqa: E402


def made(root):
    for page, _what, _place in (into for kind in new.KINDS.values() for into in kind["into"]):
        (root / page).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(SOURCE / page, root / page)
    shutil.copytree(SOURCE / "models", root / "models")
    for kind in new.KINDS:
        new.write(new.planned(kind, f"fresh_{kind}", root))


def main(tree):
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        made(root)
        wanted = {p.relative_to(root) for p in root.rglob("*") if p.is_file()}
        for old in [p for p in tree.rglob("*") if p.is_file() and p.relative_to(tree) not in wanted]:
            old.unlink()
        for path in wanted:
            target = tree / path
            if not target.exists() or not filecmp.cmp(root / path, target, shallow=False):
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(root / path, target)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
