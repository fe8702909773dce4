#!/usr/bin/env python3
"""samples.py --work FOLDER [--vts PROGRAM] [--scenes FOLDER] [--include FOLDER] [--only PART] [--redo] [-o doc/povray-samples.md]

Renders every sample scene of POV-Ray 3.7 (Debian: povray-examples) by POV-Ray and by vts at the same small size, compares, and writes
a table: read, drawn, how far the pictures are apart, what is not modelled. POV-Ray's pictures are kept in the work folder and not drawn
again. Beside the table the work folder gets sheets of the pictures, POV-Ray's left and vts's right, the worst first."""
import argparse
import json
import os
import re

import pictures
import programs

LONGEST = 160       # pixels of the longer side
LOOKS_RIGHT = 0.05  # RMSE of the blurred pictures
SHEET = 12          # scenes on a sheet


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--work', required=True)
    parser.add_argument('--vts', default=programs.VTS)
    parser.add_argument('--scenes', default='/usr/share/doc/povray/examples')
    parser.add_argument('--include', default='/usr/share/povray-3.7/include')
    parser.add_argument('--only', default='', help='scenes whose name contains this')
    parser.add_argument('--povray-only', action='store_true', help='draw what is missing of POV-Ray\'s pictures, and end')
    parser.add_argument('--patience', type=int, default=60, help='seconds for one picture; default 60')
    parser.add_argument('--part', default='0/1', help='K/N: of all scenes those whose number gives K divided by N, and no table')
    parser.add_argument('--redo', action='store_true', help='draw with vts again, even where the work folder has a picture')
    parser.add_argument('-o', '--output', default=os.path.join(programs.TOP, 'doc', 'povray-samples.md'))
    return parser.parse_args()


def scenes_in(folder):
    found = []
    for place, _, names in os.walk(folder):
        found += [os.path.join(place, name) for name in names if name.endswith('.pov')]
    return sorted(found)


def setting(text, name, otherwise):
    found = re.findall(r'^\s*%s\s*=\s*(-?[\d.]+)' % name, text, re.M | re.I)
    return float(found[-1]) if found else otherwise


def film(scene, text):
    """The options that make the middle frame of a film, after the .ini file beside the scene or its command line in a comment."""
    ini = scene[:-4] + '.ini'
    if os.path.exists(ini):
        told = open(ini, encoding='latin-1').read()
        first, last = int(setting(told, 'Initial_Frame', 1)), int(setting(told, 'Final_Frame', 0))
        begin, end = setting(told, 'Initial_Clock', 0), setting(told, 'Final_Clock', 1)
    else:
        line = re.search(r'^//.*\+kff(\d+).*', text, re.M | re.I)
        if not line:
            return []
        last = int(line.group(1))
        first, begin, end = (float((re.search(r'\+%s([\d.]+)' % name, line.group(0), re.I) or [0, other])[1])
                             for name, other in (('kfi', 1), ('ki', 0), ('kf', 1)))
        first = int(first)
    if last <= first:
        return []
    middle = (first + last + 1) // 2
    return ['+KFI%d' % first, '+KFF%d' % last, '+SF%d' % middle, '+EF%d' % middle, '+KI%g' % begin, '+KF%g' % end]


def size_of(text):
    """The sides that the scene's comment asks for, made small."""
    found = re.search(r'^//\s*[-+]w\s*(\d+)\s+[-+]h\s*(\d+)', text, re.M | re.I)
    wide, high = (int(found.group(1)), int(found.group(2))) if found else (4, 3)
    part = LONGEST / max(wide, high)
    return max(round(wide * part), 1), max(round(high * part), 1)


