#!/usr/bin/env bash
# film.sh CASE VTS JSON_CHECK: one case about films, see harness.sh.
source "${BASH_SOURCE%/*}/harness.sh"

# film [MORE]: four frames that say which they are.
film() {
  cat >film.vts <<S
animation { frames 4 fps 2 clock 0, 1 ${1:-} }
#debug concat("> ", str(frame_number, 0, 0), " ", str(clock, 0, 3), "\n")
camera { location <0, 1.5, -4> look_at <0, 0.5, 0> }
light_source { <5, 10, -5> rgb 1 }
sphere { <clock, 0.5, 0>, 0.5 pigment { rgb <0.8, 0.2, 0.1> } }
S
}
want_said() { [ "$(grep '^>' err | tr '\n' ' ')" = "$1" ] || fail "'$call' said $(grep '^>' err | tr '\n' ' ')"; }

case_frames() {
  film
  run film.vts -s 16x12 -o a.ppm; want_status 0; want_said '> 1 0.000 > 2 0.333 > 3 0.667 > 4 1.000 '
  want_only film.vts a1.ppm a2.ppm a3.ppm a4.ppm
  cmp -s a1.ppm a4.ppm && fail "nothing moves"
  run film.vts -s 16x12 -o b.ppm --frames 2-4x2,1; want_status 0; want_said '> 2 0.333 > 4 1.000 > 1 0.000 '
  local n
  for n in 1 2 4; do cmp -s a$n.ppm b$n.ppm || fail "frame $n is another picture when drawn with others"; done
  run check film.vts; want_status 0; want_said '> 1 0.000 '
  run check film.vts -f 2-3; want_said '> 2 0.333 > 3 0.667 '
  run run film.vts -f3; want_said '> 3 0.667 '
  run reference film.vts -s 8x6 --samples 1 -o r.ppm; want_status 0; want_said '> 1 0.000 '; want_file r.ppm
  run film.vts -s 16x12 -o c.ppm +KFF2 +KF3; want_status 0; want_said '> 1 0.000 > 2 3.000 '
  film 'cyclic on'
  run run film.vts -f 1-4; want_said '> 1 0.000 > 2 0.250 > 3 0.500 > 4 0.750 '
  # A film in an included text is found as well.
  mv film.vts part.inc; echo '#include "part.inc"' >film.vts
  run film.vts -s 8x6 -f 2; want_status 0; want_said '> 2 0.250 '; want_file film2.png
}

case_names() {
  film
  run film.vts -s 8x6 -f 3 -o 'x.####.ppm'; want_file x.0003.ppm
  run film.vts -s 8x6 -f 3 -o 'x#.a##.ppm'; want_file 'x#.a03.ppm'
  run film.vts -s 8x6 -f 3 +KFF12 -o 'y.ppm'; want_file y03.ppm
  run film.vts -s 8x6 -f 3; want_file film3.png
  mkdir 'f#'; run film.vts -s 8x6 -f 3 -o 'f#/z.ppm'; want_file 'f#/z3.ppm'
}

case_bad_frames() {
  film
  local frames
  for frames in 0 5 3-1 1- -3 x '' 1,,2 1-4x0 1-4x 2x2 99999999999 1-2-3 1.5; do refused render film.vts "--frames=$frames"; done
  refused render film.vts -f 2 --clock 0.5
  refused render film.vts --fps 0; refused render film.vts --fps=-2; refused render film.vts --fps nan
  refused render film.vts +SF5
  sed -i 1d film.vts; refused render film.vts -f 1; want_in err 'no animation'
  # What is wrong with a scene comes before that its film is not known.
  printf 'sphere { 0, Radius }\nanimation { frames 4 }\n' >wrong.vts
  run wrong.vts -f 1; want_status 1; want_in err "'Radius'"
  run wrong.vts -o wrong.mp4; want_status 1; want_in err "'Radius'"
  rm wrong.vts
  local wrong
  for wrong in 'frames 0' 'frames -3' 'frames 1.5' 'frames 1e10' 'fps 0' 'fps -1' 'clock 0' 'clock 1/0, 1' 'shutter 2' 'frames 2 frames 3' 'frame 3' \
    '} animation { frames 2'; do
    echo "animation { $wrong } sphere { 0, 1 }" >wrong.vts
    run wrong.vts -s 8x6; want_status 1; want_in err 'wrong.vts:1:'
  done
  # Very many frames cost nothing before they are drawn.
  echo 'animation { frames 1000000000 } sphere { 0, 1 }' >long.vts
  run long.vts -s 8x6 -f 999999999-1000000000; want_status 0; want_only film.vts wrong.vts long.vts long0999999999.png long1000000000.png
}

