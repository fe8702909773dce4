#!/usr/bin/env bash
# cli.sh CASE VTS JSON_CHECK: one case, see harness.sh.
source "${BASH_SOURCE%/*}/harness.sh"

case_help() {
  run; want_status 2; want_empty out; want_in err Usage
  run help compare; want_status 0; want_in out --diff
  local command
  for command in render check run texel chart; do
    run $command --help; want_status 0; want_empty err; want_in out "Usage: vts $command"; want_in out --include
    cp out first; run help $command; want_status 0; cmp -s first out || fail "help $command is not $command --help"
    run $command -h; want_status 0
  done
  run --help; want_status 0; want_empty err; want_in out render
  run help nonsense; want_status 2
  # Every option that help lists is known: with a wrong value it is that which is complained about.
  run render --help
  local option
  for option in $(grep -o -- '--[a-z-]*' out | sort -u); do
    run render "$option"
    grep -q 'unknown option\|not available' err && fail "help lists $option: $(cat err)"
  done
}

case_version() {
  run --version; want_status 0; want_empty err
  grep -qE '^vts [0-9]+\.[0-9]+\.[0-9]+' out || fail "version is '$(cat out)'"
}

case_usage() {
  scene
  refused render scene.vts --treads 3; want_in err "vts render: error: unknown option '--treads' (did you mean '--threads'?)"; want_in err "vts render --help"
  refused rendre scene.vts; want_in err "did you mean 'render'"
  refused render; refused check; refused run
  refused render scene.vts other.vts
  refused render scene.vts -t
  refused render scene.vts -y
  refused check scene.vts --alpha
  refused render scene.vts --alpha=1
  want_only scene.vts
}

case_values() {
  scene
  local option
  for option in -s64 -s0x3 -s6x -sx6 -s-1x4 -s1x2x3 -s99999999x2 --size= -t-1 -tx -t1.5 --clock=a --clock= --clock=nan -qfine \
    --max-error=0 --max-error=2 --max-error=1/0 --samples=0 -Dn -D=3 --region=1,2,3 --region=5,0,3,9 --region=0,0,9999,9999 \
    --progress=often --seed=-1 --set=x --exposure=inf --limit=loops --memory-limit=0 --memory-limit=3Q --memory-limit=-1G \
    --float-type=double; do
    refused render scene.vts "$option"
  done
  want_only scene.vts
}

case_povray() {
  scene
  run +Iscene.vts +W16 +H12 +Opicture +WT2 +A0.3 +P +FN
  want_status 0; want_in err "'+A0.3'"; want_in err "'+P'"; want_file picture.png
  run scene.vts Width=16 height=12 Output_File_Name=second.ppm Work_Threads=1 Antialias=On
  want_status 0; want_in err Antialias; want_file second.ppm
  [ "$(sed -n 2p second.ppm | head -c 5)" = "16 12" ] || fail "Width= and Height= were not obeyed"
  printf '#debug concat("> ", str(image_width,0,0), " ", str(clock,0,2), " ", str(n,0,0), "\\n")\n' >program.pov
  run run program.pov +W64 +H48 +K0.5 Declare=n=7
  want_status 0; want_in err '> 64 0.50 7'
  mkdir lib; echo '#declare N = 3;' >lib/n.inc
  printf '#include "n.inc"\n#debug concat("> ", str(N,0,0), "\\n")\n' >library.pov
  run run library.pov +Llib; want_status 0; want_in err '> 3'
  run run library.pov Library_Path=lib; want_status 0
  refused run program.pov Widht=3; want_in err "did you mean 'Width'"
  refused run program.pov +Znonsense
}

case_animation() {
  printf '#debug concat("> ", str(frame_number,0,0), " ", str(clock,0,2), "\\n")\nbackground { rgb clock }\n' >film.pov
  run check film.pov; want_in err '> 1 0.00' # a picture alone is the first of one
  run run film.pov; want_in err '> 0 0.00' # a program has none, as in POV-Ray
  run run film.pov +KFI0 +KFF4 +KI-1 +KF3; want_status 0
  [ "$(grep '^>' err | tr '\n' ' ')" = "> 0 -1.00 > 1 0.00 > 2 1.00 > 3 2.00 > 4 3.00 " ] || fail "clocks: $(cat err)"
  run run film.pov Initial_Frame=1 Final_Frame=4 Cyclic_Animation=on +SF2 +EF3; want_status 0
  [ "$(grep '^>' err | tr '\n' ' ')" = "> 2 0.25 > 3 0.50 " ] || fail "cyclic clocks: $(cat err)"
  run render film.pov +KFF10 +SF9 -s 8x6 -o f.ppm; want_status 0; want_file f09.ppm; want_file f10.ppm
  want_only film.pov f09.ppm f10.ppm
  run run film.pov +KFI1 +KFF10 +SF0.2 +EF0.35; want_status 0
  [ "$(grep '^>' err | tr '\n' ' ')" = "> 2 0.11 > 3 0.22 " ] || fail "shares: $(cat err)"
  run run film.pov +KFI-1.5 +KFF5.5 Frame_Step=2; want_status 0
  [ "$(grep '^>' err | tr '\n' ' ')" = "> 0 0.00 > 2 0.40 > 4 0.80 " ] || fail "every second frame: $(cat err)"
  refused run film.pov +KFF4 Frame_Step=0
  refused run film.pov +KFI5 +KFF2
  refused run film.pov +KFF3 +EF4
}

