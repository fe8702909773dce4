#!/usr/bin/env bash
# stability.sh ROOT: each row of the tables of doc/stability.md names, in its last column, tests that exist: `PROGRAM: CASE` is a case of
# tests/*/PROGRAM.c, and `diagnostics: NAME` a program of tests/diagnostics with its expectation. Each tests/stability/test_*.c is named
# somewhere. Prints what does not hold; status 1 then.
set -u -o pipefail
cd "$1" || exit 2
page=doc/stability.md
failed=0 count=0

test_exists() {
  local program=${1%%: *} name=${1#*: } source
  [ "$program" != "$1" ] || return 1
  [ "$program" != diagnostics ] || { [ -s "tests/diagnostics/$name.vts" ] && [ -s "tests/diagnostics/$name.expected" ]; return; }
  source=$(ls tests/*/"$program".c 2>/dev/null) || return 1
  grep -qE "^static void $name\(void \*\*" "$source" && grep -qE "(TEST|cmocka_unit_test[a-z_]*)\($name[,)]" "$source"
}

while IFS= read -r row; do
  named=0
  while IFS= read -r test; do
    [ -n "$test" ] || continue
    named=1 count=$((count + 1))
    test_exists "$test" || { echo "$page: there is no test '$test'"; failed=1; }
  done < <(sed -E 's/ *\| *$//; s/.*\| *//' <<< "$row" | grep -o '`[^`]*`' | tr -d '`')
  [ $named = 1 ] || { echo "$page: no test is named: $row"; failed=1; }
done < <(awk '/^\|---/ { on = 1; next } !/^\|/ { on = 0 } on' $page)
[ $count -gt 50 ] || { echo "$page: only $count tests are named"; failed=1; }

for source in tests/stability/test_*.c; do
  grep -q "$(basename "$source" .c): " $page || { echo "$page does not name $source"; failed=1; }
done
exit $failed
