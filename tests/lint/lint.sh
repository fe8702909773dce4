#!/usr/bin/env bash
# lint.sh RULE ROOT [COMPILER]: prints what breaks a rule, one line each; status 1 when there is any.
#   includes   folders of src include only what the vts_module() lines of CMakeLists.txt let them link; cli only vts.h
#   headers    every header of src compiles alone
#   calls      below cli nothing prints, nothing exits; nothing that is not thread-safe by nature
#   names      names of source files are unique
#   blanks     no trailing blanks, no tabs in C, every file ends its last line
set -u -o pipefail
export LC_ALL=C
rule=$1 root=$2 compiler=${3:-cc}
cd "$root" || exit 2

sources() { find src -name '*.[ch]' -o -name '*.cpp' -o -name '*.def' | sort; }

# "parser lexer", "parser base": a folder and each folder it may include, itself and transitive ones among them.
allowed_pairs() {
  sed -n 's/^vts_module(\(.*\))/\1/p' CMakeLists.txt | awk '
    { of[$1] = ""; on = 0
      for (i = 2; i <= NF; i++) { if ($i == "DEPENDS") on = 1; else if ($i == "LIBRARIES") on = 0; else if (on) of[$1] = of[$1] " " $i } }
    function visit(root, folder,   n, i, parts) {
      if ((root, folder) in seen) return
      seen[root, folder] = 1
      print root, folder
      n = split(of[folder], parts, " ")
      for (i = 1; i <= n; i++) visit(root, parts[i])
    }
    END { for (f in of) visit(f, f); print "cli cli" }'
}

# FILE:LINE FOLDER INCLUDED-FOLDER INCLUDED, of the quoted includes.
quoted_includes() {
  sources | xargs grep -n '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' /dev/null | sed 's/^\([^:]*:[0-9]*\):[^"]*"\([^"]*\)".*/\1 \2/' |
    awk '{ n = split($1, at, "/"); folder = n > 2 ? at[2] : "."; k = index($2, "/"); print $1, folder, k ? substr($2, 1, k - 1) : ".", $2 }'
}

rule_includes() {
  quoted_includes | awk -v pairs="$(allowed_pairs)" '
    BEGIN { n = split(pairs, line, "\n"); for (i = 1; i <= n; i++) may[line[i]] = 1 }
    $2 == "." { if ($1 ~ /^src\/vts\.h/) print $1 ": vts.h includes " $4; next }
    $4 == "vts.h" { if ($2 != "cli") print $1 ": only cli and vts.c include vts.h"; next }
    !(($2 " " $3) in may) { print $1 ": " $2 " may not include " $4 }'
}

rule_headers() {
  local header foreign
  foreign=$(pkg-config --cflags freetype2) # whose headers lie in a folder of their own
  find src -name '*.h' | sort | while read -r header; do
    printf '#include "%s"\n' "${header#src/}" |
      "$compiler" -std=c17 -Wall -Wextra -Wpedantic -Werror -D_POSIX_C_SOURCE=200809L -DVTS_VERSION='""' -Isrc $foreign -fsyntax-only -x c - 2>&1
  done
}

# The text without comments and what is in quotes; lines keep their numbers.
code_only() {
  awk '
    { out = ""; text = $0
      while (text != "") {
        if (inside) {
          k = index(text, "*/")
          if (!k) { text = ""; break }
          text = substr(text, k + 2); inside = 0; continue
        }
        c = substr(text, 1, 1); two = substr(text, 1, 2)
        if (two == "//") break
        if (two == "/*") { inside = 1; text = substr(text, 3); continue }
        if (c == "\"" || c == "\047") {
          text = substr(text, 2)
          while (text != "" && substr(text, 1, 1) != c) text = substr(text, substr(text, 1, 1) == "\\" ? 3 : 2)
          text = substr(text, 2); out = out c c; continue
        }
        out = out c; text = substr(text, 2)
      }
      print out }' "$1"
}

rule_calls() {
  local file words
  words='exit|_exit|_Exit|quick_exit|abort|printf|vprintf|puts|putchar|perror|system|popen|fork|strtok|gets|rand|srand|setlocale|localtime|gmtime|asctime|ctime|strcpy|strcat|sprintf|vsprintf|alloca'
  sources | grep -v '^src/cli/' | while read -r file; do
    [ "${file#src/base/}" = "$file" ] && here=$words || here=${words/|abort/}
    code_only "$file" | grep -nE "(^|[^A-Za-z0-9_.>])($here)[[:space:]]*\(|(^|[^A-Za-z0-9_])(stderr|stdout)([^A-Za-z0-9_]|\$)" | sed "s|^|$file:|"
  done
}

rule_names() {
  find src tests cmake bench \( -name '*.[ch]' -o -name '*.cpp' -o -name '*.sh' -o -name '*.cmake' \) ! -path 'bench/*/run.sh' 2>/dev/null |
    awk -F/ '{ if ($NF in first) print $0 " and " first[$NF] " have one name"; else first[$NF] = $0 }'
}

rule_blanks() {
  local file
  { sources; find tests cmake -name '*.[ch]' -o -name '*.sh' -o -name '*.cmake' -o -name 'CMakeLists.txt'
    ls CMakeLists.txt CMakePresets.json run test .ci/run; } | while read -r file; do
    grep -nE '[[:space:]]+$' "$file" | sed "s|^\([0-9]*\):.*|$file:\1: trailing blank|"
    case $file in *.c | *.h | *.cpp) grep -nF $'\t' "$file" | sed "s|^\([0-9]*\):.*|$file:\1: tab|" ;; esac
    [ -z "$(tail -c 1 "$file")" ] || echo "$file: the last line does not end"
  done
}

case $rule in
  includes | headers | calls | names | blanks) found=$("rule_$rule") ;;
  *) echo "unknown rule $rule"; exit 2 ;;
esac
[ -z "$found" ] && exit 0
printf '%s\n' "$found"
exit 1