case_clocks() {
  film
  run film.vts -s 8x6 --clock 0.25 -o one.ppm; want_status 0; want_said '> 1 0.250 '; want_only film.vts one.ppm
  # Winds blow by seconds: those of a frame are those of its clock.
  cat >wind.vts <<'S'
animation { frames 5 fps 2 }
#declare S = seed(1);
camera { location <0, 1, -4> look_at <0, 0.3, 0> }
light_source { <5, 10, -5> rgb 1 }
#declare G = texel { layer { cylinder { <0.5, 0, 0.5>, <0.5, 1, 0.5>, 0.1 } texture { pigment { rgb 1 } } } }
skin { surface { patch_grid 1, 1 function(u, v) { <4*u - 2, 0, 4*v - 2> } } texel { G } mapping { repeat <6, 6> height 0.8 }
  wind_field { speed 1 gust { wavelength 3 amplitude 1 } } }
S
  run wind.vts -s 32x24 -o w.ppm -f 2,3; run wind.vts -s 32x24 -o w.ppm --clock 0.5; want_status 0
  cmp -s w2.ppm w3.ppm && fail "no wind blows"
  run wind.vts -s 32x24 -o other.ppm -f 3 --fps 1
  cmp -s w3.ppm other3.ppm && fail "--fps has no effect"
}

case_report_frames() {
  film
  run film.vts -s 8x6 -o a.ppm --report r.json; want_status 0
  "$json_check" scene version frames output wall_s parse_s build_s render_s <r.json || fail "report of a film"
  [ "$(grep -o '"frame":[0-9]*' r.json | tr '\n' ' ')" = '"frame":1 "frame":2 "frame":3 "frame":4 ' ] || fail "frames of the report: $(cat r.json)"
}

case_resume() {
  film
  run film.vts -s 8x6 -o a.ppm; cp a2.ppm kept; rm a3.ppm; : >a4.ppm; printf x >a2.ppm
  run film.vts -s 8x6 -o a.ppm --resume; want_status 0; want_said '> 3 0.667 > 4 1.000 '
  [ "$(cat a2.ppm)" = x ] || fail "--resume draws what is there"
  run film.vts -s 8x6 -o a.ppm --resume --report r.json; want_status 0; want_said ''
}

# Killed again and again, a film is whole in the end, and no file of it is ever half.
case_killed() {
  film
  run film.vts -s 200x150 -o whole.png; want_status 0
  local tries=0 picture
  until [ -s part4.png ] || [ $((++tries)) -gt 60 ]; do
    "$vts" film.vts -s 200x150 -o part.png --resume >out 2>err </dev/null &
    local pid=$!
    sleep "0.$((RANDOM % 25 + 4))"
    kill -s KILL $pid 2>/dev/null
    wait $pid 2>/dev/null
    for picture in part?.png; do
      [ ! -e "$picture" ] || cmp -s "$picture" "whole${picture#part}" || fail "$picture is not whole"
    done
  done
  run film.vts -s 200x150 -o part.png --resume; want_status 0
  for picture in 1 2 3 4; do cmp -s part$picture.png whole$picture.png || fail "frame $picture is another after a kill"; done
}

