#!/usr/bin/env python3
"""docs/clients.md: each row of its table names a test that is there, and no test of other people's clients goes without a row.

    clients_page.py PAGE CTEST BUILD_FOLDER
"""
import pathlib
import re
import subprocess
import sys

OTHERS = ("Clients.", "SocketCan.")  # suites whose every test is a client's
OUR_OWN = {"SocketCan.KernelForTestsKeepsItsPromises", "SocketCan.the_doctor_sees_the_interface",
           "SocketCan.a_board_with_the_shim_drives_the_plant", "SocketCan.an_interface_that_goes_down_is_named_and_the_wheels_coast"}
FEWEST = 12


def main():
    page, ctest, folder = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    listed = subprocess.run([ctest, "-N"], cwd=folder, capture_output=True, text=True, check=True).stdout
    there = set(re.findall(r"^ *Test +#\d+: (\S+)", listed, re.M))
    bad, clients, named = [], set(), set()
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if not line.startswith("|") or cells[0] in ("client", "---"):
            continue
        tests = re.findall(r"`([A-Z][\w/]*\.[\w/]+)`", cells[-1])
        clients.add(cells[0])
        named.update(tests)
        if not tests:
            bad.append(f"{page}:{number}: {cells[0]} names no test")
        bad += [f"{page}:{number}: {test} is no test of ctest" for test in tests if test not in there]
    bad += [f"{test} has no row in {page}" for test in sorted(there - named - OUR_OWN) if test.startswith(OTHERS)]
    if len(clients) < FEWEST:
        bad.append(f"{page} has {len(clients)} clients, fewer than {FEWEST}")
    print("\n".join(bad) or f"{len(clients)} clients, {len(named)} tests")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