case_ini() {
  scene
  printf '; a comment\n\nWidth = 20 ; pixels\nHeight=10\n+Oini.ppm\nInput_File_Name="scene.vts"\nDisplay=Off\n[other]\nWidth=40\n' >job.ini
  run job.ini; want_status 0; want_in err Display; want_file ini.ppm
  [ "$(sed -n 2p ini.ppm | head -c 5)" = "20 10" ] || fail "job.ini was not obeyed"
  run 'job.ini[other]'; want_status 0
  [ "$(sed -n 2p ini.ppm | head -c 5)" = "40 10" ] || fail "job.ini[other] was not obeyed"
  run none.ini; want_status 3
}

case_missing_scene() {
  local command
  for command in render check run; do run $command none.vts; want_status 3; want_empty out; want_in err none.vts; done
  run none.vts; want_status 3
  want_only
}

case_empty_scene() {
  : >empty.vts
  run check empty.vts; want_status 0; want_empty out
  run render empty.vts -s 8x6 -o empty.ppm; want_status 0; want_in err warning; want_file empty.ppm
}

case_verdict() { # what voxels make of a checkered fence is told against the error that is accepted
  cat >fence.vts <<'SCENE'
camera { location <0, 2, -6> look_at 0 angle 40 }
light_source { <-3, 9, -6>, rgb 1 }
#declare Post = texel { bounds <0, 0, 0>, <1, 1, 1> resolution 8 layer { box { <0.2, 0, 0.2>, <0.8, 1, 0.5> } pigment { rgb 1 } } }
skin { surface { patch_grid 1, 1 function(u, v) { <4*(u - 0.5), 0, 4*(v - 0.5)> } } texel { Post } mapping { tile 1 height 1 } }
SCENE
  run render fence.vts -s 32x24 -o fence.ppm --set detail=voxels --report fence.json --max-error 1/255; want_status 0; want_in err "from the truth where max_error accepts 0.0039: voxels are seen"
  run render fence.vts -s 32x24 -o fence.ppm --set detail=voxels --report fence.json --max-error 1/255 --quiet; want_status 0; want_empty err
  run render fence.vts -s 32x24 -o fence.ppm --set detail=voxels --report fence.json; want_status 0; want_empty err
  run render fence.vts -s 32x24 -o fence.ppm --set detail=voxels --report fence.json --max-error 0.9; want_status 0; want_empty err
  run render fence.vts -s 32x24 -o fence.ppm --report fence.json; want_status 0; want_empty err
  run check --quiet /dev/null; want_empty err
}

case_binary_scene() {
  printf '\177ELF\0\1\2\377\376 sphere' >binary.vts
  local command
  for command in render check run; do run $command binary.vts; want_status 1 3; want_empty out; want_in err binary.vts; done
  want_only binary.vts
}

case_missing_include() {
  printf '\n#include "none.inc"\n' >scene.vts
  run check scene.vts; want_status 1; want_empty out; want_in err 'scene.vts:2:'; want_in err none.inc
  run render scene.vts -o a.png; want_status 1
  want_only scene.vts
}

case_unknown_word() {
  printf 'sphree { <0,0,0>, 1 }\n' >scene.vts
  run check scene.vts; want_status 1; want_in err 'scene.vts:1:1'; want_in err "sphere"
  grep -q "$(printf '\033')" err && fail "colours without a terminal"
  run scene.vts; want_status 1
  want_only scene.vts
}

case_settings() { # what --set asks for is known before the scene is, also where nothing is drawn
  scene
  for command in check run render reference; do
    run $command scene.vts --set foo=1; want_status 2; want_in err "no knob 'foo'"
    run $command scene.vts --set max_error=0; want_status 2; want_in err max_error
  done
  run check scene.vts --set max_error=1/100; want_status 0
}

case_channels() { # --aov
  scene
  run render scene.vts -s 16x12 -o a.exr --aov depth,normal,samples; want_status 0
  grep -q normal.X a.exr || fail "no channel normal.X in a.exr"
  refused render scene.vts -s 16x12 -o a.exr --aov ''
  run render scene.vts -s 16x12 -o b.exr --aov depth,foo; want_status 2; want_in err "no channel 'foo'"
  run render scene.vts -s 16x12 -o b.png --aov depth; want_status 2; want_in err 'only .exr'
  want_only scene.vts a.exr
}

case_preview() { # nobody listens at port 1
  scene
  run render scene.vts -s 16x12 -o a.ppm --preview 127.0.0.1:1; want_status 0; want_file a.ppm; want_in err 'no viewer answers'
  local word
  for word in nonsense '' host: :14158 host:0 host:70000 host:1x a:b:c; do refused render scene.vts -o b.ppm --preview "$word"; done
  want_only scene.vts a.ppm
}

case_compare() {
  scene
  run render scene.vts -s 24x18 -o a.png; want_status 0
  run render scene.vts -s 24x18 -o b.exr --exposure 1; want_status 0
  run render scene.vts -s 25x18 -o wide.png; want_status 0
  run compare a.png a.png; want_status 0; want_empty err
  printf 'rmse 0\npsnr inf\nflip 0\n' | cmp -s - out || fail "equal pictures: $(cat out)"
  run compare a.png b.exr --diff map.png --metric flip,max; want_status 0; want_file map.png
  grep -qE '^flip 0\.[0-9]+$' out && grep -qE '^max 0\.[0-9]+ at [0-9]+,[0-9]+$' out || fail "metrics: $(cat out)"
  run compare a.png b.exr --diff map.exr --json; want_status 0; want_file map.exr
  "$json_check" <out || fail "no JSON: $(cat out)"
  run compare a.png wide.png; want_status 2; want_in err 'different size'
  run compare a.png none.png; want_status 3; want_in err none.png
  mkfifo pipe
  run compare a.png pipe; want_status 3; want_in err 'no regular file'
  rm pipe
  run compare a.png scene.vts; want_status 3
  run compare a.png a.png --diff nowhere/map.png; want_status 3
  run compare a.png a.png --diff map.xyz; want_status 3
  refused compare a.png; refused compare a.png a.png a.png; refused compare a.png a.png --metric ssim; want_in err rmse
  refused compare a.png a.png -s 3x3
  want_only scene.vts a.png b.exr wide.png map.png map.exr
}

