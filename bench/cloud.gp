# Error against time of a cloud, and what orders, steps and grids change. gnuplot -e "data='…'; out='…'" cloud.gp
set terminal svg size 760,420 font "sans,12" background rgb "white"
set output out
set datafile separator ","
set logscale xy
set xlabel "processor seconds"
set ylabel "RMSE"
set key outside right
set grid lc rgb "#dddddd"
pick(group) = sprintf("< grep '^%s,' '%s'", group, data)
plot pick("rays") using 3:4 with linespoints lw 2 pt 7 ps 0.5 lc rgb "#2060c0" title "two passes, by rays", \
     pick("default") using 3:4 with points pt 6 ps 1.6 lw 2 lc rgb "#d03020" title "the default", \
     pick("max_error") using 3:4 with linespoints lw 2 pt 6 ps 0.8 lc rgb "#d03020" title "the default, smaller max_error", \
     pick("grid") using 3:4 with points pt 4 lc rgb "#2060c0" title "coarser grids", \
     pick("orders") using 3:4 with points pt 8 lc rgb "#208040" title "1, 2, 4, 16 orders", \
     pick("published") using 3:4 with linespoints pt 1 lc rgb "#a06020" title "as published, by step", \
     pick("path") using 3:4 with linespoints pt 2 lc rgb "#808080" title "method path", \
     pick("tracer") using 3:4 with linespoints pt 5 ps 0.5 lc rgb "black" title "path tracer", \
     pick("single") using 3:4 with points pt 12 lc rgb "#8040a0" title "vts, one order", \
     pick("povray") using 3:4 with linespoints pt 3 lc rgb "#c040a0" title "POV-Ray, one order"