case_stopped() {
  film; sed -i 's/frames 4/frames 100000/' film.vts
  "$vts" film.vts -s 64x48 -o a.ppm --report r.json >out 2>err </dev/null &
  local pid=$! picture
  until [ -s a000003.ppm ]; do sleep 0.02; done
  kill -s INT $pid; wait $pid
  status=$? call='vts film.vts with SIGINT'
  want_status 130; want_in err interrupted; want_file r.json
  "$json_check" frames <r.json || fail "the report after an interruption"
  for picture in a*.ppm; do [ "$(stat -c %s "$picture")" = "$(stat -c %s a000001.ppm)" ] || fail "$picture is not whole"; done
  rm a*.ppm; want_only film.vts r.json
}

case_full_disk() {
  film
  ( ulimit -f 1; trap '' XFSZ; "$vts" film.vts -s 64x48 -o a.ppm >out 2>err </dev/null; echo $? >status )
  status=$(cat status); rm status; call='vts film.vts on a full disk'
  want_status 3; want_in err 'a1.ppm'; want_only film.vts
}

# What does not move is built once.
case_kept() {
  cat >kept.vts <<'S'
animation { frames 3 }
camera { location <0, 2, -40> look_at 0 }
light_source { <5, 10, -5> rgb 1 }
global_settings { detail voxels }
#declare Ball = texel { resolution 32 layer { sphere { 0.5, 0.4 } } }
#declare Drop = texel { resolution 32 layer { sphere { <0.5, 0.42 + clock/20, 0.5>, 0.4 } } }
skin { surface { patch_grid 1, 1 function(u, v) { <16*u - 8, 0, 16*v - 8> } } texel { Ball } texel { Drop } mapping { repeat <40, 40> height 0.4 } }
S
  run kept.vts -s 32x24 --report -; want_status 0
  local cached
  cached=$(grep -o '"name":"[A-Za-z]*"\|"cached":[a-z]*' out | sed 's/.*://; s/"//g' | tr '\n' ' ')
  [ "$cached" = 'Ball false Drop false Ball true Drop false Ball true Drop false ' ] || fail "built: $cached"
}

# A camera that comes nearer and goes again asks for voxels of other widths; what the first frame has built does for all of them, and each frame is
# the same picture with others or alone.
case_flight() {
  cat >flight.vts <<'S'
animation { frames 4 }
#declare Away = array[4] { 42, 39, 44, 36 };
camera { location <0, 0.4, -Away[frame_number - 1]> look_at 0 angle 20 }
light_source { <5, 10, -5> rgb 1 }
global_settings { detail voxels }
#declare Ball = texel { layer { sphere { 0.5, 0.4 } } }
skin { surface { patch_grid 1, 1 function(u, v) { <u - 0.5, 0, v - 0.5> } } texel { Ball } mapping { repeat <1, 1> height 1 } }
S
  run flight.vts -s 300x30 -o a.ppm --report -; want_status 0
  local needed
  needed=$(grep -o '"needed":[0-9]*\|"cached":[a-z]*' out | sed 's/.*://' | tr '\n' ' ')
  [ "$needed" = '15 false 17 true 15 true 18 true ' ] || fail "needed and kept: $needed"
  run flight.vts -s 300x30 -o b.ppm -f 3 --report -; want_status 0
  cmp -s a3.ppm b3.ppm || fail "frame 3 is another picture alone"
}

