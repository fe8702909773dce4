"""cloud.py VTS OUT [--tracer PROGRAM] [--size N]: error against processor time of the ways to draw a cloud, beside an unbiased path tracer of its own and POV-Ray's media.

The tracer is asked for the cloud (-export) and for pictures (-spp, -seed, -size, -interp, -order, -o); without one the cloud is a noise of vts, and what it is measured by is
`vts reference`. Writes OUT/cloud.csv: group, name, CPU seconds, RMSE without the reference's noise, bias (difference of means). RMSE is of linear light, clamped to [0, 1]."""
import argparse, math, os, resource, shutil, subprocess, sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from pfm import read_pfm

SPREAD = (1, 4, 16, 64, 256, 1024)


def run(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        sys.exit("%s\n%s" % (" ".join(command), done.stdout))
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def vector(numbers, scale=1.0):
    return "<" + ", ".join("%.9g" % (x * scale) for x in numbers) + ">"


class Bench:
    def __init__(self, options):
        self.vts, self.out, self.size, self.tracer = options.vts, options.out, str(options.size), options.tracer
        self.rows = []
        os.makedirs(self.out, exist_ok=True)
        if self.tracer:
            run([self.tracer, "-size", self.size, self.size, "-spp", "1", "-export", self.path("cloud"), "-o", self.path("once.pfm")])
            with open(self.path("cloud/scene.txt")) as f:
                self.about = {words[0]: [float(x) for x in words[1:]] for words in (line.split() for line in f) if words[0] != "#"}
        else:
            self.about = {"grid": [65, 65, 10], "voxel": [0.1], "sigma_t": [12], "albedo": [0.99], "sun_irradiance": [4], "eye": [3.25, -5.2, 3.6],
                          "forward": [0, 0.929247, -0.36946], "right": [1, 0, 0], "up": [0, 0.36946, 0.929247], "tan_half_w": [0.3443276],
                          "to_sun": [-0.740488, -0.269516, 0.615662], "background": [0.12, 0.22, 0.42]}

    def path(self, name):
        return os.path.join(self.out, name)

    def scene(self, words="", grid=None):
        """vts' version; `grid`: another density file than the cloud's."""
        a = self.about
        wide = 2 * a["tan_half_w"][0]
        density = 'df3 "%s"' % (grid or "cloud/cloud.df3") if self.tracer else "fractal { size <65, 65, 10> dimension 2.35 threshold 0.42 seed 8 }"
        text = ["global_settings { assumed_gamma 1 }", "background { rgb %s }" % vector(a["background"]),
                "camera { location %s direction %s right %s up %s }" % (vector(a["eye"]), vector(a["forward"]), vector(a["right"], wide), vector(a["up"], wide)),
                "light_source { %s rgb %.9g parallel point_at 0 }" % (vector(a["to_sun"], 1e4), a["sun_irradiance"][0] / math.pi),
                "volume { density { %s } box { 0, %s } scattering %.9g absorption %.9g %s }" %
                (density, vector(a["grid"], a["voxel"][0]), a["sigma_t"][0] * a["albedo"][0], a["sigma_t"][0] * (1 - a["albedo"][0]), words)]
        with open(self.path("cloud.vts"), "w") as f:
            f.write("\n".join(text) + "\n")
        return self.path("cloud.vts")

    def reference(self, orders):
        """Two pictures of other seeds: their mean, and the variance of that."""
        pictures = []
        for seed in (771, 772):
            picture = self.path("reference_%s_%d.pfm" % (orders, seed))
            if self.tracer:
                run([self.tracer, "-size", self.size, self.size, "-interp", "1", "-order", "0" if orders == "all" else orders, "-seed", str(seed), "-spp", "1024", "-o", picture])
            else:
                run([self.vts, "reference", self.scene("orders " + orders), "-s", self.size + "x" + self.size, "--samples", "256", "--seed", str(seed), "-o", picture, "--progress", "none"])
            pictures.append(read_pfm(picture))
        a, b = pictures
        return [(x + y) / 2 for x, y in zip(a, b)], sum((x - y) ** 2 for x, y in zip(a, b)) / 4 / len(a)

    def note(self, group, name, seconds, picture, reference):
        drawn, (exact, noise) = read_pfm(picture), reference
        square = sum((x - y) ** 2 for x, y in zip(drawn, exact)) / len(exact)
        bias = (sum(drawn) - sum(exact)) / len(exact)
        self.rows.append((group, name, seconds, math.sqrt(max(square - noise, 0)), bias))
        print("%-14s %-16s %7.3f s  RMSE %.5f  bias %+.5f" % self.rows[-1], flush=True)

    def draw(self, group, name, words, reference, grid=None, options=()):
        picture = self.path("drawn.pfm")
        seconds = run([self.vts, "render", self.scene(words, grid), "-s", self.size + "x" + self.size, "-o", picture, "--progress", "none", *options])
        self.note(group, name, seconds, picture, reference)


def coarser(path, out, factor):
    """A density file of 16-bit numbers with cells joined."""
    with open(path, "rb") as f:
        data = f.read()
    n = [data[2 * k] * 256 + data[2 * k + 1] for k in range(3)]
    m = [max(1, -(-x // factor)) for x in n]
    sums, counts = [0] * (m[0] * m[1] * m[2]), [0] * (m[0] * m[1] * m[2])
    i = 6
    for z in range(n[2]):
        for y in range(n[1]):
            for x in range(n[0]):
                cell = (min(z * m[2] // n[2], m[2] - 1) * m[1] + y * m[1] // n[1]) * m[0] + x * m[0] // n[0]
                sums[cell] += data[i] * 256 + data[i + 1]
                counts[cell] += 1
                i += 2
    with open(out, "wb") as f:
        f.write(b"".join(x.to_bytes(2, "big") for x in m))
        f.write(b"".join((s // c).to_bytes(2, "big") for s, c in zip(sums, counts)))


def povray(bench, samples, reference):
    """Single scattering, as POV-Ray's media have it: extinction is that of all."""
    a = bench.about
    wide, albedo = 2 * a["tan_half_w"][0], a["albedo"][0]
    with open(bench.path("cloud.pov"), "w") as f:
        f.write("""#version 3.7;
global_settings { assumed_gamma 1.0 }
background { rgb %s }
camera { perspective location %s direction %s right %s up %s }
light_source { %s rgb %.9g parallel point_at 0 media_attenuation on media_interaction on }
box { 0, %s pigment { rgbt 1 } hollow interior { media { method 3 intervals 1 samples %d scattering { 1, rgb %.9g extinction %.9g }
    density { density_file df3 "cloud/cloud.df3" interpolate 1 color_map { [0 rgb 0] [1 rgb 1] } scale %s } } } }
""" % (vector(a["background"]), vector(a["eye"]), vector(a["forward"]), vector(a["right"], wide), vector(a["up"], wide), vector(a["to_sun"], 1e4),
           a["sun_irradiance"][0] / (4 * math.pi), vector(a["grid"], a["voxel"][0]), samples, a["sigma_t"][0] * albedo, 1 / albedo, vector(a["grid"], a["voxel"][0])))
    here = os.getcwd()
    os.chdir(bench.out)
    try:
        seconds = run(["povray", "+Icloud.pov", "+Ocloud.hdr", "+FH", "+W" + bench.size, "+H" + bench.size, "-A", "+WT2", "-D", "-GA"])
    finally:
        os.chdir(here)
    drawn = read_radiance(bench.path("cloud.hdr"))
    with open(bench.path("drawn.pfm"), "wb") as f:
        import array
        rows = [drawn[i:i + 3 * int(bench.size)] for i in range(0, len(drawn), 3 * int(bench.size))]
        f.write(("PF\n%s %s\n-1.0\n" % (bench.size, bench.size)).encode())
        f.write(array.array("f", [v for row in reversed(rows) for v in row]).tobytes())
    bench.note("povray", str(samples), seconds, bench.path("drawn.pfm"), reference)


def read_radiance(path):
    """Numbers of a Radiance picture, from the top: runs for each of four components of a row, or none."""
    with open(path, "rb") as f:
        while f.readline().strip():
            pass
        size = f.readline().split()
        height, width = int(size[1]), int(size[3])
        data = f.read()
    out, i = [], 0
    for _ in range(height):
        if width >= 8 and data[i:i + 2] == b"\2\2":
            i += 4
            planes = []
            for _ in range(4):
                plane = bytearray()
                while len(plane) < width:
                    count = data[i]
                    i += 1
                    if count > 128:
                        plane += bytes([data[i]]) * (count - 128)
                        i += 1
                    else:
                        plane += data[i:i + count]
                        i += count
                planes.append(plane)
            pixels = zip(*planes)
        else:
            pixels = [data[i + 4 * k:i + 4 * k + 4] for k in range(width)]
            i += 4 * width
        for r, g, b, e in pixels:
            scale = math.ldexp(1.0, e - 136) if e else 0
            out += [(r + 0.5) * scale, (g + 0.5) * scale, (b + 0.5) * scale]
    return out


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("vts")
    parser.add_argument("out")
    parser.add_argument("--tracer")
    parser.add_argument("--size", type=int, default=100)
    options = parser.parse_args()
    bench = Bench(options)
    every = bench.reference("all")
    print("noise of the reference: RMSE %.5f" % math.sqrt(every[1]), flush=True)
    bench.draw("default", "auto", "", every)
    for error in ("0.5/255", "0.25/255", "0.1/255"):
        bench.draw("max_error", error, "", every, options=("--max-error", error))
    for rays in (300, 3000, 30000, 300000, 1500000, 4000000):
        bench.draw("rays", str(rays), "rays %d" % rays, every)
    for storage in ("isotropic", "directional"):
        bench.draw("storage", storage, "rays 100000 storage " + storage, every)
    for orders in ("1", "2", "4", "16"):
        bench.draw("orders", orders, "rays 100000 orders " + orders, every)
    if options.tracer:
        for factor in (2, 4, 8):
            name = "cloud/coarser_%d.df3" % factor
            coarser(bench.path("cloud/cloud.df3"), bench.path(name), factor)
            bench.draw("grid", "1/%d" % factor, "rays 100000", every, name)
    for step in (0.4, 0.2, 0.1, 0.05):
        bench.draw("published", "step %g" % step, "method published rays 300000 step %g" % step, every)
    seconds = run([bench.vts, "render", bench.scene("method published rays 2000000"), "-s", "400x400", "-o", bench.path("paper.pfm"), "--progress", "none"])
    print("the paper's pictures, 400 x 400, two million light rays, as published: %.2f CPU s" % seconds, flush=True)
    for rays in SPREAD[:3]:
        bench.draw("path", str(rays), "method path rays %d" % rays, every)
    if options.tracer:
        for spp in SPREAD:
            picture = bench.path("drawn.pfm")
            seconds = run([options.tracer, "-size", bench.size, bench.size, "-interp", "1", "-seed", "1", "-spp", str(spp), "-o", picture])
            bench.note("tracer", str(spp), seconds, picture, every)
    single = bench.reference("1")
    bench.draw("single", "vts", "orders 1", single)
    if options.tracer and shutil.which("povray"):
        for samples in (3, 10, 30):
            povray(bench, samples, single)
    with open(bench.path("cloud.csv"), "w") as f:
        f.write("group,name,cpu_s,rmse,bias\n")
        f.writelines("%s,%s,%.4f,%.6f,%.6f\n" % row for row in bench.rows)


main()
