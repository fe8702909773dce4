#!/usr/bin/env python3
"""A flight away from grass, woods or fur: does anything pop where voxels take the place of exact geometry, and the slab that of voxels?

    bench/zoom.py [--vts PATH] [--kind lawn|forest|fur|flat] [--frames N] [--from METRES] [--to METRES] [--size WxH] [--samples N]
                  [--max-error E] [--stills] [--exact] [--set NAME=VALUE] [OUT]

lawn: hills of 24 x 24 km under grass of a metre a tile. forest: the same hills under spruces, 25 m a tile. fur: a furry ball of radius 1, for ever smaller.
flat: one flat cell of 40 x 40 km under grass. All are seen from N distances, evenly spaced in the logarithm. Each frame is drawn as users get it in a film, and
twice by `vts reference` (or, with --exact, with `detail exact`) with many samples for the truth, whose own noise the two tell: squares of errors are means of
(picture - truth 1)(picture - truth 2), which the noise of neither makes larger. Prints, for each frame: CPU seconds, the error (RMSE) without noise, the mean
difference, the flicker: the RMS over pixels of the change from one frame to the next of (picture - truth), and the error that vts tells itself. OUT (default zoom-out) keeps the pictures, and truths are taken from there.
"""
import argparse
import glob
import json
import math
import os
import subprocess

from pfm import read_pfm

LIGHT = """
global_settings { assumed_gamma 1 }
light_source { 1e7*<-20, 30, -25> rgb 1 parallel point_at 0 }
background { rgb <0.5, 0.7, 1> }
"""
AIM = "camera { location <0, D, -D> look_at <0, 0, 0> right x*image_width/image_height angle 40 }\n"
GRASS = """
#declare S = seed(5);
#declare Grass = texel {
  cyclic x + z
  layer {
    particles { count 16 { position <rand(S), 0, rand(S)> velocity <0.3*rand(S) - 0.15, 1, 0.3*rand(S) - 0.15>
                           life 0.9 width 0.05, 0.01 profile "flat" } }
    texture { pigment { rgb <0.2, 0.5, 0.1> } }
  }
}
"""
SPRUCES = """
#include "trees.inc"
#declare Plants = array[2] { Spruce_Plant(22, Summer, 1, 1, 1, 0.15), Spruce_Plant(18, Summer, 2, 1, 1, 0.15) }
#declare Trees = Tree_Stand(Plants, texture { pigment { rgb <0.3, 0.2, 0.1> } }, texture { pigment { rgb <0.1, 0.3, 0.08> } }, 25, 22, 6.25, 1, 1)
"""
HILLS = """
#declare Up = function(u, v) { 60*(1 - cos(75*(u - 0.5))) + 45*sin(58*(v - 0.5)) + 25*sin(190*(u - 0.5))*sin(165*(v - 0.5)) };
#declare Land = surface { patch_grid 120, 120 function(u, v) { <24000*(u - 0.5), Up(u, v), 24000*(v - 0.5)> } texture { pigment { rgb <0.2, 0.15, 0.1> } } };
object { Land }
"""
KINDS = {
    "lawn": LIGHT + AIM + GRASS + HILLS + "skin { surface { Land } texel { Grass } mapping { repeat <24000, 24000> height 0.5 } }",
    "forest": LIGHT + AIM + SPRUCES + HILLS + "skin { surface { Land } texel { Trees } mapping { tile 25 height 22 } tiling wang }",
    "fur": LIGHT + "camera { location (1.15 + D)*vnormalize(<0.2, 0.5, -1>) look_at <0, 0, 0> right x*image_width/image_height angle 40 }\n" + """
#declare S = seed(5);
#declare Hair = texel { cyclic x + z layer { particles { count 60 { position <rand(S), 0, rand(S)> velocity <0.5*rand(S) - 0.25, 1, 0.5*rand(S) - 0.25>
  life 0.9 width 0.06, 0.02 } } texture { pigment { rgb <0.6, 0.4, 0.2> } finish { specular 0.2 } } } }
#declare Ball = surface { sphere { 0, 1 } uv spherical texture { pigment { rgb <0.4, 0.25, 0.15> } } };
object { Ball }
skin { surface { Ball } texel { Hair } mapping { repeat <64, 32> height 0.12 } }
""",
    "flat": LIGHT + AIM + GRASS + """
#declare Land = surface { patch_grid 1, 1 function(u, v) { <40000*(u - 0.5), 0, 40000*(v - 0.5)> } texture { pigment { rgb <0.2, 0.15, 0.1> } } };
object { Land }
skin { surface { Land } texel { Grass } mapping { repeat <40000, 40000> height 0.5 } }
""",
}


