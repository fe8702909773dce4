#!/usr/bin/env bash
# stitch.sh CASE VTS JSON_CHECK: parts of pictures joined, see harness.sh.
source "${BASH_SOURCE%/*}/harness.sh"

PARTS=(0,0,33,50 33,0,70,20 30,10,70,50)

# draw_parts SUFFIX OPTIONS…: p1 to p3, which overlap, and the whole as w.
draw_parts() {
  local suffix=$1 i=0 region
  shift
  run scene.vts -s 70x50 -o "w.$suffix" "$@"; want_status 0
  for region in "${PARTS[@]}"; do
    run scene.vts -s 70x50 -o "p$((++i)).$suffix" --region "$region" "$@"; want_status 0
  done
}

# The joined parts are the file that one machine writes, byte by byte.
case_same() {
  scene
  cat >>scene.vts <<'S'
#declare S = seed(1);
skin { surface { patch_grid 2, 2 function(u, v) { <3*u - 4, 0, 4*v - 2> } }
  texel { cyclic x + z layer { particles { count 5 { position <rand(S), 0, rand(S)> velocity y acceleration <rand(S), -0.5, 0> life 1 width 0.1, 0.02 } } texture { pigment { rgb y } } } }
  mapping { repeat <20, 20> height 0.3 } }
S
  local suffix
  for suffix in exr pfm png ppm pgm tif; do
    draw_parts $suffix --alpha -q draft
    run stitch p3.$suffix p1.$suffix p2.$suffix -o j.$suffix; want_status 0; want_empty out; want_empty err
    cmp -s w.$suffix j.$suffix || fail "$suffix: joined parts are not the whole"
  done
  cmp -s p1.pfm p2.pfm && fail "parts are equal"
  # Half colours keep company with channels of 32 bits.
  for suffix in half float; do
    draw_parts exr -q draft --float-type $suffix --aov depth,normal,albedo,position,object,uv,texel_level,samples
    run stitch p1.exr p2.exr p3.exr -o j.exr; want_status 0
    cmp -s w.exr j.exr || fail "further channels beside $suffix: joined parts are not the whole"
  done
}

# Where something flies through, no part knows less of it than the whole: it takes as many moments in each tile.
case_blurred() {
  scene
  cat >>scene.vts <<'S'
animation { shutter 1 }
sphere { <-3 + 8*clock, 1.2, 1>, 0.15 pigment { rgb <0.9, 0.9, 0.2> } }
box { <-1, 0, -1.2>, <-0.9, 0.8, -1.1> rotate 40*clock*y pigment { rgb z } }
S
  draw_parts pfm --clock 0 --alpha --max-error 0.02
  run stitch p3.pfm p1.pfm p2.pfm -o j.pfm; want_status 0
  cmp -s w.pfm j.pfm || fail "joined parts are not the whole"
  run scene.vts -s 70x50 -o sharp.pfm --clock 0 --shutter 0 --alpha --max-error 0.02; cmp -s sharp.pfm w.pfm && fail "nothing is blurred"
}

# A part is a picture like any other for those who do not stitch.
case_readable() {
  scene
  run scene.vts -s 70x50 -o w.ppm; run scene.vts -s 70x50 -o w.pfm
  run scene.vts -s 70x50 --region 0,0,70,50 -o all.ppm; run scene.vts -s 70x50 --region 0,0,70,50 -o all.pfm
  local suffix
  for suffix in ppm pfm; do
    run compare w.$suffix all.$suffix; want_status 0; want_in out 'rmse 0'
  done
  [ "$(sed -n 2p all.ppm)" = "70 50" ] && [ "$(sed -n 2p all.pfm)" = "70 50" ] || fail "the size is not in the second line"
  case "$(sed -n 3p all.pfm)" in -1.0*) ;; *) fail "the scale of a PFM is $(sed -n 3p all.pfm)" ;; esac
  run scene.vts -s 70x50 --region 10,20,30,45 -o p.exr; run info p.exr; want_in out '20 x 25'
  run stitch all.ppm -o j.ppm; want_status 0; cmp -s w.ppm j.ppm || fail "one part that is all is not the whole"
}

