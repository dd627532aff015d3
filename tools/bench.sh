#!/usr/bin/env bash
# Runs every benchmark program of a build. Called by `./dev bench [NAME…] [--OPTION…]`; the options
# go to each program that runs.
set -uo pipefail
build=$1
shift
names=()
while [ $# -gt 0 ] && [[ $1 != -* ]]; do
  names+=("$1")
  shift
done
status=0
for program in "$build"/bench/bench_*; do
  name=${program##*/bench_}
  [ ${#names[@]} -eq 0 ] || [[ " ${names[*]} " == *" $name "* ]] || continue
  [ -x "$program" ] || continue
  printf '== %s\n' "$name"
  "$program" "$@" || status=$?
done
exit $status
