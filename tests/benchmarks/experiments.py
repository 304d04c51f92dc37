#!/usr/bin/python3
"""The experiments of the reference work (S. Strunk, KTH 2013, Figures 5.11 to 5.17) on the bundled cases.

    tests/benchmarks/experiments.py

The aeroplane's nose: three longest edge steps of the cells whose geometric error is above 1e-9. The NACA section, after
three uniform steps: six of the cells above 1e-7, on 2, 3 and 4 ranks.
"""

import json
import os
import subprocess
import tempfile

from refinement import ENVIRONMENT, ROOT, TIMEOUT

DATA = os.path.join(ROOT, "data")
NOSE = ["aeroplane_coarse.vtu", "aeroplane.igs", "--region", "0.05", "0.2", "-0.25", "0.25", "-0.2", "0.2",
        "--steps", "3", "--threshold", "1e-9"]
WING = ["naca0012_coarse.vtu", "naca0012_sharp.igs", "--uniform-steps", "3", "--steps", "6", "--threshold", "1e-7"]


def steps_of(ranks, mesh, cad, *options):
    with tempfile.TemporaryDirectory() as folder:
        report = os.path.join(folder, "report.json")
        subprocess.run(["mpirun", "--oversubscribe", "-np", str(ranks), "pvbatch",
                        os.path.join(ROOT, "plugin", "cadrefine.py"), os.path.join(DATA, mesh), os.path.join(DATA, cad),
                        *options, "--recursion-depth", "1", "--quiet", "--report", report], env={**os.environ, **ENVIRONMENT}, check=True,
                       timeout=TIMEOUT)
        with open(report, encoding="utf-8") as file:
            return json.load(file)["steps"]


def table(title, runs):
    """A row a step; the mesh is that of the first run, the seconds are those of each."""
    heads = "".join(f" s on {ranks} |" for ranks in runs)
    print(f"\n{title}\n\n| step | vertices | cells | on the CAD | projected | global error | largest distance |{heads}")
    print("|---" * (7 + len(runs)) + "|")
    for step in zip(*runs.values()):
        first = step[0]
        assert all(other["global_error"] == first["global_error"] and other["cells"] == first["cells"] for other in step)
        seconds = "".join(f" {sum(other['seconds'].values()):.2f} |" for other in step)
        print(f"| {first['step']} {first['method']} | {first['vertices']:,} | {first['cells']:,} "
              f"| {first['cad_vertices']:,} | {first['projected_points']:,} | {first['global_error']:.3e} "
              f"| {first['maximum_distance']:.2e} |{seconds}", flush=True)


def main():
    for name, options in (("as published", ["--no-cut-facets"]), ("with --cut-facets", ["--cut-facets"])):
        table(f"Nose, {name}", {2: steps_of(2, *NOSE, *options)})
        table(f"NACA section, {name}", {ranks: steps_of(ranks, *WING, *options) for ranks in (2, 3, 4)})


if __name__ == "__main__":
    main()
