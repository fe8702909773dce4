#!/usr/bin/env python3
"""speed_chart.py OUT.svg SIZE=POINTS…: processor seconds over error, as speed.py --points has measured them; needs gnuplot.

A curve for each program and size: the geometric mean over the scenes of the time of the fastest setting that is as exact. Errors that one of
the programs does not reach of every scene are left out."""
import math
import subprocess
import sys

ERRORS = [0.012 / 1.25 ** k for k in range(10)]


def read(path):
    """{scene: {program: [(seconds, error)]}}"""
    scenes = {}
    for line in open(path, encoding='utf-8'):
        scene, program, _, seconds, error = line.rstrip('\n').split('\t')
        scenes.setdefault(scene, {'povray': [], 'vts': []})[program].append((float(seconds), float(error)))
    return scenes


def fastest(points, error):
    return min((seconds for seconds, reached in points if reached <= error), default=None)


def curve(scenes):
    """Rows (error, seconds of POV-Ray, seconds of vts)."""
    for error in ERRORS:
        pairs = [(fastest(s['povray'], error), fastest(s['vts'], error)) for s in scenes.values()]
        pairs = [pair for pair in pairs if None not in pair]
        if len(pairs) == len(scenes):
            yield [error] + [math.exp(sum(math.log(pair[k]) for pair in pairs) / len(pairs)) for k in range(2)]


def main():
    out, sets = sys.argv[1], [argument.split('=', 1) for argument in sys.argv[2:]]
    script = ['set terminal svg size 900,520 font "sans,13" background rgb "white"', 'set output "%s"' % out, 'set logscale xy',
              'set xlabel "RMSE of the picture"', 'set ylabel "processor seconds, geometric mean"', 'set grid', 'set key top right',
              'set xtics (0.0015, 0.002, 0.003, 0.004, 0.006, 0.008, 0.012)', 'set xrange [0.0014:0.013]']
    plots = []
    for i, (size, path) in enumerate(sets):
        script += ['$data%d << END' % i] + ['%g %g %g' % tuple(row) for row in curve(read(path))] + ['END']
        look = 'with linespoints lw 2 pt %d' % (7 if i == 0 else 5)
        plots += ['$data%d using 1:2 %s lc rgb "#d03020" title "POV-Ray 3.7, %s"' % (i, look, size),
                  '$data%d using 1:3 %s lc rgb "#2060c0" title "vts, %s"' % (i, look, size)]
    script.append('plot ' + ', '.join(plots))
    subprocess.run(['gnuplot'], input='\n'.join(script) + '\n', text=True, check=True)


if __name__ == '__main__':
    main()
