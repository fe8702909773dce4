#!/usr/bin/env bash
# manual.sh VTS ROOT: every ```vts block of README.md and doc/*.md passes `vts check`, and doc/manual.md names every option of
# the program. Prints what does not; status 1 then.
set -u -o pipefail
vts=$1 root=$2
folder=$(mktemp -d) || exit 2
trap 'rm -rf "$folder"' EXIT

failed=0 count=0
for page in "$root"/README.md "$root"/doc/*.md; do
  name=$(basename "$page" .md)
  # One file for each block, named after the line it begins at.
  awk -v prefix="$folder/$name-line-" '
    /^```vts$/ { out = prefix NR ".vts"; printf "" > out; next }
    /^```/ { if (out) close(out); out = "" }
    out { print > out }' "$page"
  for scene in "$folder/$name"-line-*.vts; do
    [ -e "$scene" ] || continue
    count=$((count + 1))
    "$vts" check "$scene" || { echo "$(basename "$scene" .vts) does not pass"; failed=1; }
    rm -f "$scene"
  done
done
[ $count -gt 0 ] || { echo "no scenes found"; exit 1; }
echo "$count scenes"

# The table of options says what --help says exists.
for command in render check run; do
  while read -r option; do
    grep -q -- "$option" "$root/doc/manual.md" || { echo "doc/manual.md does not name $option of vts $command"; failed=1; }
  done < <("$vts" "$command" --help | grep -oE "^ +(-[a-zA-Z], )? *--[a-z-]+" | grep -oE -- "--[a-z-]+")
done
exit $failed
