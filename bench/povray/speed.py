#!/usr/bin/env python3
"""speed.py --work FOLDER [--vts PROGRAM] [--size WxH] [--runs N] [--patience SECONDS] [--prepare] [-o TABLE.md] [SCENE…]

Processor seconds of POV-Ray and of vts at equal error, one thread each, for the scenes of tests/scenes or those named. POV-Ray draws with
+A0.3 +AM1 +R3, as its users do. The error of each program's picture is its distance from what the same program makes of the same scene with many
rays for every pixel (RMSE over pixels and channels, linear light clamped to [0, 1]), so that it tells of sampling alone. vts gets the
largest --max-error of the list in ERRORS with which its error is no larger than POV-Ray's. Times are the least of --runs runs, from the
program's start to its end, and contain reading the scene.

Where POV-Ray's best picture takes longer than --patience the error of its picture is told by vts's best. The pictures of many rays stay in the work
folder and are not drawn again; --prepare draws them and ends."""
import argparse
import glob
import math
import os

import pictures
import programs

SCENES = os.path.join(programs.TOP, 'tests', 'scenes')
USUAL = ('+A0.3', '+AM1', '+R3', '-J')
BEST = ('+A0.0', '+AM1', '+R5', '-J')
BEST_SAMPLES = 64
ERRORS = [0.1 / 1.5 ** k for k in range(15)]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--work', required=True)
    parser.add_argument('--vts', default=programs.VTS)
    parser.add_argument('--size', default='320x240')
    parser.add_argument('--runs', type=int, default=3)
    parser.add_argument('--patience', type=int, default=60)
    parser.add_argument('--prepare', action='store_true')
    parser.add_argument('-o', '--output')
    parser.add_argument('scenes', nargs='*')
    return parser.parse_args()


class Bench:
    def __init__(self, options):
        self.options = options
        self.size = tuple(int(side) for side in options.size.split('x'))
        os.makedirs(options.work, exist_ok=True)

    def path(self, name, suffix):
        return os.path.join(self.options.work, '%s-%s%s' % (name, self.options.size, suffix))

    def povray(self, scene, out, quality, patience):
        return programs.povray(scene, out, self.size, quality=quality, timeout=patience, stdlib=True)

    def vts(self, scene, out, options):
        return programs.vts(scene, out, self.size, options, program=self.options.vts, timeout=300)

    def best(self, scene, name):
        """POV-Ray's picture of many rays and vts's; None for one that there is not."""
        theirs, late, ours = self.path(name, '-best.ppm'), self.path(name, '-late'), self.path(name, '-best.pfm')
        if not os.path.exists(theirs) and not os.path.exists(late):
            if self.povray(scene, theirs, BEST, self.options.patience).status != 0:
                open(late, 'w', encoding='utf-8').close()
        if not os.path.exists(ours):
            self.vts(scene, ours, ['--samples', str(BEST_SAMPLES)])
        return (pictures.read_ppm(theirs) if os.path.exists(theirs) else None,
                pictures.read_pfm(ours) if os.path.exists(ours) else None)

    def least(self, render):
        """The least seconds of some runs; None when one fails."""
        found = []
        for _ in range(self.options.runs):
            done = render()
            if done.status != 0:
                return None
            found.append(done.seconds)
            if done.seconds > 5:
                break
        return min(found)

    def equal(self, scene, name, truth, error):
        """(max_error, error, picture's error) of the fastest picture of vts that is as exact."""
        out = self.path(name, '-vts.pfm')
        low, high = 0, len(ERRORS) - 1
        found = {}

        def error_of(k):
            if k not in found:
                done = self.vts(scene, out, ['--max-error', '%.5f' % ERRORS[k]])
                found[k] = pictures.rmse(pictures.read_pfm(out), truth) if done.status == 0 else math.inf
            return found[k]
        while low < high:
            middle = (low + high) // 2
            if error_of(middle) <= error:
                high = middle
            else:
                low = middle + 1
        return ERRORS[low], error_of(low)

    def row(self, scene):
        """(name, seconds of POV-Ray, its error, max_error, seconds of vts, its error); None when a program fails."""
        name = os.path.basename(scene)[:-4]
        theirs, ours = self.best(scene, name)
        out = self.path(name, '-pov.ppm')
        if ours is None:
            return None
        first = self.least(lambda: self.povray(scene, out, USUAL, 300))
        if first is None:
            return None
        error = pictures.rmse(pictures.read_ppm(out), theirs or ours)
        asked, reached = self.equal(scene, name, ours, error)
        second = self.least(lambda: self.vts(scene, self.path(name, '-vts.pfm'), ['--max-error', '%.5f' % asked]))
        return name, first, error, asked, second, reached


def table(rows, size):
    mean = math.exp(sum(math.log(row[1] / row[4]) for row in rows) / len(rows)) if rows else 0
    total = sum(row[1] for row in rows) / max(sum(row[4] for row in rows), 1e-9)
    yield '%d scenes, %s pixels: POV-Ray takes %.2f times as long as vts (geometric mean; all scenes together: %.2f times).' % (len(rows), size, mean, total)
    yield ''
    yield '| scene | POV-Ray, s | its error | `--max-error` | vts, s | its error | times as fast |'
    yield '|---|---|---|---|---|---|---|'
    for name, theirs, error, asked, ours, reached in sorted(rows, key=lambda row: row[1] / row[4]):
        yield '| %s | %.2f | %.4f | %.4f | %.2f | %.4f | %.2f |' % (name, theirs, error, asked, ours, reached, theirs / ours)


def main():
    options = arguments()
    bench = Bench(options)
    scenes = options.scenes or sorted(glob.glob(os.path.join(SCENES, '*.pov')))
    if options.prepare:
        for scene in scenes:
            bench.best(scene, os.path.basename(scene)[:-4])
        return
    rows = [row for row in (bench.row(scene) for scene in scenes) if row]
    text = '\n'.join(table(rows, options.size)) + '\n'
    programs.put(text, options.output)


if __name__ == '__main__':
    main()
