#!/usr/bin/env python3
"""The language's speed beside POV-Ray's and Lua's, measured in one run.

    bench/language/run.py [--vts build/vts] [--rounds 5] [program …]

Each program runs under vts, under POV-Ray (`povray`, two pixels, no picture) and, where there is a counterpart, under Lua 5.4, in
turn, so that whatever else the machine does meets all of them. The table gives the median of user and system time, the largest
peak of memory, and vts's time over the others'. All must print the same line. What is not installed is left out."""
import argparse
import os
import shutil
import statistics
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))


def measure(command):
    """Seconds of processor time, MiB at the peak, and the line that begins with '> '."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=HERE)
    text = process.stdout.read().decode("latin-1")
    _, _, usage = os.wait4(process.pid, 0)
    said = next((line for line in text.splitlines() if line.startswith("> ")), "")
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, said


def commands(program, vts):
    yield "vts", [vts, "run", program + ".vts"]
    if shutil.which("povray"):
        yield "POV-Ray", ["povray", "+I" + program + ".vts", "-D", "-F", "+W2", "+H2", "+Q0", "+WT1", "-GW"]
    lua = shutil.which("lua5.4") or shutil.which("lua")
    if lua and os.path.exists(os.path.join(HERE, program + ".lua")):
        yield "Lua", [lua, program + ".lua"]


def row(program, vts, rounds):
    figures = {}
    for _ in range(rounds):
        for name, command in commands(program, vts):
            figures.setdefault(name, []).append(measure(command))
    said = {run[2] for runs in figures.values() for run in runs}
    time = {name: statistics.median(run[0] for run in runs) for name, runs in figures.items()}
    peak = {name: max(run[1] for run in runs) for name, runs in figures.items()}
    cells = [program]
    for name in ("vts", "POV-Ray", "Lua"):
        cells.append("%.3f s, %.0f MiB" % (time[name], peak[name]) if name in time else "-")
    for name in ("POV-Ray", "Lua"):
        cells.append("%.2f" % (time["vts"] / time[name]) if name in time else "-")
    cells.append("yes" if len(said) == 1 and said != {""} else "NO: " + ", ".join(sorted(said)))
    return cells


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--vts", default=os.path.join(HERE, "../../build/vts"))
    options.add_argument("--rounds", type=int, default=5)
    options.add_argument("programs", nargs="*", default=["while", "for", "fibonacci", "strings", "spheres", "copies"])
    chosen = options.parse_args()
    print("| program | vts | POV-Ray | Lua | vts / POV-Ray | vts / Lua | same output |")
    print("|---|---|---|---|---|---|---|")
    good = True
    for program in chosen.programs:
        cells = row(program, os.path.abspath(chosen.vts), chosen.rounds)
        good = good and cells[-1] == "yes"
        print("| " + " | ".join(cells) + " |", flush=True)
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
