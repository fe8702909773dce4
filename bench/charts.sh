#!/usr/bin/env bash
# All charts of doc/accuracy.md: what each knob costs and what it buys.
#
#   bench/charts.sh [--quick] [--only "NAME …"] [--vts PATH] [--peers FOLDER] [OUT]
#
# Draws NAME.svg and NAME.csv into OUT (default: charts-out) for each row of the table below, with machine, compiler and commit in the caption. A
# run that was stopped goes on where it was when it is called again: references and points that are there are not drawn anew (remove OUT
# to begin from nothing). At the end those charts are named in which the scene as it is is not on the front. --quick: small pictures of few rays, some minutes.
# --peers: the folder of the programs that bench/field/run.sh compares with (or the variable VTS_PEERS); without it that comparison is left out.
set -eu -o pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
. "$here/bench/options.sh"
vts=$here/build/vts quick='' only='' peers=${VTS_PEERS:-}
read_options "quick! only vts peers" "[OUT]" "$@"
out=${operands[0]:-charts-out} size=320x240 rays=256 repeat=3 small=400x300
[ -z "$quick" ] || size=96x72 rays=64 repeat=1 small=200x150
vts=$(readlink -f "$vts") peers=${peers:+$(readlink -f "$peers")}
[ -x "$vts" ] || { echo "$0: no program $vts" >&2; exit 2; }
mkdir -p "$out/references"
out=$(readlink -f "$out")
cd "$here"
failed=''

# reference SCENE-FILE NAME: two pictures of different seeds, whose difference is their noise.
reference() {
  local seed
  for seed in 1 2; do
    [ -s "$out/references/$2-$seed.exr" ] || nice "$vts" reference "$1" -s "$size" --samples $((rays / 2)) --seed $seed --float-type float \
      --allow-read examples -o "$out/references/$2-$seed.exr" --progress none 2>"$out/said" || return 1
  done
}

# chart NAME SCENE OPTION…
chart() {
  local name=$1 scene=$2
  shift 2
  is_wanted "$name" || return 0
  local stem=${scene##*/} given=() frames=''
  for word in "$@"; do [ "$word" = --frames ] && frames=1; done
  if [ -z "$frames" ]; then
    reference "$scene" "${stem%.vts}-$size-$rays" || { echo "$name: no reference: $(head -n 1 "$out/said")" >&2; failed+=" $name"; return 0; }
    for seed in 1 2; do given+=(--reference "$out/references/${stem%.vts}-$size-$rays-$seed.exr"); done
  else
    given=(--samples "$rays" --keep "$out/references/$name-$size-$rays")
  fi
  echo "== $name"
  nice "$vts" chart "$scene" -s "$size" "${given[@]}" --repeat $repeat --resume --progress none --allow-read examples "$@" -o "$out/$name.svg" 2>"$out/said" ||
    { echo "$name: $(grep error "$out/said" | head -n 1)" >&2; failed+=" $name"; }
}

errors=max_error=8/255,4/255,2/255,1/255,0.5/255
charts=bench/charts
lawn=examples/tufts.vts
[ -z "$quick" ] || lawn=$charts/grass.vts
#     name               scene                  what changes
chart max_error          $lawn                  --sweep $errors --sweep samples=1,4,16,64
chart detail             $lawn                  --methods detail --sweep max_error=4/255,1/255
# The next ones are about voxels.
chart resolution         $lawn                  --set detail=voxels --sweep texel.resolution=16,32,64,128,256
chart opacity            $lawn                  --set detail=voxels --methods opacity_model --sweep max_error=4/255,1/255
chart quadrature         $lawn                  --set detail=voxels --methods quadrature --sweep max_error=4/255,1/255
chart ray_path           $lawn                  --set detail=voxels --methods ray_path --sweep max_error=4/255,1/255
chart shadow_aperture    $lawn                  --set detail=voxels --sweep shadow_aperture=1,1.5,2,3,5,10
chart wind               $charts/gusts.vts      --frames 1-4 --sweep max_error=4/255,2/255,1/255 --sweep samples=4,16,64 --axes cpu_s,flicker
chart terrain            $charts/land.vts       --methods terrain.detail=auto,full --sweep max_error=4/255,2/255,1/255
chart cloud_rays         $charts/one_cloud.vts  --sweep volume.rays=1000,10000,100000,1000000 --methods volume.storage=isotropic,directional
chart cloud_orders       $charts/one_cloud.vts  --sweep volume.orders=1,2,4,8,16,all
chart cloud_error        $charts/one_cloud.vts  --sweep $errors
chart cloud_method       $charts/one_cloud.vts  --methods volume.method=path --sweep volume.rays=1,4,16,64
chart isosurface         $charts/fractal.vts    --set samples=1 --methods isosurface.method=auto,interval,reduced_affine,reduced_affine_optimised
chart isosurface_detail  $charts/fractal.vts    --methods isosurface.detail=auto,full --sweep max_error=4/255,2/255,1/255
chart anti_aliasing      $charts/room.vts       --sweep samples=1,4,16,64,256 --sweep $errors
rm -f "$out/said"

# Beside other programs, on the same machine in the same run.
peer() { # NAME COMMAND…
  local name=$1
  shift
  is_wanted "$name" || return 0
  echo "== $name"
  "$@" >"$out/$name.txt" 2>&1 || { echo "$name: $(tail -n 1 "$out/$name.txt")" >&2; failed+=" $name"; }
}
if command -v povray >/dev/null; then
  peer povray_isosurface nice bench/isosurface.sh "$vts" "$small" $repeat
else
  echo "povray_isosurface: left out, there is no program povray"
fi
if [ -f "$peers/ref_field.c" ]; then
  peer embree_field nice bench/field/run.sh ${quick:+--quick} --runs $repeat --vts "$vts" --scenes "lawn orchard forest" ${quick:+--size 192x144} "$peers" "$out/field"
else
  echo "embree_field: left out, no ref_field.c in '$peers' (--peers FOLDER)"
fi

for numbers in "$out"/*.csv; do
  [ -e "$numbers" ] || continue
  awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i } NR == 2 && $at["default"] == 1 && $at["front"] == 0 { exit 1 }' "$numbers" || echo "not on the front: $(basename "${numbers%.csv}")"
done
[ -z "$failed" ] || { echo "failed:$failed" >&2; exit 1; }
