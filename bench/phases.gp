# The phase functions of Blasi, Le Saec & Schlick 1993, Figs. 2 to 6, light coming from the left. gnuplot -e "out='…'" phases.gp
set terminal pngcairo size 900,230 font "sans,9" background rgb "white"
set output out
set polar
unset border
unset xtics
unset ytics
unset rtics
unset raxis
set size square
set samples 721
set trange [0:2*pi]
set zeroaxis lc rgb "#cccccc"
set key at screen 0, screen 0
set key off
schlick(k, m) = (1 - k*k)/(1 - k*m)**2
two(r, k, l, m) = r*schlick(k, m) + (1 - r)*schlick(l, m)
hg(k, m) = (1 - k*k)/(1 + k*k - 2*k*m)**1.5
rayleigh(m) = 0.75*(1 + m*m)
hazy(m) = 0.5 + 4.5*((1 + m)/2)**8
murky(m) = 0.5 + 16.5*((1 + m)/2)**32
c(t) = cos(t)
set multiplot layout 1, 5
set label 1 "black: the function; blue: as printed in Fig. 7 (dashed: Fig. 4's k' = -0.91); red: closer" at screen 0.02, 0.04
set label 2 "k = -0.6, 0, 0.6 (black), ±0.8 (blue), ±0.9 (red)" at screen 0.62, 0.04
set title "Fig. 2, Rayleigh"
set xrange [-1.7:1.7]; set yrange [-1.7:1.7]
plot rayleigh(c(t)) lc rgb "black" lw 2, two(0.5, -0.46, 0.46, c(t)) lc rgb "#2060c0" lw 1.5
set title "Fig. 3, hazy Mie"
set xrange [-2.6:6.6]; set yrange [-4.6:4.6]
plot hazy(c(t)) lc rgb "black" lw 2, two(0.12, -0.50, 0.70, c(t)) lc rgb "#2060c0" lw 1.5, two(0.222, -0.337, 0.752, c(t)) lc rgb "#d03020" lw 1.5
set title "Fig. 4, murky Mie"
set xrange [-8:22]; set yrange [-15:15]
plot murky(c(t)) lc rgb "black" lw 2, two(0.19, -0.65, 0.91, c(t)) lc rgb "#2060c0" lw 1.5, two(0.19, -0.65, -0.91, c(t)) lc rgb "#2060c0" lw 1 dt (6, 4), two(0.404, -0.128, 0.943, c(t)) lc rgb "#d03020" lw 1.5
set title "Fig. 5, Henyey and Greenstein"
set xrange [-4.2:4.2]; set yrange [-4.2:4.2]
plot 1 lc rgb "black", hg(0.6, c(t)) lc rgb "black", hg(-0.6, c(t)) lc rgb "black", hg(0.8, c(t)) lc rgb "#2060c0", hg(-0.8, c(t)) lc rgb "#2060c0", hg(0.9, c(t)) lc rgb "#d03020", hg(-0.9, c(t)) lc rgb "#d03020"
set title "Fig. 6, Schlick"
plot 1 lc rgb "black", schlick(0.6, c(t)) lc rgb "black", schlick(-0.6, c(t)) lc rgb "black", schlick(0.8, c(t)) lc rgb "#2060c0", schlick(-0.8, c(t)) lc rgb "#2060c0", schlick(0.9, c(t)) lc rgb "#d03020", schlick(-0.9, c(t)) lc rgb "#d03020"
unset multiplot
