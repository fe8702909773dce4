#!/usr/bin/env bash
# vocabulary.sh VTS FILE: the programs of FILE, each after a line `//// right` or `//// wrong`, pass or fail `vts check` as POV-Ray
# 3.7 takes or refuses them. Those that are right name exactly the warnings that stand in their `// warning:` lines.
# BLESS=1 writes these lines anew.
set -u
vts=$1 file=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
awk -v out="$folder/" '/^\/\/\/\/ /{ name = sprintf("%s%04d_%s.vts", out, ++n, $2); line = NR } { if (name) print > name }' "$file"
cd "$folder" || exit 1

failures=0 blessed=
report() {
  failures=$((failures + 1))
  echo "$(basename "$file"), program ${program%%_*}: $1"
  cat "$program"
}
for program in *.vts; do
  printed=$("$vts" check "$program" 2>&1)
  status=$?
  found=$(sed -n 's/^[^ ].*: warning: //p' <<< "$printed" | grep -v '^the scene holds nothing to draw')
  wanted=$(sed -n 's|^// warning: ||p' "$program")
  case $program in
    *_right.vts)
      if [ $status -ne 0 ]; then report "is right, but: $printed"
      elif [ "$found" != "$wanted" ] && [ -z "${BLESS:-}" ]; then report "warns of: $found"; fi ;;
    *) [ $status -eq 1 ] || report "is wrong, but passes (status $status)" ; found=$wanted ;;
  esac
  blessed+=$(head -n 1 "$program")$'\n'
  [ -z "$found" ] || blessed+=$(sed 's|^|// warning: |' <<< "$found")$'\n'
  blessed+=$(sed -e 1d -e '/^\/\/ warning: /d' "$program")$'\n'
done
[ -z "${BLESS:-}" ] || printf '%s' "$blessed" > "$file"
echo "$(ls | wc -l) programs, $failures wrong"
[ $failures -eq 0 ]
