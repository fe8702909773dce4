#!/usr/bin/env python3
"""speed.py --work FOLDER [--vts PROGRAM] [--size WxH] [--runs N] [--patience SECONDS] [--prepare] [-o TABLE.md] [--points FILE] [SCENE…]

Processor seconds of POV-Ray and of vts at equal error, one thread each, for the scenes of tests/scenes or those named. Each program draws
the scene with many settings: POV-Ray with those of POVRAY (both methods of anti-aliasing, thresholds, depths), vts with the --max-error
of VTS. The error of a picture is its distance from what the same program makes of the scene with many rays for every pixel (RMSE over
pixels and channels, linear light clamped to [0, 1]), so that it tells of sampling alone; the table says how far these two are apart.
The best pictures have errors of their own, so that less than about 0.0015 cannot be told. For an error that is asked for, each program gets the time that its best settings
tell: those that no other setting beats in both time and error, and between them a power law of the error. Times are the least of --runs runs, taken in turns over all settings of both programs,
from the program's start to its end, reading and writing included.

Scenes are left out whose best picture takes POV-Ray longer than --patience seconds, and those of which the two best pictures are further apart
than APART: the programs do not draw the same. The pictures of many rays stay in the work folder and are
not drawn again; --prepare draws them and ends. --points: all that was measured, a line each: scene, program, setting, seconds, error."""
import argparse
import glob
import math
import os
import sys

import pictures
import programs

SCENES = os.path.join(programs.TOP, 'tests', 'scenes')
BEST = ('+A0.0', '+AM1', '+R8', '-J')
BEST_SAMPLES = 128
USUAL = ('+A0.3', '+AM1', '+R3', '-J')
POVRAY = [('-A',), USUAL] + [('+A' + threshold, '+AM' + method, '+R' + depth, '-J') for method, depth, threshold in (
    ('1', '3', '0.1'), ('1', '3', '0.03'), ('1', '5', '0.1'), ('1', '5', '0.03'), ('2', '2', '0.3'), ('2', '2', '0.1'), ('2', '3', '0.1'),
    ('2', '3', '0.03'), ('2', '4', '0.1'), ('2', '4', '0.03'))]
VTS = [0.1, 0.04, 0.02, 0.014, 0.01, 0.007, 0.005, 0.004, 0.003, 0.0024, 0.0019, 0.0015]
APART = 0.01
ASKED = [4 / 255, 2 / 255, 1 / 255, 0.5 / 255]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--work', required=True)
    parser.add_argument('--vts', default=programs.VTS)
    parser.add_argument('--size', default='320x240')
    parser.add_argument('--runs', type=int, default=2)
    parser.add_argument('--patience', type=int, default=60)
    parser.add_argument('--prepare', action='store_true')
    parser.add_argument('-o', '--output')
    parser.add_argument('--points')
    parser.add_argument('scenes', nargs='*')
    return parser.parse_args()


class Point:
    """A picture: how it was drawn, what it took, how far it is from the best."""
    def __init__(self, setting, seconds, error):
        self.setting, self.seconds, self.error = setting, seconds, error


def best_of(points):
    """Those that no other beats in both, by falling error: from the fastest to the most exact."""
    front = []
    for p in sorted(points, key=lambda p: (p.seconds, p.error)):
        if not front or p.error < front[-1].error:
            front.append(p)
    return front


def seconds_at(points, error):
    """What that error takes; None where no setting is as exact."""
    front = best_of(points)
    for before, after in zip([None] + front, front):
        if after.error > error:
            continue
        if before is None:
            return after.seconds
        share = math.log(before.error / error) / math.log(before.error / after.error)
        return before.seconds * (after.seconds / before.seconds) ** share
    return None


