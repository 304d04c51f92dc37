#!/usr/bin/python3
"""The loop: flow, dual, indicator; marking by indicator and geometry, refinement; and again.

    /usr/bin/python3 drag.py [--output FOLDER] [--rounds N] [--ranks N] ...

The solver (solve.py) and CADRefine (plugin/cadrefine.py) run one after the other, each with all ranks, and exchange .vtu
files. All is done twice, with the CAD and without: the tables are FOLDER/with_cad.json and FOLDER/without_cad.json.
"""

import argparse
import json
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(os.path.dirname(HERE)))
CAD = os.path.join(ROOT, "data", "naca0012_sharp.igs")
COLUMNS = (("round", "5d"), ("vertices", "9d"), ("cells", "9d"), ("drag_coefficient", "17.4f"),
           ("indicator_sum", "14.3f"), ("global_error", "13.3e"), ("invalid_cells", "14d"))


def run(*command):
    """Runs a program that must succeed. Ranks have one thread each, and give way while they wait."""
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OMPI_MCA_mpi_yield_when_idle": "1"}
    command = [str(part) for part in command]
    result = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit status {result.returncode}\n{result.stdout}{result.stderr}")


def mpirun(ranks):
    return "mpirun", "--bind-to", "none", "-np", ranks


def load(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def refine(ranks, mesh, output, *options):
    """Runs CADRefine. Returns the last step of its report."""
    report = output + ".json"
    run(*mpirun(ranks), "pvbatch", os.path.join(ROOT, "plugin", "cadrefine.py"), mesh, CAD, "--quiet",
        "--recursion-depth", 1, "--output", output, "--report", report, *options)
    return load(report)["steps"][-1]


def solve(ranks, mesh, output, *options):
    """Runs the solver. Returns its report."""
    report = output + ".json"
    run(*mpirun(ranks), "/usr/bin/python3", "-m", "mpi4py", os.path.join(HERE, "solve.py"), mesh, output,
        "--report", report, *options)
    return load(report)


def marking(cad, fraction):
    """The driver's options that mark, by the indicator, and by the geometric error where the CAD is known: the fewest
    cells that carry this part of the sum."""
    by_indicator = ["--indicator", "indicator", "--indicator-marking", "bulk", "--indicator-threshold", fraction]
    return by_indicator + (["--marking", "bulk", "--threshold", fraction, "--cut-facets"] if cad else ["--no-cad"])


def adapt(folder, cad, options):
    """The rounds, with the CAD or without. Returns the rows of the table."""
    start, mesh = os.path.join(folder, "start.vtu"), os.path.join(folder, "mesh0.vtu")
    run("/usr/bin/python3", "-B", os.path.join(ROOT, "data", "naca0012_mesh.py"), "--boundary-triangles", start)
    geometry = refine(options.ranks, start, mesh, "--uniform-steps", options.uniform_steps, "--steps", 0,
                      *([] if cad else ["--no-cad"]))
    rows = []
    for number in range(options.rounds + 1):
        solution = os.path.join(folder, f"flow{number}.vtu")
        flow = solve(options.ranks, mesh, solution, "--reynolds", options.reynolds, "--steps", options.time_steps,
                     "--averaged", options.time_steps // 3)
        rows.append({"round": number, **flow, **{key: geometry[key] for key in ("global_error", "invalid_cells")}})
        print_row(rows[-1])
        if number < options.rounds:
            mesh = os.path.join(folder, f"mesh{number + 1}.vtu")
            geometry = refine(options.ranks, solution, mesh, "--projected", "--steps", 1,
                              *marking(cad, options.fraction))
    return rows


def print_row(row):
    if row["round"] == 0:
        print("".join(f"{name:>{int(style[:-1].split('.')[0])}}" for name, style in COLUMNS))
    print("".join(f"{row[name]:{style}}" for name, style in COLUMNS), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", default=os.path.join(ROOT, "build", "drag"), help="folder (default build/drag)")
    parser.add_argument("--rounds", type=int, default=4, help="refinements (default %(default)s)")
    parser.add_argument("--uniform-steps", type=int, default=2, help="before the first round (default %(default)s)")
    parser.add_argument("--fraction", type=float, default=0.7,
                        help="part of the indicator and of the error that marked cells carry (default %(default)g)")
    parser.add_argument("--reynolds", type=float, default=1000.0, help="of the chord (default %(default)g)")
    parser.add_argument("--time-steps", type=int, default=40, help="of each round (default %(default)s)")
    parser.add_argument("--ranks", type=int, default=2, help="of solver and refinement (default %(default)s)")
    options = parser.parse_args()
    for name, cad in (("without_cad", False), ("with_cad", True)):
        folder = os.path.join(options.output, name)
        os.makedirs(folder, exist_ok=True)
        print(name.replace("_", " "))
        rows = adapt(folder, cad, options)
        with open(os.path.join(options.output, name + ".json"), "w", encoding="utf-8") as file:
            json.dump(rows, file, indent=2)


if __name__ == "__main__":
    main()
