#!/usr/bin/env bash
# links.sh ROOT: links of README.md, CHANGELOG.md, editors, doc and doc/reference to files and headings lead somewhere; every example has its
# picture in the gallery. Prints what does not; status 1 then.
set -u -o pipefail
cd "$1" || exit 2

# Headings as anchors: lower case, without punctuation, blanks as hyphens.
anchors_of() {
  sed -n 's/^##* //p' "$1" | sed "s/[\`'’,.():&/]//g; s/ /-/g" | tr '[:upper:]' '[:lower:]'
}

check_link() {
  local page=$1 link=$2 file anchor
  case $link in http:* | https:* | mailto:*) return 0 ;; esac
  file=${link%%#*} anchor=
  [ "$file" = "$link" ] || anchor=${link#*#}
  [ -z "$file" ] && file=$page || file=$(dirname "$page")/$file
  [ -e "$file" ] || { echo "$page: $link: no such file"; return 1; }
  [ -z "$anchor" ] || anchors_of "$file" | grep -qxF -- "$anchor" || { echo "$page: $link: no such heading"; return 1; }
}

failed=0
for page in README.md CHANGELOG.md editors/README.md doc/*.md doc/reference/*.md; do
  while read -r link; do
    check_link "$page" "$link" || failed=1
  done < <(grep -o '\](\([^) ]*\))' "$page" | sed 's/^](//; s/)$//')
done
for scene in examples/*.vts; do
  picture=doc/gallery/$(basename "$scene" .vts).jpg
  [ -s "$picture" ] || { echo "$scene has no picture $picture"; failed=1; }
done
exit $failed
