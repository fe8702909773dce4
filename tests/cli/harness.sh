# What the scripts of cases share: NAME.sh CASE VTS JSON_CHECK runs one case of how the program behaves; says what differs, status 1.
set -u
case_name=$1 vts=$2 json_check=$3
folder=$(mktemp -d) || exit 2
trap 'chmod -R u+w "$folder"; rm -rf "$folder"' EXIT
cd "$folder" || exit 2
unset NO_COLOR VTS_MODULE_DIR
differs=0

fail() { printf '%s: %s\n' "$case_name" "$*"; differs=1; }

# run ARGUMENTS…: leaves stdout in `out`, stderr in `err`, the status in $status.
run() {
  call="vts $*"
  "$vts" "$@" >out 2>err </dev/null
  status=$?
}
want_status() {
  local s
  for s in "$@"; do [ "$status" = "$s" ] && return; done
  fail "'$call' ended with $status, not $*: $(head -c 300 err)"
}
want_in() { grep -qF -- "$2" "$1" || fail "'$call': no '$2' in std$1: $(head -c 300 "$1")"; }
want_empty() { [ ! -s "$1" ] || fail "'$call': std$1 is not empty: $(head -c 300 "$1")"; }
want_file() { [ -s "$1" ] || fail "'$call': no file $1"; }
# Nothing but what is named here lies in the folder: no picture, no temporary file.
want_only() {
  local found
  found=$(ls -A | grep -vxF -f <(printf '%s\n' out err "$@"))
  [ -z "$found" ] || fail "'$call' left $found"
}
refused() { # ARGUMENTS…: a usage error that points to help
  run "$@"
  want_status 2
  want_empty out
  want_in err 'error:'
}

scene() {
  cat >scene.vts <<'S'
camera { location <0, 1.5, -4> look_at <0, 0.5, 0> }
light_source { <5, 10, -5> rgb 1 }
background { rgb <0.5, 0.7, 1> }
sphere { <0, 0.5, 0>, 0.5 pigment { rgb <0.8, 0.2, 0.1> } }
plane { y, 0 pigment { checker rgb 1, rgb 0.3 } }
S
}

# Runs case_CASE.
run_case() {
  "case_$case_name"
  exit $differs
}