class Row:
    def __init__(self, name, povray, vts, apart):
        self.name, self.povray, self.vts, self.apart = name, povray, vts, apart

    def usual(self):
        """POV-Ray's picture as its users draw it."""
        return next(p for p in self.povray if p.setting == ' '.join(USUAL))

    def pair(self, error):
        """Seconds of both at that error; None where one does not reach it. `error` None: as exact as POV-Ray's usual picture, and its time."""
        theirs = self.usual().seconds if error is None else seconds_at(self.povray, error)
        ours = seconds_at(self.vts, self.usual().error if error is None else error)
        return (theirs, ours) if theirs and ours else None


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
        """POV-Ray's picture of many rays and vts's; None when one is missing."""
        theirs, late, ours = self.path(name, '-best.ppm'), self.path(name, '-late'), self.path(name, '-best.pfm')
        if not os.path.exists(theirs) and not os.path.exists(late) and self.povray(scene, theirs, BEST, self.options.patience).status != 0:
            open(late, 'w', encoding='utf-8').close()
        if not os.path.exists(theirs):
            return None
        if not os.path.exists(ours):
            self.vts(scene, ours, ['--samples', str(BEST_SAMPLES)])
        return (pictures.read_ppm(theirs), pictures.read_pfm(ours)) if os.path.exists(ours) else None

    def measure(self, settings):
        """The points of `settings`, each (name, picture, truth, read, render); None when a program fails. Runs go round, so that a machine
        that is busy for a while is so for all."""
        seconds, errors = [math.inf] * len(settings), [None] * len(settings)
        for turn in range(self.options.runs):
            for i, (_, out, truth, read, render) in enumerate(settings):
                if turn > 0 and seconds[i] > 3:
                    continue
                done = render()
                if done.status != 0:
                    return None
                seconds[i] = min(seconds[i], done.seconds)
                if errors[i] is None:
                    errors[i] = pictures.rmse(read(out), truth)
        return [Point(setting[0], t, error) for setting, t, error in zip(settings, seconds, errors)]

    def row(self, scene):
        name = os.path.basename(scene)[:-4]
        best = self.best(scene, name)
        if best is None:
            return None
        theirs, ours = self.path(name, '-pov.ppm'), self.path(name, '-vts.pfm')
        settings = [(' '.join(quality), theirs, best[0], pictures.read_ppm, lambda q=quality: self.povray(scene, theirs, q, 300))
                    for quality in POVRAY]
        settings += [('%g' % error, ours, best[1], pictures.read_pfm, lambda e=error: self.vts(scene, ours, ['--max-error', '%g' % e]))
                     for error in VTS]
        points = self.measure(settings)
        return Row(name, points[:len(POVRAY)], points[len(POVRAY):], pictures.rmse(*best)) if points else None


def mean_ratio(pairs):
    return math.exp(sum(math.log(theirs / ours) for theirs, ours in pairs) / len(pairs))


def asked_name(error):
    return "as `+A0.3 +AM1 +R3`" if error is None else '%.4f' % error


def table(rows, size):
    asked = [None] + ASKED
    yield '%d scenes, %s pixels. How many times as long POV-Ray takes, geometric mean:' % (len(rows), size)
    yield ''
    yield '| RMSE | scenes that both reach | POV-Ray over vts |'
    yield '|---|---|---|'
    for error in asked:
        pairs = [pair for pair in (row.pair(error) for row in rows) if pair]
        if pairs:
            yield '| %s | %d | %.2f |' % (asked_name(error), len(pairs), mean_ratio(pairs))
    yield ''
    yield '| scene | apart | its usual error, s | vts, s | ' + ' | '.join('at ' + asked_name(error) for error in asked) + ' |'
    yield '|---' * (4 + len(asked)) + '|'
    for row in sorted(rows, key=lambda row: row.name):
        usual = row.pair(None)
        cells = []
        for error in asked:
            pair = row.pair(error)
            cells.append('%.2f' % (pair[0] / pair[1]) if pair else '–')
        yield '| %s | %.4f | %.4f, %.3f | %s | %s |' % (row.name, row.apart, row.usual().error, row.usual().seconds,
                                                  '%.3f' % usual[1] if usual else '–', ' | '.join(cells))


def main():
    options = arguments()
    bench = Bench(options)
    rows = []
    for scene in options.scenes or sorted(glob.glob(os.path.join(SCENES, '*.pov'))):
        if options.prepare:
            bench.best(scene, os.path.basename(scene)[:-4])
            continue
        row = bench.row(scene)
        if not row or row.apart > APART:
            print('left out: ' + scene, file=sys.stderr)
            continue
        rows.append(row)
        if options.points:
            with open(options.points, 'a', encoding='utf-8') as out:
                for program, points in (('povray', row.povray), ('vts', row.vts)):
                    for p in points:
                        out.write('%s\t%s\t%s\t%.4f\t%.6f\n' % (row.name, program, p.setting, p.seconds, p.error))
    if rows:
        programs.put('\n'.join(table(rows, options.size)) + '\n', options.output)


if __name__ == '__main__':
    main()
