# Points per second over points: gnuplot -c plot.gp DATA IMAGE.svg, DATA as `summarise.py plot` prints it.
data = ARG1
image = ARG2
stats data using 1:2 nooutput
set terminal svg size 900,560 font "sans,14" background "white"
set output image
set logscale xy
set xlabel "points"
set ylabel "points per second"
set format "%.0s%c"
set grid
set key below
set offsets graph 0.05, graph 0.05, 0, 0
plot for [i = 0:STATS_blocks - 1] data index i using 1:2 with linespoints linewidth 2 pointtype 7 pointsize 0.6 title columnheader(1)
