#!/usr/bin/env bash
# grammar.sh ROOT: doc/grammar.ebnf holds the rules that stand above the parser's functions, `/* name = … */`. Prints what
# differs; status 1 then, and where a rule names one that is not there. BLESS=1 writes the page.
set -u -o pipefail
export LC_ALL=C
cd "$1" || exit 2
page=doc/grammar.ebnf
folder=$(mktemp -d) || exit 2
trap 'rm -rf "$folder"' EXIT

# Rules, one a line. A line below goes on with the rule when it begins with |; other text, and what follows a colon, explains.
rules() {
  awk '
    function finish() { sub(/ *\*\/$/, "", text); sub(/: [a-z].*|, at most .*/, "", text); print text; on = 0 }
    /^\/\* [a-z_]+ = / { text = substr($0, 4); on = 1; if ($0 ~ /\*\/$/) finish(); next }
    on { line = $0; sub(/^ \* */, "", line); if (line ~ /^\|/) text = text " " line; if ($0 ~ /\*\/$/) finish() }' \
    src/parser/{parser,item,directive,expression,function,color,layers}.c
}

{
  echo '(* The grammar of the language, as the parser reads it: extracted from src/parser.
   { } any number of times, [ ] may be missing.'
  echo '   A macro call stands for the text of its body, so that any rule may begin in one macro and end in another.'
  echo '   What a block may hold is not grammar: see scene.md. *)'
  echo 'program = statements'
  echo 'statements = { statement }'
  rules
} | sed -E 's/^([a-z_]+ = .*)$/\n\1/' | fold -s -w 114 |
  sed -E 's/ *$//; /^$|^[a-z_]+ = |^\(\*|^   /!s/^/    /' > "$folder/page"

[ -n "${BLESS:-}" ] && cp "$folder/page" $page
failed=0
diff -u $page "$folder/page" || { echo "$page is out of date: BLESS=1 tests/lint/grammar.sh ."; failed=1; }

# Names that are used are rules, or tokens of the lexer.
tokens='number string identifier keyword constant component component_word color_word function_word'
sed -nE 's/^([a-z_]+) = .*/\1/p' $page | sort > "$folder/defined"
[ -z "$(uniq -d "$folder/defined")" ] || { echo "$page: defined twice: $(uniq -d "$folder/defined")"; failed=1; }
sed '/^(\*/,/\*)/d; s/"[^"]*"//g' $page | grep -oE '[a-z_]+' | sort -u | comm -23 - <(sort -u "$folder/defined" <(tr ' ' '\n' <<< "$tokens")) > "$folder/unknown"
[ -s "$folder/unknown" ] && { echo "$page: no rule for" $(cat "$folder/unknown"); failed=1; }
[ "$(wc -l < "$folder/defined")" -gt 25 ] || { echo "$page: too few rules"; failed=1; }
exit $failed
