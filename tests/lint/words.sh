#!/usr/bin/env bash
# words.sh ROOT: no word of the language is missing in the reference. Tables and headings of doc/scene.md and doc/reference name
# every reserved word, every word of vts's own blocks and their items, in code (`word`). doc/reference/functions.md has each
# function and constant, doc/reference/directives.md each directive, in a table and in an example; doc/reference/words.md names
# no word that is not there; doc/reference/stdlib.md has the macros and functions of the files that it describes. Prints what is missing; status 1 then.
set -u -o pipefail
export LC_ALL=C
cd "$1" || exit 2
folder=$(mktemp -d) || exit 2
trap 'rm -rf "$folder"' EXIT

keywords() { grep -oE "KEYWORD\(($1), [a-z0-9_]+" src/lexer/keywords.def | sed 's/.* //'; }
context_words() { sed -n 's/^CONTEXT_BLOCK(\([a-z0-9_]*\), "\(.*\)")$/\1 \2/p' src/parser/context.def | tr ' ' '\n' | grep .; }
known_functions() {
  sed -n '/known_functions\[\] = {/,/^};/s/^ *{"\([a-z0-9_]*\)".*/\1/p' src/eval/*.c
}
[ -n "$(known_functions)" ] || { echo "the functions that vts adds were not found"; exit 1; }

# Words in the code spans of tables and headings of some pages.
table_words() { grep -hE '^(\||#+ )' "$@" | grep -oE '`[^`]*`' | grep -oE '#?[A-Za-z_][A-Za-z0-9_]*'; }
example_words() { awk '/^```vts$/ { on = 1; next } /^```/ { on = 0 } on' "$@" | sed 's,//.*,,' | grep -oE '#?[A-Za-z_][A-Za-z0-9_]*'; }

# A failure is a file: the functions below run at the end of pipes.
fail() { touch "$folder/failed"; }
# require WHAT FILE-OF-WORDS PAGES: each word of stdin is in the file.
require() {
  sort -u > "$folder/wanted"
  [ -s "$folder/wanted" ] || { echo "no $1 were found in the sources"; fail; }
  sort -u "$2" | comm -23 "$folder/wanted" - > "$folder/missing"
  [ -s "$folder/missing" ] || return
  sed "s|.*|$3: no $1 names '&'|" "$folder/missing"
  fail
}

pages=(doc/scene.md doc/volumes.md doc/reference/*.md)
table_words "${pages[@]}" > "$folder/all"
table_words doc/reference/functions.md > "$folder/functions"
table_words doc/reference/directives.md > "$folder/directives"
example_words doc/reference/functions.md > "$folder/function_examples"
example_words doc/reference/directives.md > "$folder/directive_examples"

# Words of blocks that are no keywords (POV-Ray 3.8's), and operations of functions that are no operators.
block_words() { sed -n 's/^    {"\([a-z0-9_]*\)", [a-zA-Z_]*},$/\1/p' src/eval/build_table.c; }
tape_operations() {
  sed -nE 's/^TAPE_OP(_ROW)?\([A-Z0-9_]+, [1-9], "([a-z0-9_]+)".*/\2/p' src/tape/tape_ops.def |
    grep -vxE 'add|sub|mul|div|fold|idiv|neg|lt|le|gt|ge|eq|ne|and|or'
}

{ keywords 'CONSTANT|COLOR|WORD'; context_words; block_words; } | require "table or heading" "$folder/all" "doc/scene.md, doc/reference"
{ keywords 'FUNCTION|CONSTANT'; known_functions; } | require table "$folder/functions" doc/reference/functions.md
{ keywords 'FUNCTION|CONSTANT'; known_functions; } | grep -vx internal | require "example" "$folder/function_examples" doc/reference/functions.md
{ keywords DIRECTIVE; echo version; } | sed 's/^/#/' | require "table" "$folder/directives" doc/reference/directives.md
{ keywords DIRECTIVE; echo version; } | sed 's/^/#/' | require "example" "$folder/directive_examples" doc/reference/directives.md

# Macros and functions of the standard library's files that the page describes; Math_…, Arrays_…, Shapes_… are a file's own.
library_names() {
  local file
  for file in stdlib/*.inc; do
    grep -qx "## $(basename "$file")" doc/reference/stdlib.md || continue
    sed -nE 's/^ *#macro +([A-Za-z0-9_]+).*/\1/p; s/^#declare +([A-Za-z0-9_]+) *= *function.*/\1/p' "$file" |
      grep -vE '^(_|Arrays|Math|Trans|Shapes|Skies|Grass|Flowers|Fur|Ground|Materials|Wind|Textures)_'
  done
}
table_words doc/reference/stdlib.md > "$folder/library"
cat "$folder/functions" "$folder/library" > "$folder/callable"
tape_operations | require table "$folder/callable" "doc/reference/functions.md, doc/reference/stdlib.md"
library_names | require table "$folder/library" doc/reference/stdlib.md
for file in stdlib/*.inc; do
  grep -qF "$(basename "$file")" doc/reference/stdlib.md || { echo "doc/reference/stdlib.md does not name $file"; fail; }
done

# And the index names no word that is not there: the first word of each code span in a first cell.
{ keywords '[A-Z]*'; context_words; block_words; } | sort -u > "$folder/words"
sed -n 's/^| \(`[^|]*\) |.*/\1/p' doc/reference/words.md | grep -oE '`[a-z][a-z0-9_]*' | tr -d '`' | sort -u > "$folder/indexed"
comm -23 "$folder/indexed" "$folder/words" > "$folder/stale"
[ -s "$folder/stale" ] && { sed "s|.*|doc/reference/words.md: there is no word '&'|" "$folder/stale"; fail; }
[ ! -e "$folder/failed" ]
