#!/usr/bin/env bash
# library.sh [VTS [ground|trees]]: the texels of the standard library by their defaults at 128 voxels along the longest side: a row for each of the
# tables of doc/ground.md or doc/vegetation.md: voxels of all levels, memory, processor seconds of reading the file and building.
set -eu -o pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
vts=${1:-$root/build/vts}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

row() { # FILE MACRO [(ARGUMENTS)]
  printf '#include "%s"\n#declare One = %s%s\n' "$1" "$2" "${3-()}" > "$folder/one.vts"
  TIMEFORMAT=%U
  seconds=$( { time nice "$vts" texel "$folder/one.vts" One > "$folder/said"; } 2>&1)
  awk -v name="$2" -v seconds="$seconds" '/^stored:/ { printf "| `%s` | %s | %s %s | %.1f |\n", name, $2, $4, $5, seconds }' "$folder/said"
}

ground() {
  for kind in Lawn Meadow Dry_Grass Tussock Clover Reeds; do row grass.inc "${kind}_Texel"; done
  for kind in Daisy Poppy Cornflower Buttercup Dandelion Tulip; do row flowers.inc "${kind}_Texel"; done
  row fur.inc Fur_Texel '(<0.2, 0.1, 0>, <0.5, 0.3, 0.1>)'
  for kind in Moss Gravel Litter Needles; do row ground.inc "${kind}_Texel"; done
}

trees() {
  for kind in Oak Apple Birch Poplar Bush Palm Spruce Pine; do row trees.inc "${kind}_Texel"; done
  row trees.inc Spruce_Stand_1 ''
  for kind in Broad Pine; do row trees_ready.inc "${kind}_Stand_1" ''; done
}

echo '| texel | voxels | memory | CPU seconds |'
echo '|---|---|---|---|'
"${2:-ground}"
