#!/usr/bin/python3
"""The main job on the bundled NACA 0012 section, on two ranks: three uniform steps, then six longest edge steps of the
cells whose error exceeds 1e-7; once with the CAD and once without. `make demo` runs this.

Leaves tables, reports, a convergence plot and pictures of the leading edge in the folder --output.
"""

import argparse
import os
import subprocess
import sys
import time

HERE = os.path.dirname(os.path.abspath(__file__))
DATA = os.path.join(HERE, "..", "data")
RANKS = 2

CASE = [os.path.join(DATA, "naca0012_coarse.vtu"), os.path.join(DATA, "naca0012_sharp.igs"),
        "--region", "-0.3", "3.3", "-1", "3", "-0.6", "0.6", "--recursion-depth", "3",
        "--uniform-steps", "3", "--steps", "6", "--method", "longest-edge", "--threshold", "1e-7",
        "--no-cut-facets"]  # As published.
LEADING_EDGE = ["--focus", "0", "0.9", "0", "0.9", "-0.18", "0.18"]

FILES = (
    ("with_cad.txt", "the table: a row a step, new vertices on the CAD"),
    ("without_cad.txt", "the same refined straight: what boundary smoothing gains"),
    ("with_cad.json, without_cad.json", "the reports"),
    ("refined.vtu", "the last mesh, to look at in ParaView"),
    ("convergence.png", "global error over the number of vertices, with and without CAD"),
    ("leading_edge_coarse.png", "the projected mesh, coloured by its distance from the CAD"),
    ("leading_edge_refined.png", "the last mesh, on the same scale"),
)


def command(arguments):
    display = [] if os.environ.get("DISPLAY") else ["xvfb-run", "--auto-servernum", "--server-args=-screen 0 1280x1024x24 -noreset"]
    return [*display, "mpirun", "-np", str(RANKS), "pvbatch", os.path.join(HERE, "cadrefine.py"), *arguments]


def run(title, arguments, table):
    """Runs the driver; its table goes to the terminal and to the file `table`."""
    print(f"\n{title}", flush=True)
    with open(table, "w", encoding="utf-8") as file:
        process = subprocess.Popen(command(arguments), stdout=subprocess.PIPE, text=True)
        for line in process.stdout:
            print(line, end="", flush=True)
            file.write(line)
    if process.wait() != 0:
        sys.exit(f"demo: the run failed with exit status {process.returncode}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", default=os.path.join(HERE, "..", "build", "demo"), help="folder of the results")
    folder = os.path.relpath(parser.parse_args().output)
    os.makedirs(folder, exist_ok=True)
    for name in ", ".join(names for names, _ in FILES).split(", "):
        if os.path.exists(os.path.join(folder, name)):
            os.remove(os.path.join(folder, name))

    def result(name):
        return os.path.join(folder, name)

    started = time.monotonic()
    run("Without CAD: new vertices stay on the straight edges of the coarse mesh",
        [*CASE, "--no-cad", "--report", result("without_cad.json")], result("without_cad.txt"))
    run("With CAD: every new boundary vertex is put onto the CAD",
        [*CASE, *LEADING_EDGE, "--report", result("with_cad.json"), "--output", result("refined.vtu"),
         "--plot", result("convergence.png"), "--compare-report", result("without_cad.json"),
         "--screenshot-start", result("leading_edge_coarse.png"), "--screenshot", result("leading_edge_refined.png")],
        result("with_cad.txt"))
    print(f"\nThe demo took {time.monotonic() - started:.0f} s. Results in {folder}/:")
    for names, meaning in FILES:
        print(f"  {names:<33}{meaning}")


if __name__ == "__main__":
    main()
