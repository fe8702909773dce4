#!/usr/bin/env bash
# chart_cases.sh CASE VTS JSON_CHECK: one case about charts, see harness.sh.
source "${BASH_SOURCE%/*}/harness.sh"

# column NAME [ROW [FILE]]: a field of a chart's numbers; rows count from 1.
column() {
  awk -F, -v name="$1" -v row="${2:-1}" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i } NR == row + 1 { gsub(/"/, "", $at); print $at }' "${3:-chart.csv}"
}
want_column() { # NAME ROW VALUE
  [ "$(column "$1" "$2")" = "$3" ] || fail "'$call': $1 of row $2 is '$(column "$1" "$2")', not '$3'"
}
want_near() { # NAME ROW VALUE
  awk "BEGIN { d = $(column "$1" "$2") - $3; exit !(d < 2e-6 && d > -2e-6) }" || fail "'$call': $1 of row $2 is $(column "$1" "$2"), not $3"
}

# Pictures of one colour have errors that are known: 0, 0.1 and 0.3 in three frames, of which the mean square and the changes follow.
case_film() {
  echo 'background { rgb 0.5 } camera { location 0 look_at z }' >grey.vts
  echo 'animation { frames 3 clock 0, 1 } background { rgb (frame_number = 1 ? 0.5 : frame_number = 2 ? 0.6 : 0.8) } camera { location 0 look_at z }' >film.vts
  run render grey.vts -s 12x8 -o grey.pfm; want_status 0
  for n in 1 2 3; do cp grey.pfm grey$n.pfm; done
  run chart film.vts -s 12x8 --frames 1-3 --reference 'grey#.pfm' --sweep samples=1,2 --keep kept -o chart.svg --axes wall_s,flip; want_status 0
  want_column frames 1 3; want_near rmse 1 0.18257419; want_near rmse_measured 2 0.18257419; want_near flicker 1 0.15811388; want_near max 1 0.3
  want_in out flicker; want_file kept/plain-0003.png; want_file kept/samples-2-0001.png
  if command -v gnuplot >/dev/null; then
    for n in 'wall clock' 'mean FLIP' '3 frames'; do grep -qF "$n" chart.svg || fail "no '$n' in the plot"; done
  fi
  # Frame by frame alone, each is a picture that nothing comes before.
  run chart film.vts -s 12x8 --frames 3 --reference grey.pfm --sweep samples=1 -o chart.svg; want_status 0
  want_near rmse 1 0.3; want_column flicker 1 ''
  refused chart film.vts -s 12x8 --frames 3 --reference grey.pfm --sweep samples=1 --axes cpu_s,flicker; want_in err 'two or more'
  refused chart film.vts --sweep samples=1 --axes cpu_s,beauty; want_in err voxels_visited
  refused chart film.vts --sweep samples=1 --axes cpu_s
  run chart film.vts -s 12x8 --frames 1-3 --reference 'nogrey#.pfm' --sweep samples=1 -o chart.svg; want_status 3; want_in err 'nogrey1.pfm'
}

# Words of blocks: those of the scene, in the place of what they say.
case_blocks() {
  cat >fog.vts <<'S'
camera { location <0, 0.3, -4> look_at <0, 0.3, 0> }
light_source { <5, 10, -5> rgb 1 }
volume { box { -1, 1 } scattering rgb 2 rays 300 orders 2 step auto }
isosurface { function { y + 1 - 0.1*sin(9*x) } contained_by { box { <-2, -1.2, 1>, <2, -0.8, 1.5> } } pigment { rgb 0.5 } }
S
  local size='fog.vts -s 8x6 --samples 4'
  run chart $size --sweep volume.orders=1,2 --methods isosurface.method=interval,auto --keep kept -o chart.svg; want_status 0
  want_column method_value 2 interval; want_column value 3 2; want_column curve 4 'isosurface.method auto'
  want_column rmse_measured 1 "$(column rmse_measured 5)" # two is what the scene has
  [ "$(column rmse_measured 4)" != "$(column rmse_measured 5)" ] || fail "one order is as good as two"
  run render fog.vts -s 8x6 --set volume.orders=1 -o one.png; want_status 0
  run compare one.png kept/isosurface.method-auto-volume.orders-1.png --metric max; want_in out 'max 0'
  run render fog.vts -s 8x6 --set 'volume.step=0.5' --set volume.rays=500 -o other.png; want_status 0
  cmp -s one.png other.png && fail "settings of a block change nothing"
  # Before any picture is drawn.
  run chart $size --sweep volume.ordres=1,2; want_status 2; want_in err "no 'volume' that takes the word 'ordres'"
  run chart $size --sweep volume.orders=2,0.5; want_status 1; want_in err "'orders'"
  run chart $size --sweep skin.seed=1; want_status 2
  refused chart $size --sweep volume.orders=1,$; refused chart $size --sweep .orders=1; refused chart $size --sweep volume.=1; refused chart $size --methods volume.orders; want_in err 'volume.orders=VALUE'
  run check fog.vts --set volume.rays=auto; want_status 0
  run check fog.vts --set volume.rays=0; want_status 1; want_in err "fog.vts:3"
  run check fog.vts --set volume.rays=1e999; want_status 2
  run check fog.vts --set 'volume.rays=1 2'; want_status 1
}

# What was measured before the program was stopped is not measured again.
case_resume() {
  scene
  local options='scene.vts -s 24x18 --samples 4 -o chart.svg'
  run chart $options --sweep samples=1,2; want_status 0
  cp chart.csv before.csv
  run chart $options --sweep samples=1,4,2 --resume; want_status 0; want_in err '3 of 4 points'
  [ "$(wc -l <chart.csv)" = 5 ] || fail "four points are not there"
  want_column value 3 4
  [ "$(column render_cpu_s 4)" = "$(column render_cpu_s 3 before.csv)" ] || fail "the point was measured anew"
  want_column rmse 2 "$(column rmse 2 before.csv)"
  # Another size, other settings, a scene that was changed, a broken file: nothing is taken over.
  run chart $options --sweep samples=1,2 --resume -s 8x6; want_status 0; grep -q 'points are in' err && fail "points of another size were taken over"
  run chart $options --sweep samples=1,2 --resume; grep -q 'points are in' err && fail "points of another size were taken over"
  run chart $options --sweep samples=1,2 --resume --set max_error=1/10; grep -q 'points are in' err && fail "points of other settings were taken over"
  touch -d '1 hour' scene.vts
  run chart $options --sweep samples=1,2 --resume --set max_error=1/10; grep -q 'points are in' err && fail "points of another scene were taken over"
  touch -d '-1 hour' scene.vts
  printf 'curve,knob,"val\n"""",,,,\n\0\n,,,,' >chart.csv
  run chart $options --sweep samples=1,2 --resume; want_status 0; [ "$(wc -l <chart.csv)" = 4 ] || fail "a broken file was not written anew"
  # Stopped in the middle: the points so far are there, and nothing else is.
  rm -f chart.csv chart.svg
  "$vts" chart $options --sweep samples=$(seq -s, 60) --repeat 20 >out 2>err &
  local pid=$! waited=0
  until [ -s chart.csv ] || [ $waited = 600 ]; do sleep 0.05; waited=$((waited + 1)); done
  kill -s INT $pid
  wait $pid
  status=$? call='vts chart with SIGINT'
  want_status 130 0
  [ "$(wc -l <chart.csv)" -ge 2 ] || fail "no point is left"
  run chart $options --sweep samples=1 --repeat 20 --resume; want_status 0; want_in err 'points are in'
}

# A caption tells which program was measured, and where.
case_caption() {
  scene
  run chart scene.vts -s 24x18 --samples 4 --sweep samples=1,2 -o chart.svg; want_status 0
  command -v gnuplot >/dev/null || return
  for n in "$(column version 1)" "$(column commit 1)" "$(column compiler 1)" "$(column processor 1)" '24 x 18'; do grep -qF "$n" chart.svg || fail "no '$n' in the plot"; done
}

run_case