texel_scene() {
  cat >texels.vts <<'S'
#declare Ball = texel { bounds <0, 0, 0>, <1, 1, 2> cyclic x resolution 16
  layer { sphere { <0.5, 0.5, 1>, 0.3 } texture { pigment { rgb <0.8, 0.3, 0.1> } finish { specular 0.4 diffuse 0.5, 0.2 } } }
  layer { box { <0.1, 0, 0.2>, <0.2, 0.9, 1.5> } texture { pigment { rgb <0.1, 0.5, 0.2> } } } }
#declare Checked = texel { layer { sphere { 0.5, 0.4 } texture { pigment { checker rgb x, rgb y } } } }
#declare Both = texel { choose Ball, Checked }
#declare Trees = array[2] { Ball, Checked }
S
  cat >ground.inc <<'S'
global_settings { detail voxels }
camera { location <0, 2, -3> look_at 0 right x*image_width/image_height }
light_source { <-20, 30, -25> rgb 1 }
background { rgb <0.5, 0.7, 1> }
skin { surface { patch_grid 2, 2 function(u, v) { <4*u - 2, 0.2*sin(5*u), 4*v - 2> } } texel { Ball } mapping { repeat <3, 3> height 0.6 } }
object { Ball scale 0.5 translate <1, 0.5, -1> }
S
}

case_texel() {
  texel_scene
  run texel texels.vts Ball; want_status 0; want_empty err
  want_in out 'texel Ball: bounds <0, 0, 0>, <1, 1, 2>, cyclic: x'
  want_in out 'layer 2 of 2'; want_in out '8 x 8 x 16'; want_in out '1 x 1 x 1'; want_in out 'resolution: 16 asked, 16 built'; want_in out 'built in'
  grep -qE '^stored: [0-9]+ voxels, [0-9.]+ kB$' out || fail "no sum: $(cat out)"
  run texel texels.vts 'Trees[0]' -o ball.ppm -s 40x30; want_status 0; want_file ball.ppm
  [ "$(sed -n 2p ball.ppm)" = "40 30" ] || fail "the picture has not the size asked for"
  tail -c 3600 ball.ppm | od -An -tu1 -w3 -v | sort -u | wc -l | { read -r colours; [ "$colours" -gt 50 ]; } || fail "there is nothing in the picture"
  run texel texels.vts Checked; want_status 0; want_in out '128 built'
  # A sphere of radius 0.4 hides 0.503 of the unit square behind it.
  awk '$1 == 0 { ok = $NF > 0.48 && $NF < 0.53 && $(NF - 1) > 0.48 && $(NF - 1) < 0.53 } END { exit !ok }' out || fail "coverage: $(cat out)"
  run texel texels.vts Bal; want_status 2; want_empty out; want_in err "did you mean 'Ball'?"; want_in err 'Ball, Both, Checked, Trees[0], Trees[1]'
  run texel texels.vts Both; want_status 2; want_in err 'Ball, Checked'
  refused texel texels.vts; refused texel; refused texel texels.vts Ball Checked; refused texel texels.vts Ball --report r.json
  run texel none.vts Ball; want_status 3
  run texel texels.vts Ball --save no/such.vtx; want_status 3; want_empty out
  run texel texels.vts Ball -o no/such.png; want_status 3
  echo 'sphere { 0, }' >wrong.vts
  run texel wrong.vts Ball; want_status 1
  echo '#declare P = texel { layer { intersection { plane { y, 0 } plane { x, 0 } } } }' >endless.vts
  run texel endless.vts P --save p.vtx; want_status 1; want_in err 'endless.vts:1:'
  want_only texels.vts ground.inc ball.ppm wrong.vts endless.vts
}

