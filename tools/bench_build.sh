#!/usr/bin/env bash
# What a build costs: `./dev bench build`. The targets of `./dev run` in a fresh clone of HEAD with no compiler cache,
# then again after an edit of one file of each kind. CPU is user and system time of all processes, so that it says
# the same beside other work; wall time means what it says on two idle cores only.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
most_cpu_s=360   # of the first build: minutes from a fresh machine to driving robots, not a quarter of an hour
most_wall_s=240  # of the same, on two idle cores
edited=(tools/verbs/formats.cc sim/effects/cogging.cc identify/select/screening.cc hil/serve/serve.cc)

# seconds_of COMMAND...: its CPU and wall time into cpu and wall; what it printed only when it fails
seconds_of() {
  local TIMEFORMAT='%U %S %R' user system
  { time "$@" >"$clone.log" 2>&1; } 2>"$clone.time" || { tail -n 40 "$clone.log" >&2; exit 3; }
  read -r user system wall <"$clone.time"
  cpu=$(awk -v u="$user" -v s="$system" 'BEGIN { printf "%.1f", u + s }')
}
first_build() { cmake --preset release && ninja -C build/release omnihil; }
row() { printf '%-42s %7s s CPU  %7s s wall\n' "$1" "$2" "$3"; }

clone=$(mktemp -d)/omnihil
trap 'rm -rf "$(dirname "$clone")"' EXIT
git clone --quiet --shared "$root" "$clone"
cd "$clone"
mkdir -p build
export OMNIHIL_CCACHE= CCACHE_DISABLE=1
seconds_of first_build
first_cpu=$cpu
row "./dev run's targets, nothing cached" "$cpu" "$wall"
row '  at most' "$most_cpu_s" "$most_wall_s"
printf '  files compiled: %s; other processes that wanted a core at the end: %s\n' \
  "$(cut -f4 build/release/.ninja_log | grep -c '\.o$')" "$(awk '{ print $1 }' /proc/loadavg)"
for file in "${edited[@]}"; do
  touch "$file"
  seconds_of ninja -C build/release omnihil
  row "after an edit of $file" "$cpu" "$wall"
done
awk -v cpu="$first_cpu" -v most="$most_cpu_s" 'BEGIN { exit cpu > most }' || { echo 'missed: CPU of the first build'; exit 1; }
