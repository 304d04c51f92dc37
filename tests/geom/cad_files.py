#!/usr/bin/python3
"""Reads all CAD files below folders and prints a table for each folder, in Markdown, with a row for each file.

usage: cad_files.py [--all] PROGRAM FOLDER...

PROGRAM is build/release/tests/geom/cad_file_probe. Columns: faces here, faces by Open CASCADE's plain reader (which
only loads and transfers: no sewing, no healing; "fails" where it reads nothing or dies), entities listed as unread
and as left out, seconds of computing and MiB of memory here, and the times of the plain reader that this is. Without
--all the rows are left out of files of which all faces are read.

Fails where faces are lost without a line that says so, or where nothing is read of a file of which the plain reader
reads something, without an error that lists what is unread.
"""

import json
import os
import subprocess
import sys
import threading

EXTENSIONS = (".igs", ".iges", ".stp", ".step", ".brep")
LONGEST = 600  # Seconds.


def run(command):
    """What the program prints, seconds of computing and MiB; None where it dies."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    timer = threading.Timer(LONGEST, process.kill)
    timer.start()
    with process.stdout as output:
        text = output.read()
    _, status, usage = os.wait4(process.pid, 0)
    timer.cancel()
    process.returncode = status
    lines = text.decode(errors="replace").strip().splitlines()
    result = json.loads(lines[-1]) if status == 0 and lines else None
    return result, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def files_below(folder):
    found = [os.path.join(place, name) for place, _, names in os.walk(folder) for name in names]
    return sorted(file for file in found if file.lower().endswith(EXTENSIONS))


def verdict(here, plain):
    """What is wrong, or ""."""
    if here is None:
        return "reading it here dies"
    if plain is None or plain["faces"] + plain["edges"] == 0:
        return ""
    if "error" in here:
        return "" if "(unread: " in here["error"] else f"refused: {here['error']}"
    lost = plain["faces"] - here["faces"]
    return f"{lost} faces are lost in silence" if lost > 0 and not here["unread"] + here["left_out"] else ""


def row(name, here, plain, ours, theirs):
    here = here or {}
    counts = [here.get("faces", "error" if "error" in here else "died"),
              plain["faces"] if plain else "fails", len(here.get("unread", [])), len(here.get("left_out", []))]
    ratio = ours[0] / theirs[0] if plain and theirs[0] else float("nan")
    return "| " + " | ".join([name, *map(str, counts), f"{ours[0]:.2f}", f"{ours[1]:.0f}", f"{ratio:.1f}"]) + " |"


def main(arguments):
    everything = "--all" in arguments
    program, *folders = [argument for argument in arguments if argument != "--all"]
    faults = []
    count = 0
    for folder in folders:
        print(f"\n## {folder}\n\n| file | faces | plain reader | unread | left out | s | MiB | times plain |")
        print("|---|---|---|---|---|---|---|---|", flush=True)
        for file in files_below(folder):
            count += 1
            plain, *theirs = run([program, "plain", file])
            here, *ours = run([program, "here", file])
            fault = verdict(here, plain)
            if everything or fault or not here or not plain or here.get("faces") != plain["faces"]:
                print(row(os.path.relpath(file, folder), here, plain, ours, theirs), flush=True)
            if fault:
                faults.append(f"{file}: {fault}")
    print("\n".join([f"\n{count} files, {len(faults)} at fault", *faults]))
    return 1 if faults or not count else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
