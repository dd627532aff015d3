#!/usr/bin/env bash
# Runs every fuzz target of a build, as many at once as there are cores, and adds up the executions. What was found worth
# keeping stays in FOLDER/found/TARGET, an input that breaks a target is named. Called by `./dev check fuzz`.
#
#   tools/fuzz.sh build/fuzz 10 [TARGET…]      10 s for each
set -uo pipefail
folder=$1 seconds=$2
shift 2
list=$folder/tests/fuzz/targets.txt
work=$folder/found
mkdir -p "$work"

one() {  # FOLDER SECONDS WORK NAME SEED-FOLDER…
  local folder=$1 seconds=$2 work=$3 name=$4 status=0 executions
  shift 4
  mkdir -p "$work/$name"
  nice -n 10 "$folder/tests/fuzz/fuzz_$name" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=4096 -print_final_stats=1 \
    -artifact_prefix="$work/$name." "$work/$name" "$@" >"$work/$name.log" 2>&1 || status=$?
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$work/$name.log")
  if [ $status -eq 0 ] && [ "${executions:-0}" -gt 0 ]; then
    printf '%-16s %10d executions\n' "$name" "$executions"
  else
    printf '%-16s %10d executions, BROKEN: %s\n' "$name" "${executions:-0}" "$(grep -m1 -E 'property broken|ERROR|runtime error|Assertion|terminate' "$work/$name.log")"
    sed -n 's/^artifact_prefix.*Test unit written to /                 its input: /p' "$work/$name.log"
  fi
}
export -f one

while read -r name seeds; do
  [ $# -gt 0 ] && [[ " $* " != *" $name "* ]] && continue
  printf '%s\n' "$folder $seconds $work $name $seeds"
done <"$list" | xargs -P "$(nproc)" -I{} bash -c 'one {}' | tee "$work/summary.txt"
awk '{ sum += $2 } /BROKEN/ { ++broken } END { printf "%d targets, %d executions, %d broken\n", NR, sum, broken }' \
  <(grep executions "$work/summary.txt")
! grep -q BROKEN "$work/summary.txt" && grep -q executions "$work/summary.txt"