# Each phase is built once, and played as long as its share of the period.
case_phases() {
  cat >phases.vts <<'S'
animation { frames 12 fps 6 cyclic on }
camera { location <0, 3, -6> look_at 0 }
light_source { <5, 10, -5> rgb 1 }
global_settings { detail voxels }
#declare Ball = texel { resolution 32 phases 3 { layer { sphere { <0.5, 0.3 + 0.4*phase, 0.5>, 0.3 } texture { pigment { rgb 1 } } } } period 1 }
skin { surface { patch_grid 1, 1 function(u, v) { <4*u - 2, 0, 4*v - 2> } } texel { Ball } mapping { repeat <4, 4> height 1 } }
S
  run phases.vts -s 32x24 -o a.ppm --report r.json; want_status 0
  local cached n
  cached=$(grep -o '"cached":[a-z]*' r.json | sed 's/.*://' | tr '\n' ' ')
  [ "$cached" = 'false true false true false true true true true true true true ' ] || fail "built: $cached"
  for n in 02 07 08; do cmp -s a01.ppm a$n.ppm || fail "frame $n is of another phase than the first"; done
  for n in 03 05 09 12; do cmp -s a01.ppm a$n.ppm && fail "frame $n is of the first phase"; done
  cmp -s a03.ppm a10.ppm && cmp -s a05.ppm a12.ppm && ! cmp -s a03.ppm a05.ppm || fail "the second and the third phase"
  # As the texel would be that is written so.
  sed 's/phases 3 { layer {\(.*\)0.4\*phase\(.*\) } period 1/layer {\10.4*2\/3\2/; 1d' phases.vts >plain.vts
  run plain.vts -s 32x24 -o p.ppm; want_status 0; cmp -s p.ppm a05.ppm || fail "the third phase is not that texel"
  sed -i 's/period 1/period 0.9/' phases.vts; run check phases.vts; want_status 0; want_in err "phases.vts:5:"; want_in err "'period' is taken as 1"
}

# A wind of a film that goes round: at the end it is as at the beginning.
case_cyclic_wind() {
  cat >wind.vts <<'S'
animation { frames 16 fps 8 cyclic on }
#declare W = wind_field { direction <1, 0, 0.3> speed 4 gust { wavelength 3 amplitude 0.6 sharpness 2 } turbulence { amplitude 0.25 scale 3 octaves 3 seed 2 } }
#declare F = wind_at(W, <1, 2, 3>, 2) - wind_at(W, <1, 2, 3>, 0);
#debug concat("> ", str(vlength(F), 0, 9), " ", str(vlength(wind_at(W, <1, 2, 3>, 1) - wind_at(W, <1, 2, 3>, 0)) > 0.01, 0, 0), "\n")
sphere { 0, 1 }
S
  run check wind.vts; want_status 0; want_said '> 0.000000000 1 '; want_in err 'speed of 4 is taken as 4.5, so that whole waves pass (3 of them)'
  sed -i 's/speed 4 /speed 4.5 /' wind.vts; run check wind.vts; want_status 0; grep -q warning err && fail "a warning without need"
  sed -i 's/ cyclic on//; s/speed 4.5/speed 4/' wind.vts; run check wind.vts; want_status 0; grep -q warning err && fail "a warning without a cycle"
}

case_warned_once() {
  film; echo 'sphere { <0, -9, 0>, 1 uv_mapping }' >>film.vts
  run film.vts -s 8x6; want_status 0
  [ "$(grep -c "'uv_mapping' is not modelled" err)" = 1 ] || fail "a warning of each frame: $(cat err)"
}

# Waits grow by an eighth and more: also where a busy machine hardly lets a run begin, one gets its time in the end.
sleep_hundredths() { sleep "$(($1 / 100)).$(printf %02d $(($1 % 100)))"; }

