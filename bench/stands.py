#!/usr/bin/env python3
"""The light of stands drawn from voxels alone, relative to `vts reference`.

    bench/stands.py [--vts PATH] [--kinds LIST] [--pixels LIST] [--views LIST] [--suns LIST] [--sides LIST] [--turns LIST] [--rays N]
                    [--tiling plain|wang] [--truth FILE] [--terms]

Endless stands of one kind fill the picture (20 x 15 pixels, orthographic): wood is red, what is green is green, the ground is blue, and so the three are
told apart. For each kind, height of the eye (degrees above the horizon), height of the sun and side of it (degrees from behind the viewer: 0 behind, 180
before him), turn of both around the vertical (degrees: at 0 the eye looks along rows of the tiles) and number of pixels to a tile (no whole ones: each pixel would see the same of its tile) a line has the mean light of the reference and what voxels make of it: all light; then of wood, green
and ground by themselves where they make at least a twentieth. With --terms each picture is drawn twice more: what is seen of the three (`seen`, all
of them equally bright), and how bright it would be without shadows (`facing`), so that the light of each can be told apart into what is seen, how it
faces the sun, and how much is lit. --truth keeps the references' means in a file and takes them from there: they do not change with voxels.
Last come, for each number of pixels, the least ratio, the greatest, and the share within 0.9 and 1.1.
"""
import argparse
import itertools
import json
import math
import os
import subprocess
import tempfile

from pfm import read_pfm

# The mean over a whole stand is the same from any distance.
TRUTH_PIXELS = "5"
GREEN = "texture { pigment { rgb <0, 1, 0> } finish { FINISH } }"
WOOD = "texture { pigment { rgb <1, 0, 0> } finish { WOODEN } }"
TREES = '#include "trees.inc"\n#declare Wood = %s\n#declare Green = %s\n' % (WOOD, GREEN)

# Each declares Texel, Tile and High.
KINDS = {
    "spruce": TREES + "#declare Plants = array[2] { Spruce_Plant(22, Summer, 1, 1, 1, 0.15), Spruce_Plant(18, Summer, 2, 1, 1, 0.15) }\n"
              "#declare Texel = Tree_Stand(Plants, Wood, Green, 25, 22, 6.25, 1, 1)\n#declare Tile = 25; #declare High = 22;\n",
    "oak": TREES + "#declare Plants = array[2] { Oak_Plant(16, Summer, 1, 1, 1, 0.2), Oak_Plant(13, Summer, 2, 1, 1, 0.2) }\n"
           "#declare Texel = Tree_Stand(Plants, Wood, Green, 25, 17, 9, 1, 1)\n#declare Tile = 25; #declare High = 17;\n",
    "birch": TREES + "#declare Plants = array[2] { Birch_Plant(15, Winter, 1, 1, 1, 0.3), Birch_Plant(12, Winter, 2, 1, 1, 0.3) }\n"
             "#declare Texel = Tree_Stand(Plants, Wood, Green, 20, 16, 7, 1, 1)\n#declare Tile = 20; #declare High = 16;\n",
    "pine": TREES + "#declare Plants = array[2] { Pine_Plant(18, Summer, 3, 1, 1, 0.3), Pine_Plant(15, Summer, 4, 1, 1, 0.3) }\n"
            "#declare Texel = Tree_Stand(Plants, Wood, Green, 20, 19, 7, 1, 1)\n#declare Tile = 20; #declare High = 19;\n",
    "lawn": "#declare R = seed(3);\n#declare Texel = texel { cyclic x + z bounds 0, <1, 0.4, 1> layer { particles { count 300 { position <rand(R), 0, rand(R)>\n"
            "  velocity <0.2*rand(R) - 0.1, 0.45, 0.2*rand(R) - 0.1> acceleration <0.3*rand(R) - 0.15, -0.15, 0.3*rand(R) - 0.15> life 0.8 width 0.02, 0.002 profile \"flat\" } }\n"
            "  %s } }\n#declare Tile = 1; #declare High = 0.4;\n" % GREEN,
    "tufts": "#declare R = seed(5);\n#declare Texel = texel { cyclic x + z bounds 0, <1, 0.6, 1> layer { mesh {\n"
             "  #for (I, 1, 12) #local P = <rand(R), 0, rand(R)>; #for (J, 1, 14) #local A = 360*rand(R); #local L = 0.3 + 0.25*rand(R); #local O = 0.04 + 0.1*rand(R);\n"
             "  triangle { P + vrotate(<0, 0, -0.01>, A*y), P + vrotate(<0, 0, 0.01>, A*y), P + vrotate(<O, L, 0>, A*y) } #end #end } %s } }\n"
             "#declare Tile = 1; #declare High = 0.6;\n" % GREEN,
}
SCENE = """%(kind)s
global_settings { assumed_gamma 1 }
#declare Eye = vrotate(vrotate(-z, <%(up)s, 0, 0>), <0, %(turn)s, 0>);
camera { orthographic location 4000*Eye*Tile/25 look_at 0 right x*20*Tile/%(pixels)s up y*15*Tile/%(pixels)s }
light_source { 1e7*vrotate(vrotate(-z, <%(sun)s, 0, 0>), <0, %(turn)s + %(side)s, 0>), rgb 1 parallel point_at 0 %(shadows)s }
#declare Wide = 40*Tile*max(1, 6/%(pixels)s)/sin(radians(%(up)s));
#declare Field = surface { patch_grid 1, 1 function(u, v) { <Wide*(u - 0.5), 0, Wide*(v - 0.5)> } texture { pigment { rgb <0, 0, 1> } finish { WOODEN } } }
object { Field }
skin { surface { Field } texel { %(laid)s } mapping { tile Tile height High } %(tiling)s }
"""
FINISHES = {"lit": ("ambient 0 diffuse 0.7, 0.4", "ambient 0 diffuse 0.7"), "facing": ("ambient 0 diffuse 0.7, 0.4", "ambient 0 diffuse 0.7"),
            "seen": ("ambient 1 diffuse 0", "ambient 1 diffuse 0")}


