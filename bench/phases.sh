#!/usr/bin/env bash
# phases.sh [OUT.png]: draws the phase functions of doc/volumes.md; needs gnuplot. Without OUT, the figure there.
set -eu -o pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
gnuplot -e "out='${1:-$here/doc/charts/phases.png}'" "$here/bench/phases.gp"
