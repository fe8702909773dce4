#!/usr/bin/env bash
# How long the lawn takes: 22,000 blades, 700 flowers, shadows, at 768 × 576.
#
#   bench/lawn.sh [path to vts] [runs]
#
# Prints wall and processor seconds and the largest resident size of each run, from the report, and the medians. Asked for: under
# 10 s of wall clock and 200 MB on two idle cores.
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
vts=${1:-$here/build/vts}
runs=${2:-3}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
field() { tr ',{' '\n\n' <"$1" | sed -n "s/^\"$2\":\([0-9.]*\)\$/\1/p" | head -n 1; }
median() { sort -n | awk '{a[NR] = $1} END {print a[int((NR + 1) / 2)]}'; }

echo "machine: $(nproc) processors, load $(cut -d' ' -f1 /proc/loadavg)"
for run in $(seq "$runs"); do
  "$vts" render "$here/examples/tufts.vts" -s 768x576 -o "$work/lawn.png" --report "$work/report.json" --progress none
  for name in wall_s cpu_s peak_rss_bytes; do field "$work/report.json" $name >>"$work/$name"; done
  echo "run $run: wall $(tail -n 1 "$work/wall_s") s, cpu $(tail -n 1 "$work/cpu_s") s, $(($(tail -n 1 "$work/peak_rss_bytes") / 1000000)) MB"
done
echo "median: wall $(median <"$work/wall_s") s, cpu $(median <"$work/cpu_s") s, $(($(median <"$work/peak_rss_bytes") / 1000000)) MB"
