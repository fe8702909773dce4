#!/bin/sh
# copies.sh [VTS]: memory and time of a picture with a million copies of a mesh of 10 000 triangles.
vts=${1:-build/vts}
picture=$(mktemp --suffix=.png)
/usr/bin/time -f '%M KiB  %U s user  %e s in all' "$vts" render "$(dirname "$0")/copies.vts" -o "$picture" --size 160x120 --progress none
rm -f "$picture"
