#!/usr/bin/env python3
"""Does the program know how wrong its pictures are? The report's `error_estimate` beside the true error.

    bench/estimate.py [--vts PATH] [--size WxH] [--samples N] [--max-error LIST] [--out F.csv] SCENE...

Draws each scene as users get it, at each of the LISTed errors (default: the program's own), and twice by `vts reference` with N samples a pixel
and different seeds. The product of the two differences, averaged, is the squared error free of the references' noise (which
must be less than the error itself for the figure to mean anything: where it is not, the row ends in `noise`). Prints for each scene the
estimate, the true RMSE (linear light, clamped to [0,1]) and their ratio, and at the end the share within a factor of two and the geometric mean.
Scenes that cannot be drawn, or whose estimate is null, count as failures.
"""
import argparse
import json
import math
import os
import subprocess
import tempfile

from pfm import read_pfm


def draw(options, folder, verb, scene, name, *more):
    """Values and report of a picture of the scene; None where it cannot be drawn."""
    picture, report = os.path.join(folder, name + ".pfm"), os.path.join(folder, name + ".json")
    command = [options.vts, verb, scene, "-s", options.size, "-o", picture, "--report", report, "--progress", "none", *more]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=options.patience)
    if done.returncode:
        return None
    pictures = [f for f in os.listdir(folder) if f.startswith(name) and f.endswith(".pfm")] # a frame of a film has its number added
    with open(report) as f:
        frame = json.load(f)["frames"][0]
    return read_pfm(os.path.join(folder, sorted(pictures)[0])), frame


def truth(options, folder, scene):
    samples = str(options.samples)
    pair = [draw(options, folder, "reference", scene, "reference%d" % seed, "--samples", samples, "--seed", str(seed)) for seed in (11, 12)]
    return None if None in pair else [picture for picture, _ in pair]


def measure(options, scene, error):
    """Estimate, true error, noise of the truth and CPU seconds."""
    with tempfile.TemporaryDirectory() as folder:
        pair = truth(options, folder, scene)
        if pair is None:
            return None
        more = ["--max-error", error] if error else []
        still = ["-f", "1"] if b"animation" in open(scene, "rb").read() else []
        drawn = draw(options, folder, "render", scene, "picture", *more, *still)
    if drawn is None:
        return None
    picture, frame = drawn
    count = len(picture)
    square = sum((p - a) * (p - b) for p, a, b in zip(picture, *pair)) / count
    noise = math.sqrt(sum((a - b) ** 2 for a, b in zip(*pair)) / (2 * count))
    return frame["error_estimate"], math.sqrt(max(square, 0)), noise, frame["cpu_s"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vts", default=os.path.join(os.path.dirname(__file__), "..", "build", "vts"))
    parser.add_argument("--size", default="64x48")
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--max-error", default="")
    parser.add_argument("--patience", type=float, default=600, help="seconds for one picture")
    parser.add_argument("--out", help="the table as CSV")
    parser.add_argument("scenes", nargs="+")
    options = parser.parse_args()
    rows = []
    print("%-28s %8s %10s %10s %7s" % ("scene", "asked", "estimate", "true", "ratio"))
    for scene in options.scenes:
        for error in options.max_error.split(","):
            name = os.path.splitext(os.path.basename(scene))[0]
            try:
                result = measure(options, scene, error)
            except subprocess.TimeoutExpired:
                result = None
            if result is None:
                print("%-28s not drawn" % name, flush=True)
                rows.append((name, error, "", "", "", ""))
                continue
            estimate, true, noise, cpu = result
            ratio = estimate / true if estimate is not None and true > 0 else None
            print("%-28s %8s %10s %10.5f %7s %s" % (name, error, "null" if estimate is None else "%.5f" % estimate, true,
                                                  "-" if ratio is None else "%.2f" % ratio, "noise" if noise > true else ""), flush=True)
            rows.append((name, error, estimate, true, noise, cpu))
    known = [math.log(r[2] / r[3]) for r in rows if r[2] and r[3]]
    if known:
        within = sum(abs(k) <= math.log(2) for k in known)
        print("%d of %d within a factor of two; geometric mean of the ratio %.2f" % (within, len(rows), math.exp(sum(known) / len(known))))
    if options.out:
        with open(options.out + ".part", "w") as f:
            f.write("scene,max_error,estimate,rmse,noise,cpu_s\n")
            f.writelines(",".join("" if v is None else str(v) for v in row) + "\n" for row in rows)
        os.replace(options.out + ".part", options.out)


main()