case_info() {
  run info; want_status 2
  run info --help; want_status 0; want_in out 'Usage: vts info'; want_in out --json
  # A grid of longitudes and latitudes: 4 x 3 posts in cells of half a degree.
  printf 'NCOLS 4\nNROWS 3\nXLLCORNER 10\nYLLCORNER 50\nCELLSIZE 0.5\nNODATA_value -9999\n1 2 3 4\n5 6 7 -9999\n9 10 11 12.5\n' >grid.asc
  run info grid.asc; want_status 0; want_empty err
  want_in out 'grid.asc: map, ESRI ASCII grid'; want_in out '4 x 3'; want_in out '10.0000000 to 12.0000000'; want_in out '50.0000000 to 51.5000000'
  want_in out '1 to 12.5 m'; want_in out '1 posts (8.33 %)'
  run info --json grid.asc; want_status 0; "$json_check" <out || fail "no JSON: $(cat out)"
  want_in out '"columns":4'; want_in out '"west":10,'; want_in out '"registration":"area"'; want_in out '"highest":12.5'
  # Triangles: one of 3 x 4 / 2 with texture coordinates, and one without area, which does not count.
  printf 'v 0 0 0\nv 3 0 0\nv 0 4 -1\nv 6 0 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 2/2 4/2\n' >tri.obj
  run info tri.obj; want_status 0; want_in out 'tri.obj: mesh, obj'; want_in out '<0, 0, -1>, <3, 4, 0>'; want_in out 'uv          yes'
  run info --json tri.obj; want_status 0; "$json_check" <out || fail "no JSON: $(cat out)"
  want_in out '"triangles":1,"vertices":4,'; want_in out '"area":6.18465843'; want_in out '"parts_with_normals":0'
  echo 'ply no more' >cut.ply
  run info cut.ply; want_status 3; want_in err cut.ply
  # SRTM: big-endian, its place is its name; the same bytes under another name lie nowhere.
  printf '\0\1\0\2\200\0\377\377' >S01W180.hgt; cp S01W180.hgt nowhere.hgt
  run info S01W180.hgt; want_status 0; want_in out '2 x 2, 16-bit signed'; want_in out 'are points'; want_in out '-1 to 2 m'; want_in out '-180.0000000 to -179.0000000'
  run info nowhere.hgt; want_status 0; want_in out 'no place'
  # A picture, a texel, volumes, a geoid too short.
  printf 'P5\n3 2\n255\nabcdef' >grey.pgm
  run info grey.pgm; want_status 0; want_in out 'grey.pgm: picture, pgm'; want_in out '3 x 2, 1 channel, 8-bit unsigned'
  texel_scene
  run texel texels.vts Ball --save ball.vtx; want_status 0
  run info ball.vtx --json; want_status 0; "$json_check" <out || fail "no JSON: $(cat out)"; want_in out '"kind":"texel"'; want_in out '"name":"Ball"'
  printf '\0\2\0\1\0\1ab' >small.df3
  run info small.df3; want_status 0; want_in out '2 x 1 x 1, 8-bit unsigned'
  printf '12345678' >cube.raw
  run info cube.raw; want_status 0; want_in out '2 x 2 x 2, 8-bit'
  run info --json grid.asc small.df3; want_status 0; "$json_check" <out || fail "no JSON: $(cat out)"
  # What is wrong is named, the rest is told.
  printf 'a text' >text.tif; : >empty.asc; printf 'ncols 1000000000\nnrows 1000000000\n1' >huge.asc; printf '\0\2\0\1\0\1a' >cut.df3; printf 'x' >cut.gtx; mkdir folder.tif
  printf 'NanoVDB0\1\2\3\4\1\0\0\0' >cut.nvdb
  local file
  for file in text.tif empty.asc huge.asc cut.df3 cut.gtx folder.tif cut.nvdb none.hgt; do
    run info "$file"; want_status 3; want_empty out; want_in err "'$file'"
  done
  mkfifo pipe.tif; run info pipe.tif; want_status 3; want_in err 'no regular file'
  run info none.hgt grid.asc; want_status 3; want_in out 'grid.asc'; want_in err 'none.hgt'
}

case_texel_file() {
  texel_scene
  run texel texels.vts Ball --save ball.vtx; want_status 0; want_file ball.vtx
  run texel texels.vts Ball --save again.vtx -t 1; want_status 0
  cmp -s ball.vtx again.vtx || fail "the same texel gave other bytes"
  run texel texels.vts Checked --save checked.vtx; want_status 0; want_in err 'mean colour'
  { cat texels.vts; echo '#include "ground.inc"'; } >built.vts
  { echo '#declare Ball = texel { "ball.vtx" }'; echo '#include "ground.inc"'; } >loaded.vts
  run render built.vts -s 64x48 -o built.pfm; want_status 0
  run render loaded.vts -s 64x48 -o loaded.pfm --report report.json; want_status 0; want_empty err
  cmp -s built.pfm loaded.pfm || fail "a loaded texel is drawn otherwise than a built one"
  grep -q '"name":"Ball".*"cached":true' report.json || fail "not loaded: $(cat report.json)"
  echo '#declare B = texel { "ball.vtx" }' >again.vts
  run texel again.vts B --save third.vtx; want_status 0; want_in out 'loaded in'
  # In a skin a file's name stands where a texel's does.
  sed 's/texel { Ball }/texel { "ball.vtx" density 1 }/; s/object { Ball/object { texel { "ball.vtx" }/' ground.inc >inline.vts
  run render inline.vts -s 64x48 -o inline.pfm; want_status 0
  cmp -s built.pfm inline.pfm || fail "a texel named in the skin is drawn otherwise"
  # Damaged at any place, cut, not there, not allowed: the scene is wrong at that name.
  head -c 3000 ball.vtx >cut.vtx
  cp ball.vtx bent.vtx; printf 'altered' | dd of=bent.vtx bs=1 seek=2500 conv=notrunc 2>/dev/null
  mkdir far; cp ball.vtx far
  local name
  for name in cut bent none; do
    echo "#declare Ball = texel { \"$name.vtx\" }" >broken.vts
    run check broken.vts; want_status 1; want_in err "broken.vts:1:25: error"; want_in err "$name.vtx"
  done
  mkdir near; echo '#declare Ball = texel { "../far/ball.vtx" }' >near/scene.vts
  run check near/scene.vts; want_status 1; want_in err 'may not read'
  run check near/scene.vts --allow-read far; want_status 0
  echo '#declare Ball = texel { "ball.vtx" }' >near/scene.vts
  run check near/scene.vts -I far; want_status 0
}