# kill_and_resume PICTURE LEFT LEAST OPTION…: draws PICTURE, killed again and again at random moments; it comes out as whole.EXTENSION. Some kill
# must have left more than LEAST bytes in LEFT. All begins again where chance let the picture end before anything was left.
kill_and_resume() {
  local picture=$1 left=$2 least=$3 kept=0 rounds=0 tries wait pid
  shift 3
  until [ $kept = 1 ] || [ $((++rounds)) -gt 10 ]; do
    rm -f "$picture"; tries=0 wait=2
    until [ -s "$picture" ] || [ $((++tries)) -gt 40 ]; do
      "$vts" "$@" -o "$picture" --resume --report r.json >out 2>err </dev/null &
      pid=$!
      sleep_hundredths $((RANDOM % 10 + wait))
      wait=$((wait + 3 + wait / 8))
      kill -s KILL $pid 2>/dev/null
      wait $pid 2>/dev/null
      [ -s "$left" ] && [ "$(stat -c %s "$left")" -gt "$least" ] && kept=1
    done
    [ -s "$picture" ] || fail "no picture after $tries kills"
    cmp -s "$picture" "whole.${picture##*.}" || fail "another picture after $tries kills"
  done
  [ $kept = 1 ] || fail "nothing was kept"
}

# A picture that is killed again and again goes on where it was, and comes out the same.
case_resume_tiles() {
  scene
  run scene.vts -s 400x300 --samples 25 -o whole.png --report r.json; want_status 0
  grep -q '"kept_tiles":0' r.json || fail "tiles kept of nothing"
  kill_and_resume part.png part.png.tiles-vts 12000 scene.vts -s 400x300 --samples 25
  want_only scene.vts whole.png part.png r.json
  # With another setting nothing of it is taken.
  "$vts" scene.vts -s 400x300 --samples 25 -o other.png --resume >out 2>err </dev/null &
  local pid=$!
  until [ -s other.png ] || [ "$(stat -c %s other.png.tiles-vts 2>/dev/null || echo 0)" -gt 30000 ]; do sleep 0.01; done
  kill -s KILL $pid 2>/dev/null; wait $pid 2>/dev/null; rm -f other.png
  run scene.vts -s 400x300 --samples 4 -o other.png --resume --report r.json; want_status 0
  grep -q '"kept_tiles":0' r.json || fail "tiles of another picture"
  run scene.vts -s 400x300 --samples 4 -o same.png; cmp -s same.png other.png || fail "a mixture of two pictures"
  # Unfinished files of a process that is no more go when the picture is written again.
  "$vts" version >/dev/null & pid=$!; wait $pid
  local mark; mark=$(printf '%08x' 0)
  : >"same.png.tmp-vts-$mark-$pid-0"; run scene.vts -s 16x12 -o same.png; want_file "same.png"
  [ -e "same.png.tmp-vts-$mark-$pid-0" ] || fail "a file of another machine is gone"
}

# So does a blurred one, moment by moment and tile by tile.
case_resume_moments() {
  scene
  echo 'animation { shutter 1 } sphere { <2*clock, 1, -1>, 0.2 pigment { rgb z } }' >>scene.vts
  local call_options="scene.vts -s 160x120 --max-error 0.06 --clock 0 --aov depth"
  run $call_options -o whole.exr --report r.json; want_status 0
  grep -q '"kept_moments":0' r.json || fail "moments kept of nothing"
  kill_and_resume part.exr part.exr.moments-vts 0 $call_options
  want_only scene.vts whole.exr part.exr r.json
  # Broken or of another picture, a file of moments is not believed.
  local end pid
  for end in 1 2; do
    "$vts" $call_options -o other.exr --resume >out 2>err </dev/null &
    pid=$!
    until [ -s other.exr ] || [ -s other.exr.moments-vts ] || ! kill -0 $pid 2>/dev/null; do sleep 0.01; done
    kill -s KILL $pid 2>/dev/null; wait $pid 2>/dev/null; rm -f other.exr
    [ -s other.exr.moments-vts ] || continue
    [ $end = 1 ] && printf 'broken' | dd of=other.exr.moments-vts bs=1 seek=4000 conv=notrunc status=none
    if [ $end = 1 ]; then run $call_options -o other.exr --resume; cmp -s other.exr whole.exr || fail "broken moments were believed"
    else run $call_options --alpha -o other.exr --resume --report r.json; grep -q '"kept_moments":0' r.json || fail "moments of another picture"; fi
    rm -f other.exr*
  done
}

