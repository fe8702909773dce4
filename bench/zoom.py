#!/usr/bin/env python3
"""A flight away from a lawn: does anything pop where voxels take the place of exact geometry?

    bench/zoom.py [--vts PATH] [--frames N] [--from METRES] [--to METRES] [--size WxH] [--samples N] [--stills] [OUT]

One surface of 40 x 40 km under a texel of a metre, seen at 45 degrees from N distances, evenly spaced in the logarithm. Each frame
is drawn as users get it in a film, and twice with `detail exact` and many samples for the truth, whose own noise the two tell. Prints, for each
frame: CPU seconds, the RMSE against the truth, the mean difference, and the flicker: the RMS over pixels of the
change from one frame to the next of (picture - truth); the truth's noise is taken off. OUT (default zoom-out) keeps the pictures.
"""
import argparse
import glob
import math
import os
import subprocess

from pfm import read_pfm

SCENE = """
camera { location <0, D, -D> look_at <0, 0, 0> right x*image_width/image_height angle 40 }
light_source { <-20, 30, -25> rgb 1 parallel point_at 0 }
background { rgb <0.5, 0.7, 1> }
#declare S = seed(5);
#declare Grass = texel {
  cyclic x + z
  layer {
    particles { count 16 { position <rand(S), 0, rand(S)> velocity <0.3*rand(S) - 0.15, 1, 0.3*rand(S) - 0.15>
                           life 0.9 width 0.05, 0.01 profile "flat" } }
    texture { pigment { rgb <0.2, 0.5, 0.1> } }
  }
}
#declare Land = surface { patch_grid 1, 1 function(u, v) { <40000*(u - 0.5), 0, 40000*(v - 0.5)> } texture { pigment { rgb <0.2, 0.15, 0.1> } } };
object { Land }
skin { surface { Land } texel { Grass } mapping { repeat <40000, 40000> height 0.5 } }
"""


def rms(values):
    return math.sqrt(sum(v * v for v in values) / len(values))


def draw(options, distance, name, *more):
    """The picture as a list of values, and the CPU seconds that it took."""
    for old in glob.glob(os.path.join(options.out, name + "*.pfm")):
        os.remove(old)
    command = [options.vts, "render", os.path.join(options.out, "zoom.vts"), "-s", options.size, "-D", "D=%.9g" % distance]
    before = os.times()
    subprocess.run(command + ["-o", os.path.join(options.out, name + ".pfm"), "--progress", "none", *more], check=True)
    after = os.times()
    (picture,) = glob.glob(os.path.join(options.out, name + "*.pfm")) # a frame of a film has its number added
    return read_pfm(picture), after.children_user + after.children_system - before.children_user - before.children_system


def draw_truth(options, distance, name):
    """The mean of two pictures, and the variance of its noise."""
    exact = ["--set", "detail=exact", "--samples", options.samples]
    a, b = (draw(options, distance, name + "-" + end + "-", *exact, "--seed", end)[0] for end in ("1", "2"))
    return [(x + y) / 2 for x, y in zip(a, b)], sum((x - y) ** 2 for x, y in zip(a, b)) / (4 * len(a))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--vts", default=os.path.join(os.path.dirname(__file__), "..", "build", "vts"))
    parser.add_argument("--frames", type=int, default=33)
    parser.add_argument("--from", dest="first", type=float, default=1)
    parser.add_argument("--to", dest="last", type=float, default=300)
    parser.add_argument("--size", default="96x72")
    parser.add_argument("--stills", action="store_true", help="frames are pictures each for itself")
    parser.add_argument("--samples", default="64")
    parser.add_argument("out", nargs="?", default="zoom-out")
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    with open(os.path.join(options.out, "zoom.vts"), "w") as f:
        f.write(SCENE)
    before, worst, noise_before = None, (0, 0), 0
    print("%10s %8s %9s %9s %9s" % ("metres", "CPU s", "RMSE", "mean", "flicker"))
    for i in range(options.frames):
        distance = options.first * (options.last / options.first) ** (i / max(options.frames - 1, 1))
        film = [] if options.stills else ["+KFI1", "+KFF%d" % (options.frames + 1), "+SF%d" % (i + 1), "+EF%d" % (i + 1)]
        picture, seconds = draw(options, distance, "frame-%03d-" % i, *film)
        truth, noise = draw_truth(options, distance, "truth-%03d" % i)
        error = [a - b for a, b in zip(picture, truth)]
        flicker = math.sqrt(max(0, rms([a - b for a, b in zip(error, before)]) ** 2 - noise - noise_before)) if before else 0
        before, noise_before = error, noise
        worst = max(worst, (flicker, distance))
        print("%10.1f %8.2f %9.5f %+9.5f %9.5f" % (distance, seconds, math.sqrt(max(0, rms(error) ** 2 - noise)), sum(error) / len(error), flicker), flush=True)
    print("largest flicker %.5f at %.1f metres" % worst)


main()
