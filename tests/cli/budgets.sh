#!/usr/bin/env bash
# budgets.sh ground|trees VTS: the texels of the standard library keep the budgets of voxels and memory that doc/ground.md and doc/vegetation.md
# state. What they take in seconds, bench/library.sh shows.
. "$(dirname "${BASH_SOURCE[0]}")/harness.sh"
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
rows=$(bash "$root/bench/library.sh" "$vts" "$case_name") || fail "bench/library.sh $case_name ended with $?"

# within PATTERN VOXELS MEGABYTES COUNT: so many rows' names match, and none takes more.
within() {
  local found
  found=$(awk -F '|' -v pattern="$1" -v voxels="$2" -v megabytes="$3" '
    $2 ~ pattern {
      count++
      split($4, memory, " ")
      size = memory[1] * (memory[2] == "MB" ? 1 : memory[2] == "kB" ? 1e-3 : 1e3)
      if ($3 + 0 <= 0 || $3 > voxels || size <= 0 || size > megabytes) print "over the budget:" $2 $3 $4
    }
    END { print count + 0 " rows" }' <<<"$rows")
  [ "$found" = "$4 rows" ] || fail "$found"
}

case $case_name in
  ground) within '_Texel`' 200000 3.5 17 ;;
  trees)
    within '_Texel`' 250000 3 8
    within '_Stand_1`' 400000 4 3
    ;;
  *) fail 'no such case' ;;
esac
exit $differs
