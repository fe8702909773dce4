#!/usr/bin/env python3
"""vocabulary.py [--vts PROGRAM] [--scenes FOLDER] [--include FOLDER] [-o doc/povray-samples.md]

Reads every sample scene of POV-Ray (Debian: povray-examples) with `vts check` and POV-Ray's own include files, and writes a table:
whether it was read, which of its words are not modelled, and the time. A scene beside an .ini file of its name is read with that
file's options, as POV-Ray's own scripts do."""
import argparse
import os
import re
import subprocess
import tempfile
import time


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    here = os.path.dirname(os.path.abspath(__file__))
    top = os.path.join(here, '..', '..')
    parser.add_argument('--vts', default=os.path.join(top, 'build', 'vts'))
    parser.add_argument('--scenes', default='/usr/share/doc/povray/examples')
    parser.add_argument('--include', default='/usr/share/povray-3.7/include')
    parser.add_argument('-o', '--output', default=os.path.join(top, 'doc', 'povray-samples.md'))
    return parser.parse_args()


def scenes_in(folder):
    found = []
    for place, _, names in os.walk(folder):
        found += [os.path.join(place, name) for name in names if name.endswith('.pov')]
    return sorted(found)


def options_of(scene):
    """The scene, or the .ini file beside it that names it."""
    ini = scene[:-4] + '.ini'
    if not os.path.exists(ini):
        return [scene]
    text = open(ini, encoding='latin-1').read()
    frames = re.findall(r'^\s*(Initial_Frame|Final_Frame)\s*=\s*(\d+)', text, re.M | re.I)
    return [scene] + ['%s=%s' % pair for pair in frames]


def check(vts, include, scene):
    """(status, words that are not modelled, first error, seconds)"""
    with tempfile.TemporaryDirectory() as scratch:
        command = [os.path.abspath(vts), 'check', *options_of(scene), '-I', include, '--allow-write', scratch]
        begin = time.time()
        try:
            run = subprocess.run(command, cwd=os.path.dirname(scene), capture_output=True, timeout=120)
        except subprocess.TimeoutExpired:
            return 'timeout', [], '', 120.0
        seconds = time.time() - begin
    text = run.stderr.decode('latin-1')
    words = dict.fromkeys(re.findall(r"warning: '([^']+)' is (?:not modelled|drawn as)", text))
    error = re.search(r'error: (.*)', text)
    return run.returncode, list(words), error.group(1) if error else '', seconds


def main():
    options = arguments()
    rows, read, total = [], 0, 0.0
    for scene in scenes_in(options.scenes):
        status, words, error, seconds = check(options.vts, options.include, scene)
        read += status == 0
        total += seconds
        name = os.path.relpath(scene, options.scenes)[:-4]
        left_out = ' '.join('`%s`' % word for word in words) if status == 0 else error.replace('|', '\\|')
        rows.append('| %s | %s | %s | %.2f |' % (name, 'yes' if status == 0 else '**no** (%s)' % status, left_out, seconds))
    with open(options.output, 'w', encoding='utf-8') as out:
        out.write("# POV-Ray's sample scenes\n\n")
        out.write('Written by `bench/povray/vocabulary.py`: each scene of the samples that come with POV-Ray 3.7, read by `vts check` '
                  "with POV-Ray's own include files.\n%d of %d are read, in %.0f seconds together.\n" % (read, len(rows), total))
        out.write('“Not modelled” names the words that are accepted and have no effect on the picture, or not all of it.\n\n')
        out.write('| scene | read | not modelled | s |\n|---|---|---|---|\n')
        out.write('\n'.join(rows) + '\n')
    print('%d of %d read, %.1f s' % (read, len(rows), total))


if __name__ == '__main__':
    main()