def means(options, folder, cell, term, exact):
    kind, up, sun, side, turn, pixels = cell
    text = SCENE % dict(kind=KINDS[kind], up=up, sun=sun, side=side, turn=turn, pixels=pixels, shadows="shadowless" if term == "facing" else "",
                        laid="Texel", tiling="tiling wang" if options.tiling == "wang" else "")
    text = text.replace("FINISH", FINISHES[term][0]).replace("WOODEN", FINISHES[term][1])
    scene, picture = os.path.join(folder, "s.vts"), os.path.join(folder, "s.pfm")
    with open(scene, "w") as f:
        f.write(text)
    how = ["reference", "--samples", str(options.rays)] if exact else ["render", "--set", "detail=voxels", "--cache", options.cache]
    subprocess.run([options.vts, how[0], scene, "-s", "20x15", "-o", picture, "--progress", "none", *how[1:]], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.PIPE)
    values = read_pfm(picture)
    return [3 * sum(values[c::3]) / len(values) for c in range(3)]


def kept(truth, path, key, make):
    if key not in truth:
        truth[key] = make()
        if path:
            with open(path, "w") as f:
                json.dump(truth, f)
    return truth[key]


def ratios(mine, true):
    def of(a, b):
        return "%.2f" % (a / b) if b > 0 else "-"
    total = sum(true)
    return " ".join([of(sum(mine), total)] + [of(m, t) if t > 0.05 * total else "  - " for m, t in zip(mine, true)])


def main():
    p = argparse.ArgumentParser()
    p.add_argument("--vts", default="build/vts")
    p.add_argument("--kinds", default="spruce,oak,birch")
    p.add_argument("--pixels", default="20.7,5.3,1.07,0.27")
    p.add_argument("--views", default="60,25,12")
    p.add_argument("--suns", default="60,30,10")
    p.add_argument("--sides", default="30,150")
    p.add_argument("--turns", default="0")
    p.add_argument("--rays", type=int, default=64)
    p.add_argument("--tiling", default="plain")
    p.add_argument("--truth")
    p.add_argument("--terms", action="store_true")
    p.add_argument("--cache", default="off")
    options = p.parse_args()
    truth = json.load(open(options.truth)) if options.truth and os.path.exists(options.truth) else {}
    all_ratios = {}
    with tempfile.TemporaryDirectory() as folder:
        lists = [options.kinds, options.views, options.suns, options.sides, options.turns, options.pixels]
        for cell in itertools.product(*[a.split(",") for a in lists]):
            for term in ["lit", "seen", "facing"] if options.terms else ["lit"]:
                kind, up, sun, side, turn, pixels = cell if term != "seen" else (*cell[:2], "45", "0", *cell[4:])
                asked = (kind, up, sun, side, turn)
                key = " ".join([term, options.tiling, str(options.rays), *asked])
                true = kept(truth, options.truth, key, lambda: means(options, folder, (*asked, TRUTH_PIXELS), term, True))
                mine = means(options, folder, (*asked, pixels), term, False)
                print("%-6s eye %2s sun %2s side %3s turn %4s  %4s px %6s  %.4f  %s" %
                      (kind, up, sun, side, turn, pixels, term, sum(true), ratios(mine, true)), flush=True)
                if term == "lit":
                    all_ratios.setdefault(pixels, []).append(sum(mine) / sum(true))
    for pixels, r in all_ratios.items():
        print("%s pixels a tile: %.2f to %.2f, mean %.3f, rms of log %.3f, within a tenth %d of %d" %
              (pixels, min(r), max(r), sum(r) / len(r), math.sqrt(sum(math.log(x) ** 2 for x in r) / len(r)), sum(0.9 <= x <= 1.1 for x in r), len(r)))


if __name__ == "__main__":
    main()