case_misfits() {
  scene
  draw_parts ppm
  run stitch p1.ppm p2.ppm -o j.ppm; want_status 2; want_in err 'parts are missing: --region 33,20,70,50 of 70 x 50 pixels'
  run stitch p2.ppm -o j.ppm; want_status 2; want_in err '--region 0,0,33,50, 33,20,70,50 of'
  # What it names is what fills the hole.
  run scene.vts -s 70x50 --region 33,20,70,50 -o hole.ppm; run stitch p1.ppm p2.ppm hole.ppm -o j.ppm; want_status 0
  cmp -s w.ppm j.ppm || fail "the named hole is not the hole"; rm j.ppm hole.ppm
  run stitch p1.ppm w.ppm -o j.ppm; want_status 2; want_in err "'w.ppm' does not say"
  run scene.vts -s 71x50 --region 33,0,70,50 -o other.ppm; run stitch p1.ppm other.ppm -o j.ppm; want_status 2; want_in err '71 x 50'
  run scene.vts -s 70x50 --region 33,0,70,50 -o other.ppm --seed 4; run stitch p1.ppm other.ppm -o j.ppm; want_status 2; want_in err 'has changed'
  run scene.vts -s 70x50 --region 33,0,70,50 -o other.ppm -D a=1; run stitch p1.ppm other.ppm -o j.ppm; want_status 2
  cp scene.vts second.vts; echo '// changed' >>second.vts
  run second.vts -s 70x50 --region 33,0,70,50 -o other.ppm; run stitch p1.ppm other.ppm -o j.ppm; want_status 2; want_in err 'has changed'
  run reference scene.vts -s 70x50 --region 33,0,70,50 --samples 1 -o other.ppm; run stitch p1.ppm other.ppm -o j.ppm; want_status 2
  # Pixels that say two things.
  head -c 200 p3.ppm >forged.ppm; tail -c +201 p3.ppm | tr '\0-\377' '\1-\377\0' >>forged.ppm
  run stitch p1.ppm p2.ppm forged.ppm -o j.ppm; want_status 2; want_in err 'overlap and differ at '
  run stitch p1.ppm p2.ppm gone.ppm -o j.ppm; want_status 3; want_in err gone.ppm
  run stitch p1.ppm p2.ppm p3.ppm -o nowhere/j.ppm; want_status 3
  run stitch p1.ppm p2.ppm p3.ppm -o j.xyz; want_status 3
  refused stitch; refused stitch p1.ppm; refused stitch p1.ppm -o j.ppm --wait x; refused stitch p1.ppm -o j.ppm -q draft; refused stitch p1.ppm -f 1 -o j.ppm
  local place
  for place in '0,0,33,51 of 70x50 0' '0,0,99999999,50 of 70x50 0' '5,0,38,50 of 36x50 0' '-3,0,30,50 of 70x50 0' '33,0,0,50 of 70x50 0' 'x' '' '0,0,33,50 of 0x0 0'; do
    sed "s/vts:part .*/vts:part $place/" p1.ppm >lie.ppm
    run stitch lie.ppm p2.ppm p3.ppm -o j.ppm; want_status 2; want_in err lie.ppm
  done
  [ ! -e j.ppm ] || fail "a picture of parts that do not fit"
}

case_frames() {
  cat >film.vts <<'S'
animation { frames 3 }
camera { location <0, 1.5, -4> look_at <0, 0.5, 0> }
light_source { <5, 10, -5> rgb 1 }
sphere { <clock, 0.5, 0>, 0.5 pigment { rgb <0.8, 0.2, 0.1> } }
S
  run film.vts -s 20x20 -o 'w.##.png'; run film.vts -s 20x20 --region 0,0,20,8 -o 'a.##.png'; run film.vts -s 20x20 --region 0,8,20,20 -o 'b.##.png'
  run stitch 'a.##.png' 'b.##.png' -o 'j.##.png' -f 1-3; want_status 0
  local n
  for n in 01 02 03; do cmp -s w.$n.png j.$n.png || fail "frame $n"; done
  run stitch a.01.png b.02.png -o j.png; want_status 2; want_in err 'its frame is 2, not 1'
  printf x >j.02.png; run stitch 'a.##.png' 'b.##.png' -o 'j.##.png' -f 2-3 --resume; want_status 0; [ "$(cat j.02.png)" = x ] || fail "--resume"
  run stitch 'a.##.png' 'b.##.png' -o 'j.##.png' -f 3-4; want_status 3; want_in err 'a.04.png'
}

# Parts may come while it waits.
case_wait() {
  scene
  draw_parts ppm
  mv p2.ppm late.ppm
  ( sleep 0.5; mv late.ppm p2.ppm ) &
  run stitch p1.ppm p2.ppm p3.ppm -o j.ppm --wait 60; want_status 0; cmp -s w.ppm j.ppm || fail "a part that comes late"
  wait
  run stitch p1.ppm p2.ppm never.ppm -o k.ppm --wait 0.4; want_status 3; want_in err "1 of 3 parts have not come, the first of them 'never.ppm'"
}

run_case
