#!/usr/bin/env bash
# make.sh [FOLDER]: writes the word lists of the parser into the editors' grammars, vscode/syntaxes/vts.tmLanguage.json and
# vim/syntax/vts.vim, in FOLDER (default: this folder). Run it after a change of keywords.def, context.def or the functions
# that vts adds; a test compares.
set -eu -o pipefail
export LC_ALL=C
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
src=$here/../src out=${1:-$here}

keywords() { grep -oE "KEYWORD\($1, [a-z0-9_]+" "$src/lexer/keywords.def" | sed 's/.* //' | sort -u; }
known_functions() { sed -n '/known_functions\[\] = {/,/^};/s/^ *{"\([a-z0-9_]*\)".*/\1/p' "$src/eval/eval_noise.c"; }
contexts() { sed -n 's/^CONTEXT_BLOCK(\([a-z0-9_]*\), "\(.*\)")$/\1 \2/p' "$src/parser/context.def"; }
joined() { paste -sd "$1" -; }

functions() { { keywords FUNCTION; known_functions; } | sort -u; }
directives() { { keywords DIRECTIVE; echo version; } | sort -u; }

# Lines "@NAME@" of a template are replaced by what the command of that name prints; @NAME@ within a line by its words with | between.
fill() {
  local line name
  while IFS= read -r line; do
    if [[ $line =~ ^@([a-z_]+)@$ ]]; then "${BASH_REMATCH[1]}"
    else
      while [[ $line =~ @([a-z_]+)@ ]]; do
        name=${BASH_REMATCH[1]}
        line=${line//@"$name"@/$(words_of "$name")}
      done
      printf '%s\n' "$line"
    fi
  done < "$1"
}

words_of() {
  case $1 in
    functions) functions | joined '|' ;;
    directives) directives | joined '|' ;;
    vim_directives) directives | joined ' ' | sed 's/ /\\|/g' ;;
    constants) keywords CONSTANT | joined '|' ;;
    colors) keywords COLOR | joined '|' ;;
    words) keywords WORD | joined '|' ;;
    *) echo "make.sh: a template asks for $1" >&2; exit 1 ;;
  esac
}

# What may stand between a block's word and its brace: `count 16 {` and `phases 8 {` have a number there.
before_brace() {
  case $1 in count | phases) printf '%s' "$2" ;; *) printf '%s' "$3" ;; esac
}

# A rule for each block of vts: its own words are coloured between its braces only.
textmate_blocks() {
  local block items
  contexts | while read -r block items; do
    printf '    "block-%s": {\n' "$block"
    printf '      "begin": "\\\\b(%s)\\\\b(%s)\\\\{", "end": "\\\\}",\n' "$block" "$(before_brace "$block" '[^{}#;]{0,60}?' '\\s*')"
    printf '      "beginCaptures": {"1": {"name": "storage.type.block.vts"}, "2": {"patterns": [{"include": "#plain"}]}},\n'
    printf '      "patterns": [{"include": "#blocks"}, '
    [ -z "$items" ] || printf '{"match": "\\\\b(%s)\\\\b(?!\\\\s*\\\\{)", "name": "support.type.property-name.vts"}, ' "${items// /|}"
    printf '{"include": "$self"}]\n    },\n'
  done
}

textmate_includes() {
  contexts | while read -r block _; do printf '        {"include": "#block-%s"},\n' "$block"; done | sed '$s/,$//'
}

vim_keywords() { fold -s -w 100 | sed "s/^/syn keyword $1 /; s/ *$//"; }
vim_functions() { functions | joined ' ' | vim_keywords vtsFunction; }
vim_constants() { keywords CONSTANT | joined ' ' | vim_keywords vtsConstant; }
vim_colors() { keywords COLOR | joined ' ' | vim_keywords vtsColor; }
# A keyword would keep a region from beginning: words that begin blocks of vts are matches.
block_words() { contexts | cut -d ' ' -f 1 | sort -u; }
vim_words() {
  comm -23 <(keywords WORD) <(block_words) | joined ' ' | vim_keywords vtsWord
  printf 'syn match vtsWord "\\<\\%%(%s\\)\\>" display\n' "$(comm -12 <(keywords WORD) <(block_words) | joined ' ' | sed 's/ /\\|/g')"
}

vim_blocks() {
  local block items
  contexts | while read -r block items; do
    printf 'syn region vtsIn_%s matchgroup=vtsBlock start="\\<%s\\>%s{" matchgroup=vtsBlock end="}" fold contains=TOP\n' \
      "$block" "$block" "$(before_brace "$block" '[^{}#;]\{-}' '\s*')"
    [ -z "$items" ] || printf 'syn match vtsItem_%s "\\<\\%%(%s\\)\\>\\%%(\\s*{\\)\\@!" contained containedin=vtsIn_%s\nhi def link vtsItem_%s vtsItem\n' \
      "$block" "${items// /\\|}" "$block" "$block"
  done
}

mkdir -p "$out/vscode/syntaxes" "$out/vim/syntax"
fill "$here/templates/tmLanguage.json" > "$out/vscode/syntaxes/vts.tmLanguage.json"
fill "$here/templates/syntax.vim" > "$out/vim/syntax/vts.vim"