# A cloth's frame is the same whether it follows the one before, a state in the cache, or the beginning.
case_cloth() {
  cat >cloth.vts <<'S'
animation { frames 40 fps 10 }
camera { location <0, 0, -4> look_at 0 }
light_source { <-30, 40, -30>, rgb 1.2 }
#declare Breeze = wind_field { direction <1, 0, 0.4> speed 6 strength 2 turbulence { amplitude 0.6 scale 1.2 octaves 2 seed 7 } }
cloth { size <2, 1.5> grid 8, 6 pin left wind_field { Breeze } pigment { rgb 0.8 } }
S
  run cloth.vts -s 32x24 -o alone.ppm -f 35; want_status 0
  run cloth.vts -s 32x24 -o film.ppm -f 1-40x17; want_status 0
  cmp -s alone35.ppm film35.ppm || fail "frames that go on from each other differ from one alone"
  run cloth.vts -s 32x24 -o cold.ppm -f 35,3,31 --cache kept; want_status 0
  [ "$(ls kept | wc -l)" = 3 ] || fail "not one state for each second: $(ls kept)"
  run cloth.vts -s 32x24 -o warm.ppm -f 35 --cache kept; want_status 0
  cmp -s alone35.ppm cold35.ppm && cmp -s alone35.ppm warm35.ppm || fail "states of a cache change the cloth"
  local file
  for file in kept/*; do printf 'broken' >"$file"; done
  run cloth.vts -s 32x24 -o broken.ppm -f 35 --cache kept; want_status 0
  cmp -s alone35.ppm broken35.ppm || fail "a broken state was believed"
  sed 's/frames 40/frames 40 shutter 1/' cloth.vts >blurred.vts
  run blurred.vts -s 32x24 -o b.ppm -f 34-35; run blurred.vts -s 32x24 -o c.ppm -f 35 --cache kept
  cmp -s b35.ppm c35.ppm || fail "blurred, a frame alone is another"
}

# So is a frame of springs, and it differs from that of the wind alone.
case_springs() {
  cat >springs.vts <<'S'
animation { frames 40 fps 10 }
camera { location <0, 2, -4> look_at 0 }
light_source { <-30, 40, -30>, rgb 1.2 }
#declare Field = surface { patch_grid 6, 6 function(u, v) { <4*(u - 0.5), 0, 4*(v - 0.5)> } }
#declare Reeds = texel { layer { cylinder { <0.5, 0, 0.5>, <0.5, 1, 0.5>, 0.1 } texture { pigment { rgb 1 } } } }
skin { surface { Field } texel { Reeds } mapping { repeat 8 height 0.6 }
  wind_field { direction x speed 3 strength 1 gust { wavelength 5 amplitude 1 sharpness 2 } }
  springs { stiffness 40 damping 1 } }
S
  run springs.vts -s 32x24 -o alone.ppm -f 35; want_status 0
  run springs.vts -s 32x24 -o film.ppm -f 1-40x17; want_status 0
  cmp -s alone35.ppm film35.ppm || fail "frames that go on from each other differ from one alone"
  run springs.vts -s 32x24 -o cold.ppm -f 35,3,31 --cache kept; want_status 0
  [ "$(ls kept/*.springs | wc -l)" = 3 ] || fail "not one state for each second: $(ls kept)"
  run springs.vts -s 32x24 -o warm.ppm -f 35 --cache kept; want_status 0
  cmp -s alone35.ppm cold35.ppm && cmp -s alone35.ppm warm35.ppm || fail "states of a cache change the springs"
  sed '/springs {/s/springs.*/}/' springs.vts >bare.vts
  run bare.vts -s 32x24 -o bare.ppm -f 1,35; want_status 0
  cmp -s film01.ppm bare01.ppm || fail "springs do not begin as the wind bends them"
  cmp -s alone35.ppm bare35.ppm && fail "springs change nothing"
  sed 's/damping 1/damping 3/' springs.vts >other.vts
  run other.vts -s 32x24 -o other.ppm -f 35 --cache kept; cmp -s alone35.ppm other35.ppm && fail "damping changes nothing"
  "$vts" run --dump scene springs.vts | grep -q 'springs stiffness 40 damping 1' || fail "the scene does not tell its springs"
}

