#!/usr/bin/env bash
# run.sh TARGET SECONDS [FOLDER…]: a fuzzing session of lexer, parser, evaluator or maps, seeded with the corpus and
# the programs of the tests, and with the files of the folders given. Builds in build-fuzz with clang and sanitizers; finds are kept
# in build-fuzz/finds, what widened the coverage in build-fuzz/corpus-TARGET. Status 0: nothing was found.
set -eu -o pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
target=$1 seconds=$2
shift 2
build=$root/build-fuzz
[ -f "$build/build.ninja" ] || cmake -G Ninja -S "$root" -B "$build" -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ \
  -DCMAKE_BUILD_TYPE=RelWithDebInfo -DVTS_FUZZ=ON -DVTS_SANITIZE=ON -DVTS_TESTS=OFF >&2
ninja -C "$build" "fuzz_$target"
mkdir -p "$build/finds" "$build/corpus-$target"
programs=("$root/tests/fuzz/corpus" "$root/tests/language" "$root/tests/diagnostics")
[ "$target" != maps ] || programs=("$root/tests/fuzz/maps")
exec nice -n 10 "$build/tests/fuzz/fuzz_$target" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2500 -max_len=6000 \
  -dict="$build/tests/fuzz/keywords.dict" -artifact_prefix="$build/finds/$target-" -print_final_stats=1 \
  "$build/corpus-$target" "${programs[@]}" "$@"
