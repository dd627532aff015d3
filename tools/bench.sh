#!/usr/bin/env bash
# Runs every benchmark program of a build, then counts instructions. Called by `./dev bench [NAME…]`.
set -uo pipefail
build=$1
shift
status=0
for program in "$build"/bench/bench_*; do
  name=${program##*/bench_}
  [ $# -eq 0 ] || [[ " $* " == *" $name "* ]] || continue
  [ -x "$program" ] || continue
  printf '== %s\n' "$name"
  "$program" || status=$?
done
exit $status
