#!/usr/bin/env bash
# Takes into the corpus what a fuzzing run has found: of each target the inputs that reach code which its seeds do not, small
# ones only. Called by hand after `./dev check fuzz`.
#
#   tools/fuzz_keep.sh build/fuzz [TARGET…]
set -euo pipefail
folder=$1
shift
root=$(cd "$(dirname "$0")/.." && pwd)
most_bytes=2000  # of an input; and of new ones for a target at most most_files, the smallest (choices: the corpora stay readable)
most_files=24

while read -r name seeds; do
  [ $# -gt 0 ] && [[ " $* " != *" $name "* ]] && continue
  [ -d "$folder/found/$name" ] || continue
  chosen=$(mktemp -d)
  # shellcheck disable=SC2086
  "$folder/tests/fuzz/fuzz_$name" -merge=1 -max_len=$most_bytes "$chosen" $seeds "$folder/found/$name" >"$folder/found/$name.merge.log" 2>&1
  kept=0
  while read -r _ file; do
    [ "$kept" -lt "$most_files" ] || break
    # shellcheck disable=SC2086
    if ! find $seeds -type f -exec cmp -s "$chosen/$file" {} \; -print -quit | grep -q .; then
      cp "$chosen/$file" "$root/tests/fuzz/corpus/$name/found-${file:0:10}"
      kept=$((kept + 1))
    fi
  done < <(find "$chosen" -type f -printf '%s %f\n' | sort -n)
  rm -r "$chosen"
  printf '%-16s %3d new inputs\n' "$name" "$kept"
done <"$folder/tests/fuzz/targets.txt"
