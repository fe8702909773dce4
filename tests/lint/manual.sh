#!/usr/bin/env bash
# manual.sh VTS ROOT: every scene of examples passes `vts check` without a warning, and every ```vts block of README.md, doc
# and doc/reference without a word. When the next block of the page is ```output, `vts run` of it says exactly that (errors and warnings too) instead. doc/manual.md names
# every option of the program. Prints what does not hold; status 1 then. BLESS=1 writes what is said into the pages.
set -u -o pipefail
vts=$(realpath "$1") root=$(realpath "$2")
folder=$(mktemp -d) || exit 2
trap 'rm -rf "$folder"' EXIT

# NUMBER.vts and, where the page states it, NUMBER.expected for each example; NUMBER is the line that it begins after.
split_page() {
  awk -v folder="$folder" '
    /^```vts$/ { last = NR; out = folder "/" NR ".vts"; printf "" > out; next }
    /^```output$/ { if (!last) { print FILENAME ":" NR ": output of no example" > "/dev/stderr"; exit 1 }
                    out = folder "/" last ".expected"; last = 0; printf "" > out; next }
    /^```/ { if (out) close(out); else last = 0; out = ""; next }
    out { print > out }' "$1"
}

# The page again, each output replaced by NUMBER.got.
blessed_page() {
  awk -v folder="$folder" '
    /^```vts$/ { last = NR }
    /^```output$/ { print; file = folder "/" last ".got"; while ((getline line < file) > 0) print line; close(file); skip = 1; next }
    /^```/ { skip = 0 }
    !skip' "$1"
}

# Runs the example in a folder of its own, where it may write.
say() {
  rm -rf "$folder/run" && mkdir "$folder/run" && cp "$1" "$folder/run/example.vts" || exit 2
  (cd "$folder/run" && "$vts" "$2" --allow-write . -I "$root/examples" example.vts </dev/null 2>&1)
}

try_example() {
  local place=$1 example=$2 expected=${2%.vts}.expected got=${2%.vts}.got status
  if [ ! -e "$expected" ]; then
    say "$example" check > "$got" && [ ! -s "$got" ] && return
    echo "$place: the example does not pass:"; cat "$got"
    return 1
  fi
  say "$example" run > "$got"
  status=$?
  [ -z "$(tail -c 1 "$got")" ] || echo >> "$got"
  [ $status -gt 1 ] && { echo "$place: status $status"; return 1; }
  [ -n "${BLESS:-}" ] && return
  [ $status = 1 ] && ! grep -q ': error: ' "$expected" && { echo "$place: an error that the page does not show:"; cat "$got"; return 1; }
  diff --label stated --label said -u "$expected" "$got" > "$folder/diff" && return
  echo "$place: the example says otherwise:"; cat "$folder/diff"
  return 1
}

failed=0 count=0
for page in "$root"/README.md "$root"/doc/*.md "$root"/doc/reference/*.md; do
  [ -e "$page" ] || continue
  rm -f "$folder"/*.vts "$folder"/*.expected "$folder"/*.got
  split_page "$page" || failed=1
  for example in "$folder"/*.vts; do
    [ -e "$example" ] || continue
    count=$((count + 1))
    try_example "${page#"$root"/}:$(basename "$example" .vts)" "$example" || failed=1
  done
  [ -z "${BLESS:-}" ] || { blessed_page "$page" > "$folder/page" && { cmp -s "$folder/page" "$page" || cp "$folder/page" "$page"; }; }
done
[ $count -gt 0 ] || { echo "no examples found"; exit 1; }

for scene in "$root"/examples/*.vts; do
  "$vts" check "$scene" > "$folder/said" 2>&1 && ! grep -qE ': (warning|error): ' "$folder/said" && continue
  echo "${scene#"$root"/} does not pass:"; cat "$folder/said"
  failed=1
done
echo "$count examples"

# The table of options says what --help says exists.
for command in render check run reference; do
  while read -r option; do
    grep -q -- "$option" "$root/doc/manual.md" || { echo "doc/manual.md does not name $option of vts $command"; failed=1; }
  done < <("$vts" "$command" --help | grep -oE "^ +(-[a-zA-Z], )? *--[a-z-]+" | grep -oE -- "--[a-z-]+")
done
exit $failed
