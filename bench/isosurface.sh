#!/usr/bin/env bash
# isosurface.sh [VTS] [WIDTHxHEIGHT] [RUNS]: processor seconds of isosurface.pov with vts and with POV-Ray at several settings, the least of
# RUNS (3), and how many pixels of the surface that vts finds are holes. Both take one sample a pixel. CSV on stdout.
set -eu -o pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
vts=${1:-$root/build/vts} size=${2:-800x600} runs=${3:-3}
[ -x "$vts" ] || { echo "isosurface.sh: no program $vts" >&2; exit 2; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
scene=$root/bench/isosurface.pov

# least COMMAND…: the least user and system time of its runs.
least() {
  local TIMEFORMAT='%U %S'
  for ((i = 0; i < runs; i++)); do { time "$@" >/dev/null 2>&1; } 2>&1; done | awk '{ print $1 + $2 }' | sort -g | head -n 1
}

# differ A B: pixels of two PPM pictures that are white in A and not in B, and the other way round; and those of A.
differ() {
  python3 - "$1" "$2" <<'END'
import sys
def pixels(name):
    data = open(name, "rb").read()
    words, at = [], 0
    while len(words) < 4:
        end = data.index(b"\n", at)
        words += data[at:end].split(b"#")[0].split()
        at = end + 1
    width, height = int(words[1]), int(words[2])
    return [v > 127 for v in data[-3 * width * height::3]]
a, b = pixels(sys.argv[1]), pixels(sys.argv[2])
print("%d,%d,%d" % (sum(x and not y for x, y in zip(a, b)), sum(y and not x for x, y in zip(a, b)), sum(a)))
END
}

echo "# $("$vts" version), $(povray --version 2>&1 | grep -o 'POV-Ray [0-9.]*' | head -n 1), $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), $size"
echo "program,max_gradient,accuracy,cpu_s,holes,extra,surface"
seconds=$(least "$vts" render "$scene" --size "$size" --samples 1 --output "$folder/vts.ppm" --progress none)
echo "vts,,,$seconds,$(differ "$folder/vts.ppm" "$folder/vts.ppm")"
for setting in "4 .01" "8 .001" "16 .001" "16 .0001"; do
  read -r gradient accuracy <<<"$setting"
  seconds=$(least povray +I"$scene" +O"$folder/pov.ppm" +FP File_Gamma=1 +W"${size%x*}" +H"${size#*x}" -A -D +WT2 Declare=Gradient="$gradient" Declare=Accuracy="$accuracy")
  echo "povray,$gradient,$accuracy,$seconds,$(differ "$folder/vts.ppm" "$folder/pov.ppm")"
done
