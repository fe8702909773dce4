#!/usr/bin/env bash
# speed.sh [VTS] [RUNS]: time, memory and counts of rendering each example, as CSV on stdout. Of RUNS (3) runs the one with the
# least processor time is printed: other programs can only make a run slower.
set -eu -o pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
vts=${1:-$root/build/vts} runs=${2:-3}
[ -x "$vts" ] || { echo "speed.sh: no program $vts" >&2; exit 2; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# field NAME: the first number of that name in the report.
field() { grep -o "\"$1\":[0-9.]*" "$folder/report.json" | head -n 1 | cut -d: -f2; }

# One line: processor time first, for sorting.
measure() {
  "$vts" render "$1" --size "$2" --output "$folder/picture.ppm" --report "$folder/report.json" --progress none 2>/dev/null
  echo "$(field cpu_s),$(field wall_s),$(field build_s),$(field render_s),$(field peak_rss_bytes),$(field camera),$(field shadow),$(field voxels_visited)"
}

echo "# $("$vts" version), $(nproc) processors, $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), load $(cut -d' ' -f1 /proc/loadavg)"
echo "scene,size,cpu_s,wall_s,build_s,render_s,peak_rss_bytes,camera_rays,shadow_rays,voxels_visited"
for scene in "$root"/examples/*.vts; do
  for size in 240x180 480x360; do
    best=$(for ((i = 0; i < runs; i++)); do measure "$scene" "$size"; done | sort -t, -k1,1g | head -n 1)
    echo "$(basename "$scene"),$size,$best"
  done
done
