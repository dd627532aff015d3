#!/usr/bin/env bash
# Format, style, rooms, API reference, static checks, sanitizers, a minute of fuzzing. Called by `./dev check [STEP…]`.
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
check_tidy() {
  # without the options that only gcc knows
  mkdir -p build/tidy
  sed -E 's/ (--param=[^ "]+|-fno-crossjumping)//g' build/release/compile_commands.json >build/tidy/compile_commands.json
  git ls-files '*.cc' | grep -v '^tests/' |
    xargs -P "$(nproc)" -n 4 clang-tidy -p build/tidy --quiet --warnings-as-errors='*' 2>/dev/null
}
check_sanitizers() {
  cmake --preset asan-ubsan >/dev/null && ninja -C build/asan-ubsan &&
    (cd build/asan-ubsan && ctest --output-on-failure -j "$(nproc)" -LE 'slow|allocations')
}
check_fuzz() {
  cmake --preset fuzz >/dev/null && ninja -C build/fuzz fuzz_packets &&
    mkdir -p build/fuzz/found &&
    build/fuzz/tests/fuzz_packets -max_total_time="${OMNIHIL_FUZZ_S:-60}" -print_final_stats=1 build/fuzz/found tests/fuzz/corpus
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