# A picture at a clock is exposed as the frame that has it.
case_shutter() {
  film 'shutter 0.5'
  run film.vts -s 32x24 -o a.ppm -f 2-3; want_status 0; want_said '> 2 0.333 > 3 0.667 '
  run film.vts -s 32x24 -o b.ppm --clock 1/3; [ "$status" = 0 ] || run film.vts -s 32x24 -o b.ppm --clock 0.333333333333333; want_status 0
  run compare a2.ppm b.ppm; grep -q 'rmse 0$\|rmse [0-9.]*e-\|rmse 0.000' out || fail "frame 2 is another picture by its clock: $(cat out)"
  run film.vts -s 32x24 -o c.ppm -f 2 --shutter 0; cmp -s a2.ppm c2.ppm && fail "nothing is blurred"
  run film.vts -s 32x24 -o d.ppm -f 2 --shutter 0.5; cmp -s a2.ppm d2.ppm || fail "the same shutter is another picture"
  refused render film.vts --shutter 1.5; refused render film.vts --shutter=-1; refused render film.vts --shutter nan
}

# Where the camera alone moves, the light in clouds is kept; where a lamp moves it is not; and frames are the same either way.
case_cloud() {
  cat >cloud.vts <<S
animation { frames 3 }
camera { location <clock, 1, -6> look_at 0 }
light_source { <5, 10, -5 + Lamp*clock> rgb 2 }
background { rgb <0.3, 0.5, 0.8> }
volume { density { function { max(0, 1 - x*x - y*y - z*z) } } box { -1, 1 } scattering rgb 4 rays 20000 }
S
  run cloud.vts -D Lamp=0 -s 32x24 -o a.ppm --max-error 0.05 --report -; want_status 0
  [ "$(grep -o '"volume_light_kept":[a-z]*' out | sed 's/.*://' | tr '\n' ' ')" = 'false true true ' ] || fail "light of clouds: $(cat out)"
  run cloud.vts -D Lamp=0 -s 32x24 -o b.ppm --max-error 0.05 -f 2; cmp -s a2.ppm b2.ppm || fail "frame 2 is another picture alone"
  run cloud.vts -D Lamp=3 -s 32x24 -o c.ppm --max-error 0.05 --report -
  grep -q '"volume_light_kept":true' out && fail "kept although a lamp moves"
}

# Trial pixels are drawn for the first of 24 frames, and each of them is the same picture with others or alone.
case_trials() {
  sed '/^#include/d' "${BASH_SOURCE%/*}/../../examples/jitter.vts" >turf.vts
  run turf.vts -s 64x48 +KFF30 -f 1-2 -o a.ppm --max-error 0.02 --report -; want_status 0
  [ "$(grep -o '"trials":[0-9]*' out | tr '\n' ' ' | sed 's/"trials":[1-9][0-9]* /yes /; s/"trials":0/no/')" = 'yes no ' ] ||
    fail "trial pixels: $(grep -o '"trials":[0-9]*' out)"
  cp out both
  run turf.vts -s 64x48 +KFF30 -f 26,2 -o b.ppm --max-error 0.02; want_status 0
  cmp -s a02.ppm b02.ppm || fail "frame 2 is another picture after frame 26"
  run turf.vts -s 64x48 +KFF30 -f 2 -o c.ppm --max-error 0.02 --report -; want_status 0
  # Triangles that the audit kept from the frame before are those that it would have made.
  [ "$(grep -o '"error_estimate":[0-9.]*' both | tail -n 1)" = "$(grep -o '"error_estimate":[0-9.]*' out)" ] || fail "frame 2 has another estimate alone"
  cmp -s a02.ppm c02.ppm || fail "frame 2 is another picture alone"
}

