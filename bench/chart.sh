#!/usr/bin/env bash
# Charts of speed against accuracy: max_error, detail, opacity, ray path, quadrature and filtering for tufts.vts and meadow_ball.vts.
#
#   bench/chart.sh [folder [path to vts [WxH [rays a pixel of the reference [runs]]]]]
#
# Draws SCENE-KNOB.svg and SCENE-KNOB.csv into the folder (default: charts), from scratch but for references that are there already. The
# setting of the scene itself, with every knob at its default, is marked in each chart; at the end those charts are named in which it is not on the front.
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
folder=${1:-charts}
vts=${2:-$here/build/vts}
size=${3:-160x120}
rays=${4:-256}
runs=${5:-3}
sweep=max_error=8/255,4/255,2/255,1/255
mkdir -p "$folder"

for scene in tufts meadow_ball; do
  pictures=$folder/$scene
  common=("$here/examples/$scene.vts" -s "$size" --repeat "$runs" --keep "$pictures" --progress none)
  if [ -e "$pictures/reference-2.exr" ]; then
    reference=(--reference "$pictures/reference-1.exr" --reference "$pictures/reference-2.exr")
  else
    reference=(--samples "$rays")
  fi
  echo "$scene: max_error"
  "$vts" chart "${common[@]}" "${reference[@]}" --sweep "$sweep" -o "$folder/$scene-max_error.svg"
  reference=(--reference "$pictures/reference-1.exr" --reference "$pictures/reference-2.exr")
  echo "$scene: detail"
  "$vts" chart "${common[@]}" "${reference[@]}" --sweep "$sweep" --methods detail -o "$folder/$scene-detail.svg"
  # The others are about voxels, which are few where geometry is drawn itself.
  for knob in opacity_model ray_path quadrature filtering; do
    echo "$scene: $knob"
    "$vts" chart "${common[@]}" "${reference[@]}" --set detail=voxels --sweep "$sweep" --methods "$knob" -o "$folder/$scene-$knob.svg"
  done
done

# The seventh column tells of the front, in the row of the scene as it is.
for numbers in "$folder"/*.csv; do
  [ "$(sed -n 2p "$numbers" | cut -d, -f7)" = 1 ] || echo "not on the front: ${numbers%.csv}"
done
