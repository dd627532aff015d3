#!/usr/bin/env bash
# Format, style, rooms, API reference, static checks, sanitizers, ten seconds of fuzzing per target; by name alone: tidy_changed,
# memory (valgrind). Called by `./dev check [STEP…]`.
set -uo pipefail
cd "$(dirname "$0")/.."
steps=("$@")
[ ${#steps[@]} -gt 0 ] || steps=(format style rooms docs tidy sanitizers fuzz)
failed=()

sources() { git ls-files '*.cc' '*.h' '*.c'; }

check_format() { sources | xargs clang-format --dry-run -Werror; }
check_style() { python3 tools/style_check.py; }
check_rooms() { python3 tools/rooms.py --check; }
check_docs() { mkdir -p build && python3 tools/docs/reference.py build/docs; }
tidy_files() {
  # each file by itself, without precompiled headers (a missing include is an error here) and options that only gcc knows
  cmake --preset release -B build/tidy/alone -DOMNIHIL_TOGETHER=OFF -DOMNIHIL_PRECOMPILED=OFF >/dev/null || return 1
  sed -E 's/ (--param=[^ "]+|-fno-crossjumping|-Wno-(restrict|stringop-[a-z]+))//g; s#/build/tidy/alone/generated#/build/release/generated#g' \
    build/tidy/alone/compile_commands.json >build/tidy/compile_commands.json
  printf '%s\n' "$@" |
    xargs -P "$(nproc)" -n 4 clang-tidy -p build/tidy --quiet --warnings-as-errors='*' 2>/dev/null
}
check_tidy() {
  local files
  mapfile -t files < <(git ls-files '*.cc' | grep -v '^tests/')
  tidy_files "${files[@]}"
}
# Of the files that changed since OMNIHIL_CHECK_BASE, else since the branch left origin/main, else since the last tag:
# at most 24, evenly spread. A file takes 2 to 16 s of a core, all of them more than an hour.
check_tidy_changed() {
  local base head candidate most=24 files=()
  head=$(git rev-parse HEAD)
  for candidate in "${OMNIHIL_CHECK_BASE:-}" "$(git merge-base HEAD origin/main 2>/dev/null)" "$(git describe --tags --abbrev=0 2>/dev/null)"; do
    base=$(git rev-parse --verify --quiet "$candidate^{commit}") && [ "$base" != "$head" ] && break
    base=
  done
  [ -n "$base" ] || base=$(git rev-parse --verify --quiet HEAD~1) || return 0
  mapfile -t files < <(git diff --name-only --diff-filter=d "$base" -- '*.cc' | grep -v '^tests/')
  if [ ${#files[@]} -gt $most ]; then
    echo "${#files[@]} files changed since ${base:0:8}: $most of them are checked (./dev check tidy: all)"
    mapfile -t files < <(printf '%s\n' "${files[@]}" | awk -v n=${#files[@]} -v most=$most 'int(NR * most / n) > int((NR - 1) * most / n)')
  fi
  [ ${#files[@]} -eq 0 ] || tidy_files "${files[@]}"
}
check_sanitizers() {
  cmake --preset asan-ubsan >/dev/null && ninja -C build/asan-ubsan &&
    (cd build/asan-ubsan && ctest --output-on-failure -j "$(nproc)" -LE 'slow|allocations')
}
# Without a build of its own: for a day on which the sanitizers' takes too long.
check_memory() { tools/memcheck.sh build/release; }
check_fuzz() {
  # seconds for each target of tests/fuzz/targets
  cmake --preset fuzz >/dev/null && ninja -C build/fuzz fuzz_targets && tools/fuzz.sh build/fuzz "${OMNIHIL_FUZZ_S:-10}"
}

for step in "${steps[@]}"; do
  printf '== %s\n' "$step"
  "check_$step" || failed+=("$step")
done
if [ ${#failed[@]} -gt 0 ]; then
  printf 'failed: %s\n' "${failed[*]}"
  exit 1
fi
printf 'all passed: %s\n' "${steps[*]}"