# A stand-in for ffmpeg: keeps what it is called with, and makes of its input the file that its last argument names.
encoder() {
  mkdir -p bin
  printf '#!/bin/bash\nprintf "%%s " "$@" >"%s/arguments"\nout=${!#}; cat >"${out#file:}"\n%s\n' "$PWD" "${1:-}" >bin/ffmpeg
  chmod +x bin/ffmpeg
}

case_movie() {
  film; encoder
  local PATH=$PWD/bin:$PATH
  run film.vts -s 15x12 -o a.ppm; rm a?.ppm
  run film.vts -s 15x12 -o 'b#.png'; want_status 0
  run film.vts -s 15x12 -o a.mp4 --fps 12; want_status 0
  cat b1.png b2.png b3.png b4.png | cmp -s - a.mp4 || fail "the film is not its frames"
  grep -q -- '-framerate 12 ' arguments || fail "frames a second: $(cat arguments)"
  grep -q 'pad=16:12' arguments || fail "an odd width: $(cat arguments)"
  want_only film.vts bin arguments b1.png b2.png b3.png b4.png a.mp4
  run film.vts -s 15x12 -o 'c:d.webm' -f 3,1; want_status 0
  cat b3.png b1.png | cmp -s - c:d.webm || fail "not the frames that were asked for"
  run film.vts -s 15x12 -o a.mp4 --resume; want_status 0; want_said ''
  sed -i 1d film.vts; refused render film.vts -s 15x12 -o x.mp4; want_in err 'no animation'
  want_only film.vts bin arguments b1.png b2.png b3.png b4.png a.mp4 c:d.webm
}

# Nothing is lost, and nothing is half.
case_movie_fails() {
  film
  local empty=$PWD/none sleeps
  mkdir none; PATH=$empty run film.vts -s 8x6 -o a.mkv; want_status 3; want_in err 'ffmpeg'; want_said ''; rmdir none; want_only film.vts
  encoder 'exit 1'
  PATH=$PWD/bin:$PATH run film.vts -s 8x6 -o a.mkv; want_status 3; want_in err 'a.mkv.frames'
  [ ! -e a.mkv ] || fail "half a film"
  want_file a.mkv.frames/00000004.png
  encoder
  PATH=$PWD/bin:$PATH run film.vts -s 8x6 -o a.mkv --resume; want_status 0; want_said ''; want_file a.mkv
  printf '#!/bin/sh\nexit 0 # reads nothing, makes nothing\n' >bin/ffmpeg
  PATH=$PWD/bin:$PATH run film.vts -s 300x200 -o d.mp4; want_status 3
  : >e.mp4.frames; PATH=$PWD/bin:$PATH run film.vts -s 8x6 -o e.mp4; want_status 3; want_said ''
  run film.vts -s 8x6 -o none/e.gif; want_status 3; want_said ''
}

case_gif() {
  film
  run film.vts -s 15x12 -o a.gif; want_status 0; want_only film.vts a.gif
  [ "$(head -c 6 a.gif)" = GIF89a ] || fail "no GIF"
  [ "$(od -An -v -tx1 a.gif | tr -d ' \n' | grep -o '21f904' | wc -l)" = 4 ] || fail "not four pictures"
  cp a.gif kept.gif
  ( ulimit -f 1; trap '' XFSZ; "$vts" film.vts -s 64x48 -o a.gif >out 2>err </dev/null; echo $? >status )
  status=$(cat status); rm status; call='vts film.vts to a GIF on a full disk'
  want_status 3; cmp -s a.gif kept.gif || fail "half a film"
}

run_case
