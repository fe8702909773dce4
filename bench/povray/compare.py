#!/usr/bin/env python3
"""compare.py [--vts PROGRAM] [--size WxH] [--work FOLDER] [-o TABLE.md] [SCENE…]
compare.py --references [SCENE…]

Draws scenes (those of tests/scenes, unless some are named) by POV-Ray and by vts at the same size and tells how far the pictures are
apart, in linear light clamped to [0, 1]: over all pixels, and without those at edges. A pixel is at an edge when one of its channels
differs by more than 0.1 from that of one of its eight neighbours in POV-Ray's picture. The worst come first. Both programs read the include files of stdlib.

--references writes POV-Ray's pictures that the tests compare with, NAME.png beside each scene."""
import argparse
import glob
import os
import tempfile

import pictures
import programs

SCENES = os.path.join(programs.TOP, 'tests', 'scenes')
# 81 rays for each pixel, whatever its neighbours look like: 0.0014 from the mean of 256.
BEST = ('+A0.0', '+AM1', '+R9', '-J')
REFERENCE_SIZE = (80, 60)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--vts', default=programs.VTS)
    parser.add_argument('--size', default='80x60')
    parser.add_argument('--work', help='keep the pictures, and POV-Ray left, vts right as PNG, here')
    parser.add_argument('--threads', type=int, default=1)
    parser.add_argument('--references', action='store_true')
    parser.add_argument('-o', '--output')
    parser.add_argument('scenes', nargs='*')
    return parser.parse_args()


def write_reference(scene):
    with tempfile.TemporaryDirectory() as scratch:
        path = os.path.join(scratch, 'picture.ppm')
        done = programs.povray(scene, path, REFERENCE_SIZE, quality=BEST, timeout=300, stdlib=True)
        if done.status != 0:
            print('%s: %s' % (scene, done.said[-300:]))
            return
        pictures.save_png(scene[:-4] + '.png', pictures.read_ppm(path))


def difference(scene, options, size, folder):
    """(name, RMSE without edges, in all, share of edges, seconds of POV-Ray, of vts); figures None when there is no picture."""
    name = os.path.basename(scene)[:-4]
    theirs, ours = (os.path.join(folder, name + suffix) for suffix in ('.ppm', '.pfm'))
    first = programs.povray(scene, theirs, size, quality=BEST, threads=options.threads, timeout=300, stdlib=True)
    second = programs.vts(scene, ours, size, program=options.vts, threads=options.threads, timeout=300)
    if first.status != 0 or second.status != 0:
        print('%s: %s' % (name, (first if first.status != 0 else second).said[-600:]))
        return name, None, None, None, first.seconds, second.seconds
    a, b = pictures.read_ppm(theirs), pictures.read_pfm(ours)
    pictures.beside(os.path.join(folder, name + '.png'), [[a, b]])
    marked = pictures.edges(a)
    return name, pictures.rmse(a, b, marked), pictures.rmse(a, b), sum(marked) / len(marked), first.seconds, second.seconds


def table(rows):
    yield '| scene | RMSE without edges | in all | edges | POV-Ray, s | vts, s |'
    yield '|---|---|---|---|---|---|'
    for name, inner, whole, share, theirs, ours in rows:
        figures = '– | – | –' if inner is None else '%.4f | %.4f | %.0f %%' % (inner, whole, 100 * share)
        yield '| %s | %s | %.2f | %.2f |' % (name, figures, theirs, ours)


def main():
    options = arguments()
    scenes = options.scenes or sorted(glob.glob(os.path.join(SCENES, '*.pov')))
    if options.references:
        for scene in scenes:
            write_reference(scene)
        return
    size = tuple(int(side) for side in options.size.split('x'))
    with tempfile.TemporaryDirectory() as scratch:
        if options.work:
            os.makedirs(options.work, exist_ok=True)
        rows = [difference(scene, options, size, options.work or scratch) for scene in scenes]
    rows.sort(key=lambda row: -(9 if row[1] is None else row[1]))
    text = '\n'.join(table(rows)) + '\n'
    programs.put(text, options.output)


if __name__ == '__main__':
    main()