case_cache() {
  texel_scene
  { cat texels.vts; echo '#include "ground.inc"'; } >scene.vts
  run render scene.vts -s 64x48 -o plain.pfm --cache off --report first.json; want_status 0
  grep -q '"cached":true' first.json && fail "cached without a cache"
  run render scene.vts -s 64x48 -o cold.pfm --cache kept --report cold.json; want_status 0; want_empty err
  grep -q '"cached":true' cold.json && fail "an empty cache gave a texel"
  run render scene.vts -s 64x48 -o warm.pfm --cache kept --report warm.json; want_status 0
  grep -q '"cached":true' warm.json || fail "nothing came from the cache: $(cat warm.json)"
  [ "$(ls kept | wc -l)" = 2 ] || fail "the cache holds $(ls kept)"
  # Another colour is the same geometry; another radius is not.
  sed 's/rgb <0.8, 0.3, 0.1>/rgb <0.1, 0.3, 0.9>/' scene.vts >blue.vts
  run render blue.vts -s 64x48 -o blue.pfm --cache kept --report blue.json; want_status 0
  grep -q '"cached":true' blue.json || fail "a colour made the cache useless"
  cmp -s blue.pfm warm.pfm && fail "the cache kept a colour"
  sed 's/, 0.3 }/, 0.31 }/' scene.vts >large.vts
  run render large.vts -s 64x48 -o large.pfm --cache kept --report large.json; want_status 0
  grep -q '"cached":true' large.json && fail "another radius came from the cache"
  # Another filter is another texel, and both stay.
  run render scene.vts -s 64x48 -o other.pfm --cache kept --report other.json --set filtering=published; want_status 0
  grep -q '"cached":true' other.json && fail "another filtering came from the cache"
  cmp -s other.pfm warm.pfm && fail "the filtering has no effect"
  run render scene.vts -s 64x48 -o again.pfm --cache kept --report again.json --set filtering=published; want_status 0
  grep -q '"cached":true' again.json || fail "the other filtering was not kept"
  cmp -s other.pfm again.pfm || fail "the cache mixes filters"
  # Broken files are as good as none, and are written anew.
  local file
  for file in kept/*; do printf 'broken' >"$file"; done
  run render scene.vts -s 64x48 -o healed.pfm --cache kept --report healed.json; want_status 0; want_empty err
  grep -q '"cached":true' healed.json && fail "a broken file was used"
  run render scene.vts -s 64x48 -o healed.pfm --cache kept --report healed.json
  grep -q '"cached":true' healed.json || fail "a broken file stayed"
  for file in cold warm healed; do cmp -s plain.pfm $file.pfm || fail "$file.pfm differs"; done
  # Several at once.
  rm -rf kept
  for file in 1 2 3 4; do "$vts" render scene.vts -t 1 -s 64x48 -o p$file.pfm --cache kept >/dev/null 2>p$file.err & done
  wait
  for file in 1 2 3 4; do cmp -s plain.pfm p$file.pfm || fail "process $file drew otherwise: $(cat p$file.err)"; done
  ls -A kept | grep -v '^[0-9a-f]\{32\}\.vtx$' && fail "left in the cache"
  echo file >plain
  run render scene.vts -s 64x48 -o a.pfm --cache plain; want_status 0; want_in err 'the cache stays as it is'
  refused render scene.vts --cache=
}

case_streams() {
  printf '#debug "one\\n"\n#warning "two\\n"\n#render "three\\n"\n' >program.vts
  run run program.vts; want_status 0; want_empty out; want_in err one; want_in err two; want_in err three
  printf '#debug "before\\n"\n#error "enough"\n' >program.vts
  run run program.vts; want_status 1; want_in err before; want_in err enough
}

case_declares() {
  printf '#debug concat("> ", str(n,0,2), " ", s, "\\n")\n' >program.vts
  run run program.vts -D n=2.5 --declare s=word; want_status 0; want_in err '> 2.50 word'
  run run -Dn=1 -Ds=x program.vts; want_status 0; want_in err '> 1.00 x'
}

case_unwritable() {
  scene
  run render scene.vts -s 8x6 -o no/such/picture.png; want_status 3; want_empty out; want_in err no/such
  mkdir folder.png
  run render scene.vts -s 8x6 -o folder.png; want_status 3
  run render scene.vts -s 8x6 -o a.ppm --report no/such.json; want_status 3
  want_only scene.vts folder.png
}

case_suffixes() {
  scene
  run render scene.vts -s 4096x4096 -o picture.xyz; want_status 2 3; want_in err xyz
  run render scene.vts -s 4096x4096 -o picture; want_status 2 3
  want_only scene.vts
  local suffix
  for suffix in png exr tif jpg hdr pfm ppm; do run render scene.vts -s 8x6 -o a.$suffix; want_status 0; want_file a.$suffix; done
}

case_default_output() {
  scene
  mkdir deep; mv scene.vts deep
  run deep/scene.vts -s 8x6; want_status 0; want_empty out; want_file scene.png
  want_only deep scene.png
}

case_threads() {
  scene
  local n
  for n in 1 2 3; do run render scene.vts -s 61x47 -t $n -o $n.exr --float-type float; want_status 0; done
  cmp -s 1.exr 2.exr && cmp -s 1.exr 3.exr || fail "the number of threads changes the picture"
}

case_repeatable() {
  scene
  run render scene.vts -s 31x17 -o a.png; want_status 0; cp a.png first.png; sleep 1.1
  run render scene.vts -s 31x17 -o a.png; want_status 0
  cmp -s a.png first.png || fail "the same command gave another file"
}

case_progress() {
  scene
  run render scene.vts -s 8x6; want_status 0; want_empty out; want_empty err
  run render scene.vts -s 8x6 --progress none; want_empty err
  run render scene.vts -s 8x6 --progress plain; want_in err '%'
  grep -q "$(printf '\r')" err && fail "plain progress draws a bar"
  run render scene.vts -s 8x6 -v; want_in err scene.png
}

functions_of() { grep -o '"function_evaluations":[0-9]*,"function_rays":[0-9]*\|"missed_roots":[0-9]*,"guaranteed":[a-z]*' "$1"; }

case_report_functions() {
  scene
  printf 'camera { location <0, 0, -4> look_at 0 }\nisosurface { function { sqrt(x*x + y*y + z*z) - 1 } contained_by { sphere { 0, 2 } } }\n' >exact.vts
  printf 'camera { location <0, 0, -4> look_at 0 }\n#declare F = function { pigment { gradient y } }\nisosurface { function { F(x, y, z).red - 0.5 } max_gradient 2 }\n' >sampled.vts
  run render exact.vts -s 16x12 --threads 1 --report one.json; want_status 0
  run render exact.vts -s 16x12 --threads 2 --report two.json; want_status 0
  run reference exact.vts -s 4x3 --report exact.json; want_status 0
  run render sampled.vts -s 16x12 --report sampled.json; want_status 0
  functions_of one.json >one; functions_of two.json >two
  cmp -s one two || fail "depends on threads: $(cat one two)"
  grep -q '"missed_roots":0,"guaranteed":true' one || fail "not guaranteed: $(cat one)"
  grep -q '"function_rays":[1-9][0-9]*$' one || fail "no rays: $(cat one)"
  functions_of exact.json | grep -q '"function_evaluations":[1-9]' || fail "no evaluations of the reference"
  functions_of sampled.json | grep -q '"guaranteed":false' || fail "guaranteed without bounds"
  run render scene.vts -s 8x6 --report none.json; want_status 0
  functions_of none.json | grep -q '"function_evaluations":0,"function_rays":0' || fail "evaluations of no function"
}

case_report() {
  scene
  run render scene.vts -s 16x12 --report report.json; want_status 0; want_empty out
  "$json_check" scene version frames output wall_s cpu_s render_s peak_rss_bytes rays <report.json || fail "report.json"
  grep -q '"errors":\[{"stage":"samples","allowed":0.003922,"made":0.00[0-9]*,"unit":"lines of sight a pixel","count":[0-9.]*}' report.json || fail "errors of stages: $(grep -o '"errors":[^]]*' report.json)"
  run render scene.vts -s 16x12 --report -; want_status 0
  "$json_check" frames <out || fail "report on stdout"
  # A name that JSON must escape.
  cp scene.vts 'a "b\c.vts'
  run render 'a "b\c.vts' -s 8x6 -o a.ppm --report -; want_status 0
  "$json_check" frames <out || fail "report of a scene with a strange name"
}

interrupted_by() { # SIGNAL
  scene
  "$vts" render scene.vts -s 12000x8000 --samples 16 --max-error 1e-6 -o big.png >out 2>err &
  local pid=$!
  sleep 1
  kill -s "$1" $pid 2>/dev/null || fail "the rendering ended before the signal"
  wait $pid
  status=$? call="vts with SIG$1"
  want_status 130
  want_only scene.vts
}
case_interrupt() {
  interrupted_by INT
  interrupted_by TERM
  # A program that never ends by itself (but for the limit of loops).
  printf '#declare i = 0;\n#while (1)\n#declare i = i + 1;\n#end\n' >loop.vts
  "$vts" run loop.vts --limit loops=1000000000 >out 2>err &
  local pid=$!
  sleep 0.5
  kill -s INT $pid
  wait $pid
  status=$? call="vts run with SIGINT"
  want_status 130
}

case_memory_limit() {
  printf '#declare A = array[1000000];\n#for (I, 0, 999999) #declare A[I] = <1,2,3,4>; #end\n' >big.vts
  run run big.vts --memory-limit 1M --limit loops=2000000,array=2000000; want_status 4 2; want_in err memory
  run run big.vts --memory-limit 1M; want_status 4; want_in err memory-limit
}

case_full_output() {
  [ -w /dev/full ] || return
  "$vts" --version >/dev/full 2>err </dev/null
  status=$? call='vts --version >/dev/full'
  want_status 3; want_in err 'standard output'
  scene
  "$vts" render scene.vts -s 8x6 --report - >/dev/full 2>err
  status=$? call='vts render --report - >/dev/full'
  want_status 3
}

case_dump() {
  scene
  local stage
  for stage in tokens ast scene compiled; do
    run run scene.vts --dump=$stage; want_status 0; want_empty err
    [ -s out ] || fail "--dump=$stage printed nothing"
  done
  refused run scene.vts --dump=nonsense
  refused render scene.vts --dump=ast
}

# column NAME [ROW]: a field of chart.csv; rows count from 1.
column() {
  awk -F, -v name="$1" -v row="${2:-1}" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i } NR == row + 1 { gsub(/"/, "", $at); print $at }' chart.csv
}
want_column() { # NAME ROW VALUE
  [ "$(column "$1" "$2")" = "$3" ] || fail "'$call': $1 of row $2 is '$(column "$1" "$2")', not '$3'"
}
is_true() { awk "BEGIN { exit !($1) }" || fail "'$call': not $1"; }

case_chart() {
  scene
  cat >>scene.vts <<'S'
global_settings { max_error 1/60 detail voxels }
skin {
  surface { patch_grid 1, 1 function(u, v) { <4*u - 2, 0, 4*v - 2> } }
  texel { texel { layer { cone { <0.5, 0, 0.5>, 0.2, <0.5, 1, 0.5>, 0 } } resolution 32 } }
  mapping { repeat 6 height 0.3 }
}
S
  local options='scene.vts -s 40x30'
  # Two points and the scene as it is, which is one of them; with gnuplot's absence noted, no error.
  mkdir bin
  PATH=$folder/bin run chart $options --samples 16 --sweep max_error=1/60,1/2000 -o chart.svg --keep pictures; want_status 0
  want_in err 'gnuplot'; want_in err chart.csv; [ ! -e chart.svg ] || fail "a plot without gnuplot"
  want_in out 'max_error: 1/60'
  [ "$(wc -l <chart.csv)" = 4 ] || fail "chart.csv has not three points"
  want_column curve 2 max_error; want_column knob 2 max_error; want_column value 3 1/2000; want_column default 1 1; want_column default 2 0
  want_column rmse_measured 2 "$(column rmse_measured 1)"; want_column voxels_visited 2 "$(column voxels_visited 1)"
  want_column width 1 40; want_column height 1 30; want_column picture 1 pictures/plain.png
  is_true "$(column voxels_visited 3) > 1.2*$(column voxels_visited 2)"
  is_true "$(column cpu_s 3) > 0 && $(column wall_s 3) > 0 && $(column parse_wall_s 3) > 0 && $(column flip 3) > 0 && $(column psnr 3) > 10"
  # Errors are those of the pictures that are kept, but for the eight bits that these have; noise is that of the halves, and is taken off.
  is_true "($(column rmse 1)^2 + $(column reference_noise 1)^2 - $(column rmse_measured 1)^2)^2 < 1e-14"
  "$vts" compare pictures/reference-1.exr pictures/reference-2.exr --metric rmse >apart
  is_true "($(cut -d' ' -f2 apart)/2 - $(column reference_noise 1))^2 < 1e-12"
  local n
  for n in plain max_error-1_60 max_error-1_2000; do want_file pictures/$n.png; done
  cmp -s pictures/plain.png pictures/max_error-1_60.png || fail "the scene's own setting gives another picture"
  cp chart.csv first.csv
  # The halves that were kept are as good as new ones; and one picture has no known noise.
  run chart $options --reference pictures/reference-1.exr --reference pictures/reference-2.exr --sweep max_error=1/60,1/2000 -o chart.svg; want_status 0
  [ "$(column rmse 2)" = "$(awk -F, 'NR == 3 { print $16 }' first.csv)" ] || fail "references read again give another error"
  run chart $options --reference pictures/reference-1.exr --methods quadrature -o chart.svg --set max_error=1/100; want_status 0
  [ "$(wc -l <chart.csv)" = 6 ] || fail "four methods and the scene as it is are not five points"
  want_column reference_noise 1 ''; want_column curve 2 quadrature; want_column method_value 5 lune
  run chart $options --reference pictures/reference-1.exr --methods ray_path,opacity_model --sweep max_error=1/100,1/60 --set samples=1 --repeat 2
  want_status 0; want_file scene.csv; [ "$(wc -l <scene.csv)" = 14 ] || fail "two sets of three curves with two points each are not there"
  if command -v gnuplot >/dev/null; then
    want_file scene.svg; grep -q '</svg>' scene.svg || fail "the plot is not whole"
    for n in 'ray_path straight' 'Pareto front' 'as the scene has it' "$("$vts" --version)" 'its noise is not known' 'CPU seconds'; do grep -qF "$n" scene.svg || fail "no '$n' in the plot"; done
  fi
  # What cannot be.
  refused chart; refused chart $options; want_in err '--sweep'; refused chart $options --sweep max_error; refused chart $options --sweep max_error=
  refused chart $options --sweep opacity_modl=mean; want_in err "did you mean 'opacity_model'?"
  refused chart $options --sweep opacity_model=meen; want_in err "did you mean 'mean'?"
  refused chart $options --sweep max_error=2; refused chart $options --methods samples; want_in err '--sweep'; refused chart $options --methods quadratur
  refused chart $options --methods quadrature --sweep quadrature=lune; refused chart $options --methods quadrature -o chart.txt
  refused chart $options --methods quadrature --reference a --reference b --reference c; refused chart $options a.vts --methods quadrature
  refused chart $options --methods quadrature --cache c; refused render scene.vts --sweep max_error=1
  run chart $options --methods quadrature --reference none.exr; want_status 3
  run chart $options --methods quadrature -o no/such.svg; want_status 3
  run chart scene.vts -s 41x30 --methods quadrature --reference pictures/reference-1.exr; want_status 2; want_in err '40 x 30'
  echo '#error "no"' >wrong.vts
  run chart wrong.vts --methods quadrature; want_status 1; want_in err 'wrong.vts:1'
  rm -r pictures bin chart.* scene.svg first.csv apart
  "$vts" chart scene.vts -s 2000x1500 --samples 4000 --methods quadrature >out 2>err &
  local pid=$!
  sleep 1
  kill -s INT $pid
  wait $pid
  status=$? call='vts chart with SIGINT'
  want_status 130
  want_only scene.vts scene.csv wrong.vts
}

case_reference() {
  scene
  cat >>scene.vts <<'S'
skin {
  surface { patch_grid 1, 1 function(u, v) { <4*u - 2, 0, 4*v - 2> } }
  texel { texel { layer { cone { <0.5, 0, 0.5>, 0.2, <0.5, 1, 0.5>, 0 } } } }
  mapping { repeat 6 height 0.3 }
}
S
  run reference scene.vts -s 8x6; want_status 0; want_empty out; want_empty err; want_file scene.png
  local n
  for n in 1 2 3; do run reference scene.vts -s 33x21 --samples 5 -t $n -o $n.exr --float-type float; want_status 0; done
  cmp -s 1.exr 2.exr && cmp -s 1.exr 3.exr || fail "the number of threads changes the picture"
  run reference scene.vts -s 33x21 --samples 5 --seed 7 -o 4.exr --float-type float; want_status 0
  cmp -s 1.exr 4.exr && fail "the seed has no effect"
  run reference scene.vts -s 33x21 --samples 5 --region 10,4,30,20 -o part.exr --float-type float; want_status 0
  run reference scene.vts -s 16x12 --samples 2 -o a.ppm --report -; want_status 0
  "$json_check" scene frames rays texels <out || fail "report on stdout"
  refused reference; refused reference scene.vts a.vts; refused reference scene.vts --samples 0; refused reference scene.vts --samples 65537
  refused reference scene.vts -q best; refused render scene.vts --samples 257
  "$vts" reference scene.vts -s 4000x3000 --samples 1000 -o big.png >out 2>err &
  local pid=$!
  sleep 1
  kill -s INT $pid 2>/dev/null || fail "the reference ended before the signal"
  wait $pid
  status=$? call='vts reference with SIGINT'
  want_status 130
  [ ! -e big.png ] || fail "an interrupted reference left a picture"
}

# No picture replaces the scene, what it includes, or what a link leads to.
case_sources() {
  scene
  cp scene.vts scene.png
  echo '#include "part.ppm"' >whole.vts
  cp scene.vts part.ppm
  ln -s scene.vts link.png
  run render scene.png -s 8x6; want_status 3
  run render whole.vts -s 8x6 -o part.ppm; want_status 3
  run render scene.vts -s 8x6 -o link.png; want_status 3
  run reference scene.vts -s 8x6 -o link.png; want_status 3
  local f
  for f in scene.png part.ppm link.png; do cmp -s scene.vts $f || fail "$f was overwritten"; done
}

# A camera beyond what floats hold sees nothing, in whichever way it is drawn.
case_far() {
  local mode
  scene
  sed -i 's/^camera.*/camera { location <1e200, 1e200, 1e200> look_at 0 }/' scene.vts
  grep -q 1e200 scene.vts || fail "the scene has no camera of its own"
  cat >>scene.vts <<'END'
#declare T = texel { resolution 8 layer { sphere { 0.5, 0.4 } } }
skin { surface { patch_grid 2, 2 function(u, v) { <u, 0, v> } } texel { T } mapping { tile 0.5 height 0.5 } }
END
  for mode in auto exact voxels; do
    run render scene.vts -s 8x6 --set detail=$mode -o far.ppm; want_status 0
  done
  run reference scene.vts -s 8x6 --samples 1 -o far.ppm; want_status 0
}

