#!/usr/bin/env bash
# terrain.sh [VTS]: pictures of a map of 10,801 x 10,801 posts (nine files of SRTM's kind, three degrees, made by make_terrain): a row of
# doc/terrain.md's table for each view: processor seconds, seconds in all, the largest memory, triangles drawn.
set -eu -o pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
vts=${1:-$root/build/vts}
folder=${TERRAIN_MAP:-$(mktemp -d)}
[ -n "${TERRAIN_MAP:-}" ] || trap 'rm -rf "$folder"' EXIT
[ -f "$folder/N45E007.hgt" ] || "$root/build/bench/make_terrain" "$folder"

cat > "$folder/view.vts" <<'END'
#declare Land = terrain {
  heightmap "N47E007.hgt", "N47E008.hgt", "N47E009.hgt", "N46E007.hgt", "N46E008.hgt", "N46E009.hgt", "N45E007.hgt", "N45E008.hgt", "N45E009.hgt"
}
object { Land texture { pigment { slope y color_map { [0.8 rgb <0.4, 0.38, 0.34>] [0.9 rgb <0.16, 0.22, 0.09>] } } } }
light_source { 1e7*<1, 0.5, 0.6> rgb 1.2 parallel point_at 0 }
background { rgb <0.5, 0.65, 0.85> }
#declare Eye = <1000, 0, 500>;
#declare Eye = <Eye.x, terrain_height(Land, Eye) + Above, Eye.z>;
#if (Down) camera { location Eye look_at <0, 0, 600> right x*image_width/image_height angle 60 }
#else camera { location Eye look_at Eye + <0.3, -Tilt, 1> right x*image_width/image_height angle 60 } #end
END

row() { # NAME ABOVE TILT DOWN SIZE [MORE]
  local name=$1 above=$2 tilt=$3 down=$4 size=$5
  shift 5
  if ! /usr/bin/time -f '%U %S %e %M' -o "$folder/cost" nice "$vts" render "$folder/view.vts" -D "Above=$above" -D "Tilt=$tilt" -D "Down=$down" -s "$size" \
    -o "${PICTURES:-$folder}/$name.png" --progress none --report "$folder/report.json" "$@" > "$folder/said" 2>&1; then
    cat "$folder/said" >&2
    exit 1
  fi
  awk -v name="$name" -v size="$size" '{ printf "| %s | %s | %.1f | %.1f | %.0f MB |\n", name, size, $1 + $2, $3, $4 / 1000 }' "$folder/cost"
}

echo '| view | pixels | CPU seconds | seconds | memory |'
echo '|---|---|---|---|---|'
row walker 2 0.05 0 640x360
row flight 1500 0.3 0 640x360
row space 400000 0 1 640x360
[ -n "${QUICK:-}" ] || row large 1500 0.3 0 1920x1080