class Sample:
    def __init__(self, scene, options):
        text = open(scene, encoding='latin-1').read()
        self.scene, self.name = scene, os.path.relpath(scene, options.scenes)[:-4]
        stem = os.path.join(options.work, self.name.replace('/', '__'))
        self.ours, self.theirs, self.notes = stem + '.pfm', stem + '.ppm', stem + '.json'
        self.size, self.film = size_of(text), film(scene, text)
        self.facts = json.load(open(self.notes)) if os.path.exists(self.notes) else {}

    def keep(self, **facts):
        self.facts.update(facts)
        with open(self.notes, 'w') as out:
            json.dump(self.facts, out)

    def draw_theirs(self, patience):
        if 'povray' in self.facts:
            return
        done = programs.povray(self.scene, self.theirs, self.size, self.film, timeout=patience)
        self.keep(povray=done.status, povray_s=done.seconds, povray_said=done.said[-600:] if done.status else '')

    def draw_ours(self, options):
        if not options.redo and 'vts' in self.facts:
            return
        if os.path.exists(self.ours):
            os.remove(self.ours)
        done = programs.vts(self.scene, self.ours, self.size, self.film + ['-I', options.include, '--memory-limit', '4G'], options.vts, timeout=options.patience)
        words = list(dict.fromkeys(re.findall(r"warning: '([^']+)' (?:is not modelled|is drawn as|of [^:]* is not modelled)", done.said)))
        error = re.search(r'error: (.*)', done.said)
        self.keep(vts=done.status, vts_s=done.seconds, words=words, said=done.said[-3000:],
                  error='longer than %d s' % options.patience if done.status is None else error.group(1) if error else '')
        self.compare()

    def pictures(self):
        return (pictures.read_ppm(self.theirs) if self.facts.get('povray') == 0 else None,
                pictures.read_pfm(self.ours) if os.path.exists(self.ours) else None)

    def compare(self):
        theirs, ours = self.pictures()
        if not theirs or not ours:
            self.keep(rmse=None, blurred=None)
            return
        a, b = pictures.encoded(theirs), pictures.encoded(ours)
        self.keep(rmse=pictures.rmse(theirs, ours), blurred=pictures.rmse(pictures.blurred(a), pictures.blurred(b)))

    def right(self):
        return self.facts.get('blurred') is not None and self.facts['blurred'] < LOOKS_RIGHT

    def row(self):
        f = self.facts
        drawn = 'yes' if f['vts'] == 0 else '**%s**' % ('slow' if f['vts'] is None else 'no')
        figures = '%.4f | %.4f' % (f['rmse'], f['blurred']) if f.get('rmse') is not None else '– | –'
        left_out = ' '.join('`%s`' % word for word in f['words']) if f['vts'] == 0 else f['error'].replace('|', '\\|')
        if f['povray'] != 0:
            left_out += ' (no picture of POV-Ray: %s)' % ('it takes too long' if f['povray'] is None else 'it gives an error')
        return '| %s | %s | %s | %s | %s | %.1f | %.1f |' % (self.name, drawn, figures, 'yes' if self.right() else 'no', left_out,
                                                            f['povray_s'], f['vts_s'])


def write_table(samples, path):
    drawn = [s for s in samples if s.facts['vts'] == 0]
    right = [s for s in samples if s.right()]
    with open(path, 'w', encoding='utf-8') as out:
        out.write("# POV-Ray's sample scenes\n\n")
        out.write('Written by `bench/povray/samples.py`: each of the %d scenes that come with POV-Ray 3.7, drawn by it (anti-aliasing '
                  '+A0.1 +R2) and by vts (defaults), with the longer side %d pixels and one thread. Of films the middle frame is drawn.\n\n'
                  % (len(samples), LONGEST))
        out.write('**%d are drawn, %d look right.** “RMSE” is over pixels and channels in linear light; “blurred” is the RMSE of the two '
                  'pictures as they are shown (sRGB), each blurred by 3×3 pixels; a picture looks right below %g of that. “Not modelled” '
                  'names the words that have no effect on the picture, or not all of it; where vts draws nothing, the reason. The last '
                  'columns are processor seconds of POV-Ray and of vts.\n\n' % (len(drawn), len(right), LOOKS_RIGHT))
        out.write('| scene | drawn | RMSE | blurred | right | not modelled | POV-Ray | vts |\n|---|---|---|---|---|---|---|---|\n')
        out.write('\n'.join(s.row() for s in samples) + '\n')
    print('%d drawn, %d look right, of %d' % (len(drawn), len(right), len(samples)))


def write_sheets(samples, folder):
    """Two scenes to a row; index.txt tells which they are."""
    worst = sorted(samples, key=lambda s: -(s.facts['blurred'] if s.facts['blurred'] is not None else 9))
    with open(os.path.join(folder, 'index.txt'), 'w') as index:
        for page, start in enumerate(range(0, len(worst), SHEET)):
            group = worst[start:start + SHEET]
            rows = [[p for s in group[i:i + 3] for p in s.pictures()] for i in range(0, len(group), 3)]
            pictures.beside(os.path.join(folder, 'sheet-%02d.png' % page), rows)
            for s in group:
                index.write('%02d %-60s %s %s\n' % (page, s.name, s.facts['blurred'], ' '.join(s.facts['words']) or s.facts['error']))


def main():
    options = arguments()
    os.makedirs(options.work, exist_ok=True)
    samples = [Sample(scene, options) for scene in scenes_in(options.scenes)]
    samples = [s for s in samples if options.only in s.name]
    part, parts = (int(number) for number in options.part.split('/'))
    for sample in sorted(samples, key=lambda s: s.facts.get('povray_s', 0))[part::parts]:
        sample.draw_theirs(options.patience)
        if not options.povray_only:
            sample.draw_ours(options)
    if options.povray_only or parts > 1:
        return
    write_sheets(samples, options.work)
    write_table(samples, options.output)


if __name__ == '__main__':
    main()
