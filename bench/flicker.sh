#!/usr/bin/env bash
# How much more films flicker than they should: what two frames in a row differ by, against what the reference's differ by.
#
#   bench/flicker.sh [--size WxH] [--rays N] [--frames N] [--only "NAME …"] [--vts PATH] [OUT]
#
# For each film of the table below: 24 frames, at the size given (64x40), each beside two references of half of the rays (64), whose own noise is
# measured and taken off; once as the scene is, and once with max_error asked for. Prints NAME, processor seconds of the frames, RMSE, flicker and max_error, and FAILS where flicker is above max_error; status 1
# then. Writes NAME.csv and NAME.svg into OUT (default: flicker-out), where references are kept: what was stopped goes on when it is called again.
set -eu -o pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
. "$here/bench/options.sh"
vts=$here/build/vts size=64x40 rays=64 frames=24 only=''
read_options "size rays frames only vts" "[OUT]" "$@"
out=${operands[0]:-flicker-out}
[ -x "$vts" ] || { echo "$0: no program $vts" >&2; exit 2; }
mkdir -p "$out"
error=1/255
failed=0

# film NAME SCENE OPTION…
film() {
  local name=$1 scene=$2
  shift 2
  is_wanted "$name" || return 0
  if ! nice "$vts" chart "$scene" -s "$size" -f "1-$frames" --samples "$rays" --sweep max_error=$error --allow-read "$here/examples" \
    --keep "$out/$name" --resume --progress none "$@" -o "$out/$name.svg" >"$out/said" 2>&1; then
    echo "$name: $(grep error "$out/said" | head -n 1)" >&2
    failed=1
    return 0
  fi
  awk -F, -v name="$name" -v most="$error" '
    /^#/ { next }
    !named { for (i = 1; i <= NF; i++) column[$i] = i; named = 1; next }
    { split(most, part, "/"); limit = part[1] / part[2]; asked = $column["knob"] ~ /max_error/ ? "asked" : "as it is"; flicker = $column["flicker"]
      printf "%-8s %-9s %8.1f s   rmse %.5f   flicker %.5f of %.5f%s\n", name, asked, $column["cpu_s"], $column["rmse"], flicker, limit, (flicker > limit ? "   FAILS" : "")
      if (flicker > limit) failed = 1 }
    END { exit failed }' "$out/$name.csv" || failed=1
}

film lawn "$here/examples/wind.vts"
film forest "$here/examples/forest.vts" +KFF240
film orchard "$here/bench/flicker_orchard.vts"
exit $failed
