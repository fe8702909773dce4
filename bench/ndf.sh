#!/usr/bin/env bash
# ndf.sh [OUT.svg [path to bench_ndf]]: draws what bench_ndf.c prints; needs gnuplot. Without OUT, the figure of doc/texels.md.
set -eu -o pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out=${1:-$here/doc/gallery/ndf.svg}
program=${2:-$here/build/bench/bench_ndf}
data=$(mktemp)
trap 'rm -f "$data"' EXIT
"$program" >"$data"
gnuplot -e "data='$data'; out='$out'" "$here/bench/ndf.gp"
