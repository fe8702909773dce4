#!/usr/bin/env python3
"""speed.py [--vts PROGRAM] [--size WxH] [-o TABLE.md] [SCENE…]

Processor time of POV-Ray and of vts for pictures of the same error. Each scene (of tests/scenes, unless some are named) is drawn by
POV-Ray with 81 rays a pixel, which is taken for the truth, and with its usual anti-aliasing, +A0.3; vts draws it with smaller and
smaller --max-error until its RMSE in linear light is no larger than that of POV-Ray's usual picture. One thread each, one run after the
other, start and reading of the scene counted. Scenes where vts does not get there (it differs by more than its samples) are listed, and
left out of the geometric mean."""
import argparse
import glob
import math
import os
import tempfile

import compare
import pictures
import programs

ERRORS = ('0.05', '0.03', '0.02', '0.012', '0.008', '0.004', '0.002', '0.001')


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--vts', default=programs.VTS)
    parser.add_argument('--size', default='160x120')
    parser.add_argument('-o', '--output')
    parser.add_argument('scenes', nargs='*')
    return parser.parse_args()


def measure(scene, options, size, scratch):
    """(name, error and seconds of POV-Ray, accepted error, error and seconds of vts), the last three None when it does not get there."""
    name = os.path.basename(scene)[:-4]
    truth, usual, ours = (os.path.join(scratch, file) for file in ('truth.ppm', 'usual.ppm', 'ours.pfm'))
    if programs.povray(scene, truth, size, quality=compare.BEST, timeout=600, stdlib=True).status != 0:
        return None
    best = pictures.read_ppm(truth)
    theirs = programs.povray(scene, usual, size, quality=('+A0.3',), timeout=600, stdlib=True)
    error = pictures.rmse(best, pictures.read_ppm(usual))
    for accepted in ERRORS:
        done = programs.vts(scene, ours, size, ['--max-error', accepted], options.vts, timeout=600)
        if done.status != 0:
            break
        own = pictures.rmse(best, pictures.read_pfm(ours))
        if own <= error:
            return name, error, theirs.seconds, accepted, own, done.seconds
    return name, error, theirs.seconds, None, None, None


def table(rows):
    reached = [row for row in rows if row[5] is not None]
    ratio = math.exp(sum(math.log(row[2] / row[5]) for row in reached) / len(reached)) if reached else math.nan
    yield 'vts takes 1/%.2f of the time of POV-Ray at equal error: geometric mean of %d scenes of %d.' % (ratio, len(reached), len(rows))
    yield ''
    yield '| scene | POV-Ray: RMSE | s | vts: --max-error | RMSE | s | times as fast |'
    yield '|---|---|---|---|---|---|---|'
    for name, error, theirs, accepted, own, ours in rows:
        rest = '– | – | – | –' if ours is None else '%s | %.4f | %.2f | %.1f' % (accepted, own, ours, theirs / ours)
        yield '| %s | %.4f | %.2f | %s |' % (name, error, theirs, rest)


def main():
    options = arguments()
    size = tuple(int(side) for side in options.size.split('x'))
    with tempfile.TemporaryDirectory() as scratch:
        rows = [measure(scene, options, size, scratch) for scene in options.scenes or sorted(glob.glob(os.path.join(compare.SCENES, '*.pov')))]
    text = '\n'.join(table([row for row in rows if row])) + '\n'
    if options.output:
        with open(options.output, 'w', encoding='utf-8') as out:
            out.write(text)
    else:
        print(text, end='')


if __name__ == '__main__':
    main()
