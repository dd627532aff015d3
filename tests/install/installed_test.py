#!/usr/bin/env python3
"""Tests of an installed prefix: installed_test.py PREFIX SOURCES BUILD NAME. `install` makes the prefix; each other name is a test.

Exit code 77: it cannot be tried here, the reason is printed.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PREFIX, SOURCES, BUILD = map(pathlib.Path, sys.argv[1:4])
ELSEWHERE = tempfile.mkdtemp(prefix="omnihil-installed-")  # a working directory that nothing is found from


def omnihil(*words, prefix=PREFIX, expect=0):
    """What the installed program prints."""
    clean = {k: v for k, v in os.environ.items() if not k.startswith("OMNIHIL_")}
    ran = subprocess.run([prefix / "bin/omnihil", *words], cwd=ELSEWHERE, env=clean, text=True, timeout=100,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert ran.returncode == expect, f"{words}: exit code {ran.returncode}, expected {expect}\n{ran.stdout}"
    return ran.stdout


def skip(reason):
    print("skipped:", reason)
    sys.exit(77)


def build_setting(name):
    text = (BUILD / "CMakeCache.txt").read_text()
    return re.search(rf"^{name}:\w+=(.*)$", text, re.M).group(1)


def install():
    shutil.rmtree(PREFIX, ignore_errors=True)
    subprocess.run(["cmake", "--install", BUILD, "--prefix", PREFIX], check=True, stdout=subprocess.DEVNULL)


def the_program_needs_no_file_of_the_sources_or_the_build():
    if build_setting("CMAKE_BUILD_TYPE") != "Release":
        skip("only a Release build is free of the paths of its sources (asserts, debug information)")
    files = [f for folder in ("bin", "libexec", "lib") for f in (PREFIX / folder).rglob("*") if f.is_file()]
    assert len(files) >= 6, files
    for file in files:
        for folder in (SOURCES, BUILD):
            assert os.fsencode(folder) not in file.read_bytes(), f"{file} names {folder}"


def models_are_those_of_the_prefix():
    listed = omnihil("models").split("\n\n")[0].splitlines()
    expected = sorted(f.stem for f in (SOURCES / "models").rglob("*.toml"))
    assert sorted(line.split()[0] for line in listed) == expected
    # What is taken away from the prefix is gone: the sources do not step in.
    with tempfile.TemporaryDirectory() as folder:
        prefix = pathlib.Path(folder) / "fewer"
        shutil.copytree(PREFIX, prefix)
        (prefix / "share/omnihil/models/robots/omni_1024.toml").unlink()
        fewer = omnihil("models", prefix=prefix).split("\n\n")[0].splitlines()
        assert sorted(line.split()[0] for line in fewer) == [name for name in expected if name != "omni_1024"]


def shipped_scenarios_run_with_the_installed_reference_firmware():
    # In a process of its own: omnihil_firmware_process is found from the program's place.
    library = PREFIX / "lib/omnihil/libomnihil_reference_firmware.so"
    said = omnihil("scenario", "run", "wheel/direction", "--firmware", library)
    assert re.search(r"^1 scenarios, 0 failed; [1-9]\d* checks, 0 failed", said, re.M), said


def an_avr_image_finds_its_program():
    if not (PREFIX / "libexec/omnihil/omnihil-avr").exists():
        skip("simavr is not installed: omnihil-avr was not built")
    image = BUILD / "images/omni_reference_avr.hex"
    if not image.exists():
        skip("no cross compiler for AVR: there is no image")
    board = PREFIX / "share/omnihil/boards/omni_reference_avr.toml"
    omnihil("scenario", "run", "wheel/direction", "--robot", "omni_1024", "--firmware", image, "--board", board)


def headers_find_what_they_include():
    root = PREFIX / "include/omnihil"
    headers = list(root.rglob("*.h"))
    assert len(headers) > 100, len(headers)
    missing = []
    for header in headers:
        for name in re.findall(r'^\s*#\s*include\s*"([^"]+)"', header.read_text(), re.M):
            if not (root / name).exists() and not (header.parent / name).exists():
                missing.append(f"{header.relative_to(root)} includes {name}")
    assert not missing, "\n".join(missing)


def pages_and_completion_are_there():
    verbs = re.findall(r"^  (\w+) ", omnihil("--help").split("Subcommands:")[1].split("\n\n")[0], re.M)
    pages = {f.name for f in (PREFIX / "share/man/man1").iterdir()}
    assert pages == {"omnihil.1"} | {f"omnihil-{verb}.1" for verb in verbs}, pages
    for name in ("share/bash-completion/completions/omnihil", "share/fish/vendor_completions.d/omnihil.fish",
                 "share/doc/omnihil/README.md", "share/doc/omnihil/docs/serve.md", "share/doc/omnihil/CONTRIBUTING.md",
                 "share/omnihil/remote_shim/remote_shim.c", "share/omnihil/remote_shim/remote_shim.h",
                 "include/omnihil/omnihil_firmware.h"):
        assert (PREFIX / name).stat().st_size > 100, name


def a_moved_prefix_works():
    with tempfile.TemporaryDirectory() as folder:
        moved = pathlib.Path(folder) / "other place"
        shutil.copytree(PREFIX, moved)
        link = pathlib.Path(folder) / "bin/omnihil"  # as one puts it on the search path
        link.parent.mkdir()
        link.symlink_to(moved / "bin/omnihil")
        said = omnihil("models", "omni_defualt", prefix=link.parent.parent, expect=2)
        assert 'did you mean "omni_default"' in said, said
        omnihil("serve", "--clock", "free", "--duration", "0.05", "--quiet", prefix=link.parent.parent)


name = sys.argv[4]
try:
    globals()[name]()
finally:
    shutil.rmtree(ELSEWHERE, ignore_errors=True)
