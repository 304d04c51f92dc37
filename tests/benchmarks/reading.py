#!/usr/bin/python3
"""Seconds that reading a CAD file takes, beside Open CASCADE's plain reader, which loads and transfers.

    tests/benchmarks/reading.py [FILE ...]

Reads 20,004 small faces (boxes in a STEP file, which is written first), and the files that are named, as CADRefine
does, on as many threads as there are cores, without and with a drawing; the plain reader in turns with it. Of three
runs each the fastest; one where the plain reader takes longer than a few seconds. Seconds are those on the clock, and
then those of computing, on all threads, which depend less on what else the machine does. Fails where reading takes
more than 2.5 times the computing of the plain reader.
"""

import json
import os
import subprocess
import sys
import tempfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROGRAM = os.path.join(ROOT, "build", "release", "tests", "geom", "cad_file_probe")
BOXES = 3334
LONG = 5  # Seconds.
MOST = 2.5


def run(what, file, *number):
    """Seconds on the clock and of computing, and what the program printed."""
    started = time.monotonic()
    process = subprocess.Popen([PROGRAM, what, file, *map(str, number)], stdout=subprocess.PIPE)
    with process.stdout as output:
        text = output.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = status
    if status:
        sys.exit(f"{file}: {PROGRAM} {what} fails")
    return time.monotonic() - started, usage.ru_utime + usage.ru_stime, json.loads(text or "{}")


def measure(file):
    """The number of faces, and the least seconds on the clock and of computing, of each way to read."""
    threads = len(os.sched_getaffinity(0))
    ways = (["plain", file], ["here", file, threads], ["drawn", file, threads])
    best, faces = [(float("inf"), float("inf"))] * 3, 0
    for turn in range(3):
        if turn and best[0][0] > LONG:
            break
        runs = [run(*way) for way in ways]
        best = [(min(clock, new[0]), min(cpu, new[1])) for (clock, cpu), new in zip(best, runs)]
        faces = runs[1][2]["faces"]
    return faces, best


def main(files):
    slow = []
    print("| file | faces | plain reader, s | read | times plain | and drawn | times plain | read, computing | "
          "times plain | and drawn | times plain |\n" + "|---" * 11 + "|")
    with tempfile.TemporaryDirectory() as folder:
        boxes = os.path.join(folder, "boxes.step")
        run("boxes", boxes, BOXES)
        for file in [boxes, *files]:
            faces, ((clock, cpu), *ours) = measure(file)
            columns = [f"{seconds[i]:.2f} | {seconds[i] / plain:.1f}" for i, plain in enumerate((clock, cpu))
                       for seconds in ours]
            print(" | ".join([f"| {os.path.basename(file)}", str(faces), f"{clock:.2f}", *columns]) + " |", flush=True)
            if ours[0][1] > MOST * cpu:
                slow.append(file)
    for file in slow:
        print(f"{file}: more than {MOST} times the plain reader")
    return 1 if slow else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