def difference(a, b):
    return [x - y for x, y in zip(a, b)]


def product(a, b):
    return sum(x * y for x, y in zip(a, b)) / len(a)


def root(square):
    return math.sqrt(max(0, square))


def clamped(picture):
    return [min(max(v, 0), 1) for v in picture]


def draw(options, command, distance, name, *more):
    """The picture as a list of values, CPU seconds that it took, and the report."""
    for old in glob.glob(os.path.join(options.out, name + "*")):
        os.remove(old)
    picture, report = (os.path.join(options.out, name + end) for end in (".pfm", ".json"))
    before = os.times()
    subprocess.run([options.vts, command, os.path.join(options.out, options.kind + ".vts"), "-s", options.size, "-D", "D=%.9g" % distance, "-o", picture,
                    "--progress", "none", *more] + (["--report", report] if command == "render" else []), check=True)
    after = os.times()
    (picture,) = glob.glob(os.path.join(options.out, name + "*.pfm")) # a frame of a film has its number added
    told = [line for path in glob.glob(os.path.join(options.out, name + "*.json")) for line in open(path)]
    return clamped(read_pfm(picture)), after.children_user + after.children_system - before.children_user - before.children_system, "".join(told)


def truth_of(options, distance, seed):
    name = "truth-%s-%s-%s-%.6g-%s-%s" % (options.kind, options.size, options.samples, distance, "exact" if options.exact else "rays", seed)
    kept = glob.glob(os.path.join(options.out, name + ".pfm"))
    if kept:
        return clamped(read_pfm(kept[0]))
    exact = ["--set", "detail=exact"] if options.exact else []
    return draw(options, "render" if options.exact else "reference", distance, name, "--samples", options.samples, "--seed", seed, *exact)[0]


def read_options():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--vts", default=os.path.join(os.path.dirname(__file__), "..", "build", "vts"))
    parser.add_argument("--kind", choices=KINDS, default="lawn")
    parser.add_argument("--frames", type=int, default=48)
    parser.add_argument("--from", dest="first", type=float, default=1)
    parser.add_argument("--to", dest="last", type=float, default=10000)
    parser.add_argument("--size", default="64x48")
    parser.add_argument("--max-error")
    parser.add_argument("--stills", action="store_true", help="frames are pictures each for itself")
    parser.add_argument("--exact", action="store_true", help="truth by detail exact")
    parser.add_argument("--samples", default="64")
    parser.add_argument("--set", dest="settings", action="append", default=[], help="for the frames, as of vts render")
    parser.add_argument("out", nargs="?", default="zoom-out")
    return parser.parse_args()


def main():
    options = read_options()
    os.makedirs(options.out, exist_ok=True)
    with open(os.path.join(options.out, options.kind + ".vts"), "w") as f:
        f.write(KINDS[options.kind])
    before, worst, seconds_of_all = None, (0, 0), 0
    print("%10s %8s %9s %9s %9s %9s" % ("metres", "CPU s", "RMSE", "mean", "flicker", "told"))
    for i in range(options.frames):
        distance = options.first * (options.last / options.first) ** (i / max(options.frames - 1, 1))
        film = [] if options.stills else ["+KFI1", "+KFF%d" % (options.frames + 1), "+SF%d" % (i + 1), "+EF%d" % (i + 1)]
        asked = (["--max-error", options.max_error] if options.max_error else []) + [word for s in options.settings for word in ("--set", s)]
        picture, seconds, report = draw(options, "render", distance, "frame-%s-%03d-" % (options.kind, i), *asked, *film)
        errors = [difference(picture, truth_of(options, distance, seed)) for seed in ("1", "2")]
        flicker = root(product(*(difference(now, then) for now, then in zip(errors, before)))) if before else 0
        before, worst, seconds_of_all = errors, max(worst, (flicker, distance)), seconds_of_all + seconds
        told = json.loads(report)["frames"][0]["error_estimate"]
        print("%10.1f %8.2f %9.5f %+9.5f %9.5f %9.5f" % (distance, seconds, root(product(*errors)), sum(map(sum, errors)) / (2 * len(picture)), flicker, told), flush=True)
    print("largest flicker %.5f at %.1f metres; %.1f CPU seconds" % (*worst, seconds_of_all))


main()
