# Two voxels that become one, by the angle between them. gnuplot -e "data='…'; out='…'" ndf.gp
set terminal svg size 960,500 font "sans,12" background rgb "white"
set output out
set polar
set size square
unset border
unset xtics
unset ytics
unset rtics
unset raxis
set key off
array degrees[4] = ["22.5°", "33.75°", "45°", "90°"]
set multiplot
set label 1 "normals" at screen 0.03, 0.75 center rotate by 90
set label 2 "area seen" at screen 0.03, 0.3 center rotate by 90
set label 3 "each voxel" at screen 0.14, 0.04 tc rgb "#909090"
set label 4 "both together" at screen 0.34, 0.04
set label 5 "filtering published (dashed)" at screen 0.54, 0.04 tc rgb "#2060c0"
set label 6 "filtering linear (dotted)" at screen 0.78, 0.04 tc rgb "#d03020"
do for [row = 0:1] {
    do for [k = 0:3] {
        set origin 0.04 + k * 0.24, 0.53 - 0.46 * row
        set size 0.24, 0.45
        if (row == 0) { set title degrees[k + 1]; set xrange [-1.6:1.6]; set yrange [-1.6:1.6] }
        if (row == 1) { unset title; set xrange [-1.45:1.45]; set yrange [-1.45:1.45] }
        c = 2 + 5 * row
        plot data index k using 1:c with lines lc rgb "#b0b0b0", "" index k using 1:c + 1 with lines lc rgb "#b0b0b0", \
             "" index k using 1:c + 2 with lines lc rgb "black" lw 2, \
             "" index k using 1:c + 3 with lines lc rgb "#2060c0" lw 2 dt (8, 5), \
             "" index k using 1:c + 4 with lines lc rgb "#d03020" lw 2 dt (3, 3)
    }
}
unset multiplot
set label 1 "normals" at screen 0.03, 0.75 center rotate by 90
set label 2 "area seen" at screen 0.03, 0.3 center rotate by 90
set label 3 "each voxel" at screen 0.14, 0.04 tc rgb "#909090"
set label 4 "both together" at screen 0.34, 0.04
set label 5 "filtering published (dashed)" at screen 0.54, 0.04 tc rgb "#2060c0"
set label 6 "filtering linear (dotted)" at screen 0.78, 0.04 tc rgb "#d03020"
