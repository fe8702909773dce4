#!/usr/bin/env bash
# farm.sh CASE VTS JSON_CHECK: jobs for queues, see harness.sh.
source "${BASH_SOURCE%/*}/harness.sh"

# film NAME: four frames.
film() {
  cat >"$1" <<'S'
animation { frames 4 fps 2 }
camera { location <0, 1.5, -4> look_at <0, 0.5, 0> }
light_source { <5, 10, -5> rgb 1 }
sphere { <clock, 0.5, 0>, 0.5 pigment { rgb <0.8, 0.2, 0.1> } }
S
}

# The lines of a list, run one by one, make what one machine makes.
case_list() {
  film film.vts
  run film.vts -s 40x30 -o w.png
  run farm list film.vts -s 40x30 -o a.png --chunk 3; want_status 0
  [ "$(wc -l <out)" = 2 ] || fail "jobs: $(cat out)"
  want_in out '-f 1-3 '; want_in out '-f 4 '
  cp out jobs; sh jobs || fail "a job fails"
  local n
  for n in 1 2 3 4; do cmp -s w$n.png a$n.png || fail "frame $n"; done
  # A job that is run again has nothing to do; a list that is made again has only what is missing.
  printf x >a2.png; sh jobs; [ "$(cat a2.png)" = x ] || fail "a job does again what is there"
  rm a4.png; run farm list film.vts -s 40x30 -o a.png --resume; [ "$(wc -l <out)" = 1 ] || fail "jobs: $(cat out)"; want_in out '-f 4 '
  run farm list film.vts -f 4,1-3x2 --chunk 2 -o 'b.###.png'; want_in out '-f 4,1 '; want_in out '-f 3 '; want_in out "'b.###.png'"
  run farm list film.vts --clock 0.5 -o one.png; [ "$(wc -l <out)" = 1 ] || fail "one clock, jobs: $(cat out)"
}

case_regions() {
  scene
  local suffix
  for suffix in exr jpg; do
    run scene.vts -s 100x70 -o w.$suffix
    run farm list scene.vts -s 100x70 -o a.$suffix --regions 3x2; want_status 0
    [ "$(wc -l <out)" = 7 ] || fail "jobs: $(cat out)"
    cp out jobs
    head -n 6 jobs | tac | sh; tail -n 1 jobs | sh || fail "the last job fails"
    run compare w.$suffix a.$suffix --metric rmse,max; want_status 0; [ "$(head -n 1 out)" = 'rmse 0' ] || fail "joined regions are not the whole $suffix: $(cat out)"
    [ $suffix = jpg ] || cmp -s w.$suffix a.$suffix || fail "joined regions are not the file of the whole"
    rm a.*
  done
  # Regions of a film, whose last job waits for the others.
  film film.vts
  run film.vts -s 40x30 -o w.png
  run farm list film.vts -s 40x30 -o f.png --regions 1x2 -f 2-4 --wait 60; cp out jobs
  [ "$(wc -l <jobs)" = 7 ] || fail "jobs: $(cat jobs)"
  tail -n 1 jobs | sh & head -n 6 jobs | sh; wait $! || fail "the waiting job fails"
  local n
  for n in 2 3 4; do cmp -s w$n.png f$n.png || fail "frame $n of regions"; done
}

# Names that shells like to misread.
case_quoting() {
  local name
  for name in "it's a \"film\".vts" '-lead.vts' 'a b;touch hacked.vts' '$(touch hacked).vts' '`touch hacked`.vts' 'x=1.vts' '#c.vts' '*.vts' 'ü\n.vts' 'tab	.vts'; do
    film "$name"
    run farm list -s 20x10 -D 't=`touch hacked`$HOME'"'" -o "p $name##.ppm" -f 2 -- "$name"; want_status 0
    [ "$(wc -l <out)" = 1 ] || fail "jobs: $(cat out)"
    cp out jobs; sh jobs || fail "the job of '$name' fails"; want_file "p ${name}02.ppm"
    run farm slurm -s 20x10 -o "q $name##.ppm" --script s --dry-run -- "$name"; want_status 0
    SLURM_ARRAY_TASK_ID=2 bash s || fail "task 2 of '$name' fails"; want_file "q ${name}03.ppm"
    rm -f -- "$name" "p ${name}02.ppm" "q ${name}03.ppm" s
  done
  rm jobs; want_only
  film $'line\nbreak.vts'
  refused farm list $'line\nbreak.vts'; want_in err 'line break'
}

