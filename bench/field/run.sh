#!/usr/bin/env bash
# A field of 22,400 blades of grass: speed and error of vts beside plain ray casting of triangles through Embree, and beside POV-Ray where it is installed.
#
#   bench/field/run.sh [--quick] [--size WxH] [--scenes "lawn orchard"] [--runs N] [--vts PATH] [PEERS_DIR [OUT]]
#
# PEERS_DIR (or the variable VTS_PEERS) holds the peer: ref_field.c, which makes the scenes and renders them through Embree, and
# to_vts.py and to_pov.py, which write them for vts and POV-Ray. Scenes: lawn, 1400 rigid copies; near, mid and far, the same blades bent over a skin and seen
# from three distances; orchard, 512 rigid trees; forest, more and larger ones (only if it is named). OUT (default: field-out) keeps what was built and the references, which are rendered once for each size;
# remove it to begin anew. --quick: 384 × 288 and coarser references; otherwise 768 × 576, half an hour.
#
# Times are user and system seconds of the whole process, the least of N runs (3), all with the same number of threads (2).
# Errors are RMSE over pixels and channels in linear light, clamped to [0, 1]. For each scene there are two truths, each known by two
# pictures of different seeds, so that their noise is known and subtracted: Embree's, whose bent blades have straight triangles,
# and `vts reference`, whose triangles are bent. The former is what the peer approaches, the latter what vts does; "facets" in the
# table tells how far the two are apart. Prints tables, writes OUT/field-WxH.csv and, with gnuplot, OUT/field-WxH.svg.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../options.sh"
scenes="lawn near mid far orchard" size='' quick='' truth=256 peer_truth=1024 runs=3 vts=$here/../../build/vts threads=2
read_options "quick! size scenes runs vts" "[PEERS_DIR [OUT]]" "$@"
[ -z "$quick" ] || truth=64
size=${size:-${quick:+384x288}}
size=${size:-768x576}
peers=${operands[0]:-${VTS_PEERS:-}}
out=${operands[1]:-field-out}
[ -f "$peers/ref_field.c" ] || { echo "$0: no ref_field.c in '$peers': name the peer's folder, or set VTS_PEERS" >&2 && exit 2; }
vts=$(readlink -f "$vts")
mkdir -p "$out/scenes" "$out/truth" "$out/pictures"
peer=$out/ref_field
[ "$peer" -nt "$peers/ref_field.c" ] || cc -O3 -march=native -std=gnu11 "$peers/ref_field.c" -o "$peer" -lembree3 -lm -lpthread
peer=$(readlink -f "$peer")
csv=$out/field-$size.csv

declare -A kind=([orchard]=orchard [forest]=forest [lawn]=lawn [near]=lawn_skin [mid]=lawn_skin [far]=lawn_skin)
declare -A view=([orchard]='' [forest]='' [lawn]='' [near]='' [mid]='-view 0 -40 12 0 15 2 40' [far]='-view 0 -400 60 0 17 2 30')

# peer SCENE SAMPLES SEED PICTURE
peer() {
  # shellcheck disable=SC2086
  "$peer" -scene "${kind[$1]}" ${view[$1]} -size "${size%x*}" "${size#*x}" -t $threads -spp "$2" -seed "$3" -o "$4" >"$out/log"
}

make_scene() { # the exporter wants both scenes side by side, for the blades that are not bent yet
  local folder=$out/scenes/$1
  [ -f "$folder.vts" ] && return
  mkdir -p "$folder"
  for s in lawn lawn_skin "${kind[$1]}"; do
    # shellcheck disable=SC2086
    "$peer" -scene "$s" ${view[$1]} -export "$folder/$s" >"$out/log"
  done
  python3 "$peers/to_vts.py" "$folder/${kind[$1]}" "$folder.vts"
}

reference() { # SCENE SEED PICTURE
  "$vts" reference "$out/scenes/$1.vts" -s "$size" -t $threads --samples "$truth" --seed "$2" -o "$3" --progress none 2>"$out/log"
}

make_truth() { # SCENE
  local s t=$out/truth/$1-$size
  for s in 1 2; do
    [ -f "$t-peer$s.pfm" ] || peer "$1" $peer_truth $((700 + s)) "$t-peer$s.pfm"
    [ -f "$t-vts$s.pfm" ] || { reference "$1" $((700 + s)) "$t-new.pfm" && mv "$t-new.pfm" "$t-vts$s.pfm"; }
  done
}