# A part is the same pixels as in the whole.
case_region() {
  scene
  run render scene.vts -s 20x10 -o whole.ppm; want_status 0
  run render scene.vts -s 20x10 --region 0,4,20,7 -o part.ppm; want_status 0
  [ "$(sed -n 2p part.ppm | head -c 4)" = "20 3" ] || fail "the part's size is $(sed -n 2p part.ppm)"
  cmp -s <(tail -c 180 part.ppm) <(tail -c 600 whole.ppm | head -c 420 | tail -c 180) || fail "the part differs from the whole"

  # Light of skins' matter is told between pixels: what is beside a part has its say.
  cat >skin.vts <<'END'
#include "grass.inc"
global_settings { assumed_gamma 1 detail voxels max_error 0.015 }
camera { location <0, 150, -150> look_at 0 right x*image_width/image_height angle 16 }
light_source { <2000, 3000, -1000>, rgb 1.2 }
background { rgb <0.4, 0.5, 0.7> }
#declare Ground = surface { patch_grid 24, 24 function(u, v) { <60*u - 30, 2*sin(9*u)*cos(8*v), 60*v - 30> } texture { pigment { rgb <0.3, 0.2, 0.1> } } }
object { Ground }
#for (I, 0, 11) #for (J, 0, 11) sphere { <I*5 - 28 + 2*mod(J, 2), 6, J*5 - 28>, 1.2 pigment { rgb <1, I/11, 0> } } #end #end
skin { surface { Ground } texel { Lawn_Texel(0.17, 200, 0.12, 1) } mapping { tile 0.4 height 0.6 } }
END
  run render skin.vts -s 160x96 -o whole.ppm; want_status 0
  run render skin.vts -s 160x96 --region 96,0,128,32 -o part.ppm; want_status 0
  for ((y = 0; y < 32; y++)); do tail -c $((160 * 96 * 3)) whole.ppm | tail -c +$(((y * 160 + 96) * 3 + 1)) | head -c 96; done >crop
  cmp -s crop <(tail -c $((32 * 96)) part.ppm) || fail "the part with a skin differs from the whole"
}

run_case
