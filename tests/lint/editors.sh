#!/usr/bin/env bash
# editors.sh VTS JSON_CHECK ROOT: the editors' grammars hold the words of the parser (editors/make.sh writes what is there),
# their JSON files are JSON, and each snippet is a scene that passes `vts check`. Prints what does not hold; status 1 then.
set -u -o pipefail
vts=$(realpath "$1") json_check=$(realpath "$2")
cd "$3/editors" || exit 2
folder=$(mktemp -d) || exit 2
trap 'rm -rf "$folder"' EXIT
failed=0

bash make.sh "$folder" || exit 1
for file in vscode/syntaxes/vts.tmLanguage.json vim/syntax/vts.vim; do
  cmp -s "$file" "$folder/$file" || { diff "$file" "$folder/$file" | head -n 20; echo "$file is out of date: run editors/make.sh"; failed=1; }
  grep -q '@[a-z_]*@' "$folder/$file" && { echo "$file: something was not filled in"; failed=1; }
done

is_json() { "$json_check" "${@:2}" < "$1" || { echo "$1 is no JSON, or lacks one of: ${*:2}"; failed=1; }; }
is_json vscode/package.json name engines contributes languages grammars snippets
is_json vscode/language-configuration.json comments brackets folding indentationRules
is_json vscode/syntaxes/vts.tmLanguage.json scopeName patterns repository
is_json vscode/snippets/vts.json prefix body description

# What the manifest names is there.
grep -o '"\./[^"]*"' vscode/package.json | tr -d '"' | while read -r path; do
  [ -s "vscode/$path" ] || { echo "vscode/package.json: there is no $path"; exit 1; }
done || failed=1

# Snippets as an editor inserts them, with all defaults. In JSON, \\} is the } of a placeholder's text.
awk -v folder="$folder" '
  /"prefix":/ { split($0, part, "\""); out = folder "/" part[4] ".snippet"; next }
  /^ *\],?$|^    \]/ { inside = 0; close(out) }
  inside { line = $0; sub(/^ *"/, "", line); sub(/",?$/, "", line); print line > out }
  /"body": \[$/ { inside = 1 }' vscode/snippets/vts.json
count=0
for snippet in "$folder"/*.snippet; do
  name=$(basename "$snippet" .snippet) scene=$folder/snippet.vts
  sed -E 's/\\"/"/g; s/\\\\/\\/g; s/\\\\/\x02/g; s/\\\}/\x01/g; s/\$\{[0-9]+:([^}]*)\}/\1/g; s/\x01/}/g; s/\x02/\\/g' "$snippet" > "$scene"
  case $name in texture) sed -i '1s/^/sphere { 0, 1 /; $s/$/ }/' "$scene" ;; esac
  grep -q '\$' "$scene" && { echo "snippet '$name': a placeholder without a default"; failed=1; }
  "$vts" check "$scene" > "$folder/said" 2>&1 || { echo "snippet '$name':"; cat "$folder/said"; failed=1; }
  count=$((count + 1))
done
[ "$count" -gt 10 ] || { echo "only $count snippets were found"; failed=1; }
exit $failed