rmse() { "$vts" compare "$1" "$2" --metric rmse | sed -n 's/^rmse //p'; }

# error PICTURE TRUTH: |picture − truth|, the noise of the truth subtracted
error() {
  echo "$(rmse "$2"1.pfm "$1") $(rmse "$2"2.pfm "$1") $(rmse "$2"1.pfm "$2"2.pfm)" |
    awk '{e = ($1 * $1 + $2 * $2) / 2 - $3 * $3 / 2; printf "%.5f", (e > 0 ? sqrt(e) : 0)}'
}

# seconds COMMAND…: the least of several runs; runs of more than ten seconds are not repeated
seconds() {
  local best=999999 used i
  TIMEFORMAT='%U %S'
  for ((i = 0; i < runs; i++)); do
    used=$({ time "$@" >/dev/null 2>"$out/log"; } 2>&1 | awk 'NF == 2 {print $1 + $2}')
    best=$(echo "$best $used" | awk '{print $1 < $2 ? $1 : $2}')
    awk "BEGIN {exit !($used > 10)}" && break
  done
  echo "$best"
}

# point SCENE PROGRAM SETTING PICTURE SECONDS
point() {
  local t=$out/truth/$1-$size
  echo "$1,$2,$3,$5,$(error "$4" "$t-peer"),$(error "$4" "$t-vts")" | tee -a "$csv"
}

# Its usual settings of anti-aliasing; bent blades it has none of.
pov_points() { # SCENE
  local p=$out/pictures/$1-pov.exr used settings
  command -v povray >/dev/null && [ -f "$peers/to_pov.py" ] && [ "${kind[$1]}" != lawn_skin ] || return 0
  [ -f "$out/scenes/$1.pov" ] || python3 "$peers/to_pov.py" "$out/scenes/$1/${kind[$1]}" "$out/scenes/$1.pov"
  for settings in "-A" "+A0.3 +R3" "+A0.05 +R3" "+AM2 +A0.05 +R3" "+A0.0 +R4"; do
    # shellcheck disable=SC2086
    used=$(seconds povray "+I$out/scenes/$1.pov" "+O$p" +FE "+W${size%x*}" "+H${size#*x}" "+WT$threads" -D $settings)
    point "$1" povray "$settings" "$p" "$used"
  done
}

echo "scene,program,setting,cpu_s,rmse_to_straight,rmse_to_bent" >"$csv"
for scene in $scenes; do make_scene "$scene"; done
for scene in $scenes; do
  make_truth $scene
  t=$out/truth/$scene-$size
  echo "# $scene: facets $(awk "BEGIN {a = $(error "$t-peer1.pfm" "$t-vts"); b = $(rmse "$t-peer1.pfm" "$t-peer2.pfm"); e = a * a - b * b / 2; printf \"%.5f\", (e > 0 ? sqrt(e) : 0)}")," \
    "noise of the truths $(rmse "$t-peer1.pfm" "$t-peer2.pfm") and $(rmse "$t-vts1.pfm" "$t-vts2.pfm") between two"
  for n in 1 4 16 64 256; do
    used=$(seconds peer $scene $n 1 "$out/pictures/$scene-peer-$n.pfm")
    point $scene embree "$n samples" "$out/pictures/$scene-peer-$n.pfm" "$used"
  done
  pov_points $scene
  for detail in auto exact voxels; do
    for e in 0.03 0.01 0.0039 0.001; do
      p=$out/pictures/$scene-$detail-$e.pfm
      used=$(seconds "$vts" render "$out/scenes/$scene.vts" -s "$size" -t $threads --set detail=$detail --max-error $e -o "$p" --progress none)
      # what draws the same picture is no point of its own, and neither are the rest of its sweep
      [ $detail != auto ] && cmp -s "$p" "$out/pictures/$scene-auto-$e.pfm" && break
      point $scene "vts $detail" "max-error $e" "$p" "$used"
    done
  done
done
rm -f "$out/log"
command -v gnuplot >/dev/null && gnuplot -e "scenes='$scenes'; csv='$csv'; out='${csv%.csv}.svg'" "$here/plot.gp" && echo "curves: ${csv%.csv}.svg"
