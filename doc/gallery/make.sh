#!/usr/bin/env bash
# make.sh [VTS]: draws every scene of examples/ and of doc/gallery/ small, as doc/gallery/NAME.jpg.
# VTS is the program; without it, the one in build/ is taken, else the newest in build*/.
set -eu -o pipefail
gallery=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$gallery/../..

find_program() {
  if [ -x "$root/build/vts" ]; then echo "$root/build/vts"; return; fi
  ls -t "$root"/build*/vts 2>/dev/null | head -n 1
}

# Not all pictures have one shape.
size_of() {
  case $1 in
    birches) echo 480x320 ;;
    meadow_ball) echo 400x400 ;;
    hillside | sundial) echo 480x320 ;;
    teddy) echo 480x480 ;;
    three_noises) echo 480x240 ;;
    bird) echo 400x300 ;;
    skies) echo 640x290 ;;
    fur) echo 448x252 ;;
    meadow) echo 512x288 ;;
    seasons) echo 480x278 ;;
    woods) echo 400x250 ;;
    species) echo 512x296 ;;
    tree) echo 400x320 ;;
    still_life) echo 400x300 ;;
    kinds_values) echo 560x370 ;;
    contents | deformed | forest | kinds | jitter | larches | superimposed) echo 640x360 ;;
    pinwheels) echo 560x350 ;;
    cloud | glade | lamps | orchard | planet) echo 480x300 ;;
    haze) echo 480x270 ;;
    head) echo 400x320 ;;
    smoke) echo 300x400 ;;
    shafts) echo 400x300 ;;
    *) echo 480x360 ;;
  esac
}

# Of films one moment.
clock_of() {
  case $1 in
    pinwheels) echo '--clock 0.1667' ;;
    wind) echo '--clock 0.3' ;;
    smoke) echo '--clock 0.5' ;;
  esac
}

# Of some, six moments on a sheet; or its cells.
frames_of() {
  case $1 in
    trees_rows) seq -s ' ' 48 ;;
    flag) echo '16 32 48 64 80 96' ;;
    reeds) echo '14 22 28 34 42 56' ;;
    aspens) echo '1 3 5 7 9 11' ;;
  esac
}

# Of some, which are shown as one picture too, the same as NAME_frames.jpg.
more_frames_of() {
  case $1 in
    forest) echo '1 48 96 144 192 240' ;;
    wind) echo '1 12 22 33 44 54' ;;
  esac
}

# Options of films whose scenes do not say how many frames there are.
film_of() {
  case $1 in
    forest) echo +KFF240 ;;
  esac
}

sheet_size_of() {
  case $1 in
    flag | wind) echo 256x192 ;;
    forest) echo 256x144 ;;
    trees_rows) echo 96x96 ;;
    *) echo 256x160 ;;
  esac
}

arrangement_of() {
  case $1 in
    trees_rows) echo '-tile 6x -geometry 84x84+1+1 -quality 68' ;;
    *) echo '-tile 3x -geometry +2+2 -quality 80' ;;
  esac
}

draw_sheet() { # SCENE PICTURE FRAMES…
  local scene=$1 picture=$2 folder frame
  shift 2
  folder=$(mktemp -d)
  for frame; do "$program" render "$scene" --size "$(sheet_size_of "$(basename "$scene" .vts)")" $(film_of "$(basename "$scene" .vts)") -f "$frame" --output "$folder/$(printf %03d "$frame")#.png" --progress none; done
  montage "$folder"/*.png $(arrangement_of "$(basename "$scene" .vts)") "$picture"
  rm -r "$folder"
}

program=${1:-$(find_program)}
[ -n "$program" ] || { echo "make.sh: no vts found; build it, or name it: make.sh path/to/vts" >&2; exit 2; }

for scene in "$root"/examples/*.vts "$gallery"/*.vts; do
  name=$(basename "$scene" .vts)
  picture=$gallery/$name.jpg
  if [ -n "$(frames_of "$name")" ]; then draw_sheet "$scene" "$picture" $(frames_of "$name")
  else "$program" render "$scene" --size "$(size_of "$name")" --output "$picture" --progress none $(clock_of "$name")
  fi
  [ -z "$(more_frames_of "$name")" ] || draw_sheet "$scene" "$gallery/${name}_frames.jpg" $(more_frames_of "$name")
  bytes=$(wc -c <"$picture")
  [ "$bytes" -lt 200000 ] || { echo "make.sh: $name.jpg has $bytes bytes; a picture of the gallery has less than 200000" >&2; exit 1; }
  echo "$name.jpg $bytes bytes"
done
