#!/usr/bin/env bash
# ground.sh [VTS]: the texels of grass.inc, flowers.inc, fur.inc and ground.inc by their defaults at 128 voxels along the longest side: a row
# of doc/ground.md's table for each: voxels of all levels, memory, processor seconds of reading the file and building.
set -eu -o pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
vts=${1:-$root/build/vts}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

row() { # FILE MACRO [ARGUMENTS]
  printf '#include "%s"\n#declare One = %s(%s)\n' "$1" "$2" "${3:-}" > "$folder/one.vts"
  TIMEFORMAT=%U
  seconds=$( { time nice "$vts" texel "$folder/one.vts" One > "$folder/said"; } 2>&1)
  awk -v name="$2" -v seconds="$seconds" '/^stored:/ { printf "| `%s` | %s | %s %s | %.1f |\n", name, $2, $4, $5, seconds }' "$folder/said"
}

echo '| texel | voxels | memory | CPU seconds |'
echo '|---|---|---|---|'
for kind in Lawn Meadow Dry_Grass Tussock Clover Reeds; do row grass.inc "${kind}_Texel"; done
for kind in Daisy Poppy Cornflower Buttercup Dandelion Tulip; do row flowers.inc "${kind}_Texel"; done
row fur.inc Fur_Texel '<0.2, 0.1, 0>, <0.5, 0.3, 0.1>'
for kind in Moss Gravel Litter Needles; do row ground.inc "${kind}_Texel"; done
