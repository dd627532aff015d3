#!/usr/bin/env bash
# Valgrind over test programs as they are built: memory errors, use of what was never set, leaks; and data races of what runs on
# several threads. Needs no build of its own, unlike the sanitizers. Called by `./dev check memory`.
#
#   tools/memcheck.sh build/release [PROGRAM…]        test_hil_wire …; without any: those below
set -uo pipefail
build=$1
shift
# What reads bytes and text from outside, and what serves them; a few minutes of an idle core. Programs that run compiled
# loops of a whole robot take hours here; those that start other programs are left to these.
programs=(test_hil_text test_hil_wire test_hil_radio_file test_hil_capture test_hil_game_log test_protocols
  test_protocols_dongles)
races=("test_identify_estimate Fit.IsTheSameForAnyNumberOfJobs" "test_identify_design Experiment.TheSameForAnyNumberOfThreads")
[ $# -eq 0 ] || { programs=("$@"); races=(); }
left_out='-*Slow*:*Alloc*'  # slow ones; those that count allocations by an operator new of their own, which valgrind replaces
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
status=0

under() {  # TOOL PROGRAM FILTER [OPTION…]
  local tool=$1 program=$2 filter=$3 code=0
  shift 3
  valgrind --tool="$tool" --error-exitcode=9 --log-file="$work/log" "$@" "$build/tests/$program" --gtest_filter="$filter" >"$work/out" 2>&1 || code=$?
  printf '%-9s %-26s %3d tests passed, %s\n' "$tool" "$program" "$(grep -c '\[       OK' "$work/out")" "$(grep -o '[0-9]* errors from.*contexts' "$work/log" | tail -n 1)"
  [ $code -eq 0 ] && return
  status=1
  grep -A3 'FAILED\|Failure' "$work/out" | head -n 20
  grep -A12 -E 'Invalid|uninitialised|definitely lost|Conflicting' "$work/log" | head -n 40
}

for program in "${programs[@]}"; do
  under memcheck "$program" "$left_out" --leak-check=full --show-leak-kinds=definite --errors-for-leak-kinds=definite
done
for race in "${races[@]}"; do
  read -r program filter <<<"$race"
  under drd "$program" "$filter"
done
exit $status
