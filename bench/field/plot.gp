# Error against time, a panel for each scene. gnuplot -e "scenes='lawn near'; csv='…'; out='…'" plot.gp
set terminal svg size 1100,1200 font "sans,12" background rgb "white"
set output out
set datafile separator ","
set logscale xy
set grid
set key bottom left
set xlabel "CPU seconds"
set ylabel "RMSE"
set multiplot layout 3,2
pick(scene, program) = sprintf("< awk -F, '$1 == \"%s\" && $2 == \"%s\"' %s", scene, program, csv)
do for [scene in scenes] {
    set title scene
    plot pick(scene, "embree") using 4:5 with linespoints title "Embree", \
         pick(scene, "povray") using 4:5 with linespoints title "POV-Ray", \
         for [p in "auto exact voxels"] pick(scene, "vts ".p) using 4:6 with linespoints title "vts, detail ".p
}
unset multiplot
