#!/usr/bin/env bash
# cloud.sh [OUT [path to vts [path tracer]]]: error against processor time of a cloud of 65 x 65 x 10 cells, as numbers (OUT/cloud.csv) and, with gnuplot, as a chart (OUT/cloud.svg).
# The tracer is a program of its own; cloud.py tells how it is called. Takes about a minute of one processor.
set -eu -o pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out=${1:-charts/cloud}
vts=${2:-$here/build/vts}
tracer=${3:-}
mkdir -p "$out"
python3 "$here/bench/cloud.py" "$vts" "$out" ${tracer:+--tracer "$tracer"} | tee "$out/cloud.txt"
if command -v gnuplot >/dev/null; then gnuplot -e "data='$out/cloud.csv'; out='$out/cloud.svg'" "$here/bench/cloud.gp"; fi
