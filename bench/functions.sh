#!/usr/bin/env bash
# functions.sh [BUILD]: points per second of functions in POV-Ray's function machine and in the tapes of vts, as CSV on stdout.
#
# What is compared: POV-Ray fills `image_map { function N, N { F(x, y, z) } }`, which runs F once for each of N² points on one
# processor while it reads the scene; user time of the program, less that with N = 2. vts runs the same text of F on the same
# points with its batch evaluator on one processor. Of three runs each the fastest counts. Where the processor has
# AVX2, tapes are compiled as in the library that the loader takes there (glibc-hwcaps). Needs povray and `ninja
# bench_functions bench_functions_v3` in BUILD.
set -eu -o pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${1:-$root/build}
bench=$build/bench/bench_functions compiled=x86-64
if grep -qw avx2 /proc/cpuinfo && [ -x "${bench}_v3" ]; then bench=${bench}_v3 compiled=x86-64-v3; fi
[ -x "$bench" ] || { echo "functions.sh: no program $bench" >&2; exit 2; }
command -v povray >/dev/null || { echo "functions.sh: no povray" >&2; exit 2; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
side=1000

# pov SIDE TEXT: user seconds of the fastest of three runs.
pov() {
  printf '#version 3.7;\n#include "functions.inc"\n%s\n#declare P = pigment { image_map { function %d, %d { F(x, y, z) } } }\n' "$2" "$1" "$1" >"$folder/f.pov"
  for _ in 1 2 3; do
    (TIMEFORMAT=%U; time povray "+I$folder/f.pov" -D -F -GA +W2 +H2 >/dev/null 2>&1) 2>&1
  done | sort -g | head -n 1
}

row() {
  local name=$1 text=$2 long short ours
  long=$(pov $side "$text")
  short=$(pov 2 "$text")
  printf '#version 3.7;\n#include "functions.inc"\n%s\nsphere { 0, 1 pigment { function { F(x, y, z) } } }\n' "$text" >"$folder/f.vts"
  ours=$("$bench" "$folder/f.vts" $side "$root/stdlib")
  awk -v name="$name" -v long="$long" -v short="$short" -v ours="${ours% *}" -v n=$((side * side)) \
    'BEGIN { p = long - short; if (p < 0.01) p = 0.01; printf "%s,%.3g,%.3g,%.1f\n", name, n / p, n / ours, p / ours }'
}

echo "# $(nproc) processors, $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1), load $(cut -d' ' -f1 /proc/loadavg), $side x $side points, tapes compiled for $compiled"
echo "function,povray_points_per_s,vts_points_per_s,ratio"
row polynomial '#declare F = function { x*x*x + 2*y*y - 0.3*x*y*z + 0.7*x - 1.1*y + 0.2 }'
row distance '#declare F = function { sqrt(pow(sqrt(x*x + y*y) - 0.5, 2) + z*z) - 0.1 }'
row nested '#declare A = function(x, y) { x*x + y*y } #declare B = function(x, y, z) { A(x, y) + A(y, z) } #declare F = function { B(x, y, z)*B(y, z, x) - A(x, z) }'
row select '#declare F = function { select(x - 0.5, y, x*y, y*y) + min(x, y, 0.3) + max(x, y)*abs(x - y) }'
row waves '#declare F = function { sin(3*x)*cos(2*y) + sin(x*y) }'
row exponential '#declare F = function { exp(-x*x - y*y)*ln(x + 1.5) + pow(x + 0.1, 1.7) }'
row noise '#declare F = function { f_noise3d(4*x, 4*y, z) }'
row scattered '#declare F = function { f_noise3d(4000*x, 4000*y, z) }'
row fractal '#declare F = function { f_noise3d(4*x, 4*y, z) + 0.5*f_noise3d(8*x, 8*y, z) + 0.25*f_noise3d(16*x, 16*y, z) }'
row torus '#declare F = function { f_torus(x, y, z, 0.5, 0.1) - 0.2*f_sphere(x, y, z, 0.3) }'
row loop '#declare F = function { sum(i, 1, 20, x*i + y/i) }'