case_refused() {
  film film.vts; scene
  refused farm; refused farm list; refused farm lists film.vts; refused farm film.vts; refused farm list film.vts scene.vts
  run farm list gone.vts; want_status 3; want_empty out; want_in err gone.vts
  echo 'sphere { 0' >wrong.vts; run farm list wrong.vts; want_status 1; want_empty out
  echo 'animation { frames 0 } sphere { 0, 1 }' >none.vts; run farm slurm none.vts; want_status 1; [ ! -e none.slurm ] || fail "a script without frames"
  refused farm list film.vts -f 9; refused farm list scene.vts -f 1; refused farm list film.vts --chunk 0; refused farm list film.vts -q fine
  local regions
  for regions in 0x1 1x0 -1x2 3 x 1001x1 40x40 2x 99999999999x1; do refused farm list scene.vts --regions=$regions; done
  refused farm list scene.vts -s 3x3 --regions 4x1
  refused farm list scene.vts --regions 2x2 --region 0,0,3,3; refused farm list film.vts --report r.json; refused farm list film.vts --preview localhost:1
  refused farm list film.vts -o a.xyz; refused farm list film.vts -o noend; refused farm slurm film.vts --sbatch x; refused farm slurm film.vts --sbatch $'-x\ny'
  run farm list film.vts -o nowhere/a.png; want_status 3
  run farm slurm film.vts --script nowhere/a.slurm --dry-run; want_status 3
  refused farm slurm film.vts --dry-run --chunk 1 +KFF5000; want_in err -- '--chunk'
  run farm slurm film.vts --dry-run +KFF5000; want_status 0; grep -q '^#SBATCH --array=0-999$' film.slurm || fail "array: $(grep array film.slurm)"
}

# Scripts without Slurm: what it would run, and what is said where it is not there.
case_script() {
  film film.vts
  run film.vts -s 40x30 -o w.png
  PATH=/nowhere run farm slurm film.vts -s 40x30 -o a.png --regions 1x2 --at-once 2 --sbatch --partition=long --sbatch --time=10 -t 1
  want_status 0; want_in err 'sbatch cannot be run here'; want_in out 'film.slurm: 8 of 8 jobs'; want_in out 'submit with: sbatch film.slurm'
  local line
  for line in '#SBATCH --array=0-7%2' '#SBATCH --partition=long' '#SBATCH --time=10' '#SBATCH --cpus-per-task=1' '#SBATCH --job-name=vts-film'; do
    grep -qxF -- "$line" film.slurm || fail "no '$line' in $(cat film.slurm)"
  done
  (unset SLURM_ARRAY_TASK_ID; bash film.slurm >out 2>err) && fail "a script without a task"
  local n
  for n in 0 1 2 4 5 6 7; do (cd /; SLURM_ARRAY_TASK_ID=$n bash "$folder/film.slurm") || fail "task $n"; done
  (cd /; bash "$folder/film.slurm.stitch" >out 2>"$folder/err") && fail "joined without all parts"
  want_in err 'a2.r1c0.png'
  run farm slurm film.vts -s 40x30 -o a.png --regions 1x2 --resume --dry-run; want_in out '1 of 8 jobs'
  grep -qxF '#SBATCH --array=3' film.slurm || fail "array: $(grep array film.slurm)"
  SLURM_ARRAY_TASK_ID=3 bash film.slurm; bash film.slurm.stitch || fail "parts are not joined"
  for n in 1 2 3 4; do cmp -s w$n.png a$n.png || fail "frame $n"; done
  run farm slurm film.vts -s 40x30 -o a.png --regions 1x2 --resume --dry-run; want_in out 'all 8 jobs are done'
}

run_case
